#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares libs/ros2/ros2_messages.idl with the .msg files of the distribution, field by field.

    message_layouts_test.py SOURCE_FOLDER

The distribution packages the messages of ROS 1. ROS 2 has left out the sequence number of headers, has added the fields
below, and has fields of `bool`, `char` and `byte` as DDS has them. Exit code 77: the .msg files are not installed.
"""
import pathlib
import re
import sys

SHARE = pathlib.Path("/usr/share")
PACKAGES = ["std_msgs", "geometry_msgs", "tf2_msgs", "rosgraph_msgs", "sensor_msgs", "nav_msgs", "visualization_msgs",
            "diagnostic_msgs"]
LEFT_OUT = {("std_msgs/Header", "seq")}
ADDED = {("visualization_msgs/Marker", field): None
         for field in ["texture_resource", "texture", "uv_coordinates", "mesh_file"]}
ONLY_ROS2 = {"builtin_interfaces/Time", "builtin_interfaces/Duration", "visualization_msgs/UVCoordinate",
             "visualization_msgs/MeshFile", "rmw_dds_common/Gid", "rmw_dds_common/Gid24",
             "rmw_dds_common/NodeEntitiesInfo", "rmw_dds_common/NodeEntitiesInfo24",
             "rmw_dds_common/ParticipantEntitiesInfo", "rmw_dds_common/ParticipantEntitiesInfo24"}
IDL_TYPES = {"float": "float32", "double": "float64", "boolean": "bool", "octet": "byte"}


def types_of_idl(text):
    """Returns the fields of each type: {"std_msgs/Header": [("builtin_interfaces/Time", "stamp"), ...]}."""
    text = re.sub(r"//.*", "", text)
    types = {}
    for package, content in re.findall(r"module (\w+) \{ module msg \{ module dds_ \{(.*?)\n\}; \}; \};", text, re.S):
        arrays = {name: (element, size) for element, name, size in re.findall(r"typedef (\w+) (\w+)\[(\d+)\];", content)}

        def type_name(word):
            sequence = re.fullmatch(r"sequence<(.*)>", word)
            if sequence:
                return type_name(sequence.group(1)) + "[]"
            if word in arrays or word.split("::")[-1] in arrays:
                element, size = arrays.get(word) or arrays[word.split("::")[-1]]
                return f"{type_name(element)}[{size}]"
            if word.endswith("_"):
                parts = word.split("::")
                return f"{parts[0] if len(parts) > 1 else package}/{parts[-1][:-1]}"
            return IDL_TYPES.get(word, word)

        for name, fields in re.findall(r"@final struct (\w+)_ \{(.*?)\};", content, re.S):
            types[f"{package}/{name}"] = [(type_name(kind), field) for kind, field in re.findall(r"(\S+) (\w+);", fields)]
    return types


def fields_of_msg(package, name):
    text = (SHARE / package / "msg" / f"{name}.msg").read_text()
    fields = []
    for line in text.splitlines():
        line = line.split("#")[0].strip()
        if not line or "=" in line:
            continue
        kind, field = line.split()[:2]
        base, brackets = re.fullmatch(r"([\w/]+)(\[.*\])?", kind).groups()
        simple = {"time": "builtin_interfaces/Time", "duration": "builtin_interfaces/Duration", "Header": "std_msgs/Header"}
        if base in simple:
            base = simple[base]
        elif base[0].isupper():
            base = f"{package}/{base}"
        if (f"{package}/{name}", field) not in LEFT_OUT:
            fields.append((base + (brackets or ""), field))
    return fields


def main():
    if not all((SHARE / package / "msg").is_dir() for package in PACKAGES):
        print("the definitions of ROS messages are not installed")
        return 77
    types = types_of_idl((pathlib.Path(sys.argv[1]) / "libs/ros2/ros2_messages.idl").read_text())
    wrong = []
    compared = 0
    for name, fields in types.items():
        if name in ONLY_ROS2:
            continue
        package, message = name.split("/")
        expected = fields_of_msg(package, message)
        found = [field for field in fields if (name, field[1]) not in ADDED]
        compared += len(found)
        if found != expected:
            wrong.append(f"{name}:\n  IDL: {found}\n  msg: {expected}")
    print("\n".join(wrong) or f"{len(types)} types, {compared} fields agree")
    return 1 if wrong or compared < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
