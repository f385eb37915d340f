#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Summarises the results of the tests.

usage: test-summary.py RESULTS      (RESULTS: the file written by ctest --output-junit)

Counts each case of a suite of GoogleTest, whose results are in the folder test-results beside RESULTS, and each other test once.
Lists the failed tests and, by reason, the skipped tests. The last line is "N passed, N failed, N skipped".
A test that could not be started or did not end counts as failed. The exit code is 1 if any test failed or none was run.
"""
import collections
import pathlib
import re
import sys
import xml.etree.ElementTree

REASON = re.compile(r": Skipped\n(.+)")  # GoogleTest prints "file:line: Skipped", then the reason
DELIBERATE = ("SKIP_REGULAR_EXPRESSION_MATCHED", "SKIP_RETURN_CODE", "Disabled")


def skip_reason(case):
    """Returns the reason why CTest skipped the test, or None if it was not skipped."""
    skipped = case.find("skipped")
    if case.get("status") == "disabled":
        return "disabled"
    if skipped is None or not skipped.get("message", "").startswith(DELIBERATE):
        return None
    given = REASON.search(case.findtext("system-out", ""))
    return given.group(1).strip() if given else "no reason given"


def outcome(case):
    """Returns "passed", "failed" or the reason of the skip for a test of CTest."""
    reason = skip_reason(case)
    if reason is not None:
        return f"skipped ({reason})"
    return "passed" if case.get("status") == "run" else "failed"


def outcomes_of_suite(results, prefix):
    """Returns pairs (name, outcome) of the cases that ran in a suite. There are none if its results cannot be read: messages of
    failures may hold any bytes."""
    try:
        cases = list(xml.etree.ElementTree.parse(results).getroot().iter("testcase"))
    except (FileNotFoundError, xml.etree.ElementTree.ParseError):
        return
    for case in cases:
        skipped = case.find("skipped")
        if case.find("failure") is not None:
            found = "failed"
        elif skipped is not None:
            found = f"skipped ({skipped.get('message', '').split(chr(10))[-1].strip() or 'no reason given'})"
        elif case.get("status") == "run":
            found = "passed"
        else:
            found = "skipped (disabled)"
        yield f"{prefix}.{case.get('classname')}.{case.get('name')}", found


def outcomes(path):
    """Returns pairs (name, outcome) of all tests."""
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        name = case.get("name")
        results = path.parent / "test-results" / f"{name.replace('/', '-')}.xml"
        cases = list(outcomes_of_suite(results, name.split(".")[0]))
        yield from cases
        if not cases or (outcome(case) == "failed" and all(found != "failed" for _, found in cases)):
            yield name, outcome(case)


def main(path):
    names = collections.defaultdict(list)
    for name, found in outcomes(path):
        names[found].append(name)
    passed, failed = len(names.pop("passed", [])), names.pop("failed", [])
    for reason, skipped in names.items():
        print(f"{reason}: {', '.join(skipped)}")
    for name in failed:
        print(f"failed: {name}")
    print(f"{passed} passed, {len(failed)} failed, {sum(map(len, names.values()))} skipped")
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))
