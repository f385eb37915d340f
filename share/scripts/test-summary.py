#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Summarises the results of the tests.

usage: test-summary.py RESULTS      (RESULTS: the file written by ctest --output-junit)

Lists the failed tests and, by reason, the skipped tests. The last line is "N passed, N failed, N skipped".
A test that could not be started counts as failed. The exit code is 1 if any test failed or none was run.
"""
import collections
import re
import sys
import xml.etree.ElementTree

REASON = re.compile(r": Skipped\n(.+)")  # GoogleTest prints "file:line: Skipped", then the reason
DELIBERATE = ("SKIP_REGULAR_EXPRESSION_MATCHED", "SKIP_RETURN_CODE", "Disabled")


def skip_reason(case):
    """Returns the reason why the test was skipped, or None if it was not skipped."""
    skipped = case.find("skipped")
    if case.get("status") == "disabled":
        return "disabled"
    if skipped is None or not skipped.get("message", "").startswith(DELIBERATE):
        return None
    given = REASON.search(case.findtext("system-out", ""))
    return given.group(1).strip() if given else "no reason given"


def main(path):
    passed, failed = 0, []
    skipped = collections.defaultdict(list)
    for case in xml.etree.ElementTree.parse(path).getroot().iter("testcase"):
        reason = skip_reason(case)
        if reason is not None:
            skipped[reason].append(case.get("name"))
        elif case.get("status") == "run":
            passed += 1
        else:
            failed.append(case.get("name"))
    for reason, names in skipped.items():
        print(f"skipped ({reason}): {', '.join(names)}")
    for name in failed:
        print(f"failed: {name}")
    print(f"{passed} passed, {len(failed)} failed, {sum(map(len, skipped.values()))} skipped")
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
