#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Writes the RAWLASER1 and ODOM lines of a CARMEN log as a ROS 1 bag with ROS's own library: write_ros1_bag.py
# LOG BAG none|bz2|lz4. The laser is mounted at x = 0.2 m with a yaw of 0.3 rad. Exits with 77 if the library
# is missing.
import math
import sys

try:
    import genpy
    import rosbag
    from geometry_msgs.msg import TransformStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan
    from tf2_msgs.msg import TFMessage
except ImportError:
    sys.exit(77)


def stamp(text):
    seconds, fraction = text.split(".")
    return genpy.Time(int(seconds), int(fraction.ljust(9, "0")))


def set_yaw(quaternion, yaw):
    quaternion.z, quaternion.w = math.sin(yaw / 2), math.cos(yaw / 2)


def scan(words):
    message = LaserScan()
    start, _, step, range_max = (float(word) for word in words[2:6])
    count = int(words[8])
    message.header.stamp = stamp(words[10 + count])
    message.header.frame_id = "laser"
    message.angle_min, message.angle_increment, message.range_max = start, step, range_max
    message.range_min = 0.1
    message.ranges = [float(word) for word in words[9 : 9 + count]]
    return message


def odometry(words):
    message = Odometry()
    message.header.stamp = stamp(words[7])
    message.header.frame_id, message.child_frame_id = "odom", "base_link"
    message.pose.pose.position.x, message.pose.pose.position.y = float(words[1]), float(words[2])
    set_yaw(message.pose.pose.orientation, float(words[3]))
    return message


def mount(time):
    transform = TransformStamped()
    transform.header.stamp = time
    transform.header.frame_id, transform.child_frame_id = "base_link", "laser"
    transform.transform.translation.x = 0.2
    set_yaw(transform.transform.rotation, 0.3)
    return TFMessage([transform])


log, path, compression = sys.argv[1:]
with rosbag.Bag(path, "w", compression=compression, chunk_threshold=3000) as bag:
    for line in open(log):
        words = line.split()
        message = scan(words) if words[0] == "RAWLASER1" else odometry(words) if words[0] == "ODOM" else None
        if message is None:
            continue
        if bag.get_message_count() == 0:
            bag.write("/tf_static", mount(message.header.stamp), message.header.stamp)
        bag.write("/scan" if words[0] == "RAWLASER1" else "/odom", message, message.header.stamp)
