#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests share/scripts/test-summary.py with results of a suite that passed, of one with a failed case, of one that crashed, of one that
failed at its end, of one whose results cannot be read, and of a script that was skipped.

usage: test_summary_test.py SOURCES
"""
import pathlib
import subprocess
import sys
import tempfile

CTEST = """<testsuite>
<testcase name="base.Good" status="run"/>
<testcase name="base.Rooms/Bad" status="fail"><failure/></testcase>
<testcase name="base.Crashed" status="fail"><failure/></testcase>
<testcase name="base.Leaked" status="fail"><failure/></testcase>
<testcase name="base.Garbled" status="fail"><failure/></testcase>
<testcase name="scripts.site" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/></testcase>
</testsuite>"""
SUITES = {
    "base.Good": """<testsuites><testsuite>
<testcase name="one" classname="Good" status="run" result="completed"/>
<testcase name="two" classname="Good" status="run" result="completed"/>
<testcase name="three" classname="Good" status="run" result="skipped"><skipped message="file.cpp:7&#x0A;needs a log"/></testcase>
<testcase name="four" classname="Good" status="notrun" result="suppressed"/>
</testsuite></testsuites>""",
    "base.Rooms-Bad": """<testsuites><testsuite>
<testcase name="one/0" classname="Rooms/Bad" status="run" result="completed"/>
<testcase name="two/0" classname="Rooms/Bad" status="run" result="completed"><failure message="no"/></testcase>
</testsuite></testsuites>""",
    "base.Leaked": """<testsuites><testsuite>
<testcase name="one" classname="Leaked" status="run" result="completed"/>
</testsuite></testsuites>""",
    "base.Garbled": """<testsuites><testsuite><testcase name="one"><failure message="\x01"/></testcase></testsuite></testsuites>""",
}
EXPECTED = """skipped (needs a log): base.Good.three
skipped (disabled): base.Good.four
skipped (no reason given): scripts.site
failed: base.Rooms/Bad.two/0
failed: base.Crashed
failed: base.Leaked
failed: base.Garbled
4 passed, 4 failed, 3 skipped
"""


def summary_of(script, results):
    run = subprocess.run([sys.executable, script, results], stdout=subprocess.PIPE, check=False, text=True)
    return run.stdout, run.returncode


def expect(found, expected):
    if found != expected:
        sys.exit(f"expected {expected}\nfound {found}")


def main(sources):
    script = pathlib.Path(sources) / "share/scripts/test-summary.py"
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder) / "test-results.xml"
        suites = pathlib.Path(folder) / "test-results"
        suites.mkdir()
        for name, text in SUITES.items():
            (suites / f"{name}.xml").write_text(text, encoding="utf-8")
        results.write_text(CTEST, encoding="utf-8")
        expect(summary_of(script, results), (EXPECTED, 1))
        results.write_text('<testsuite><testcase name="base.Good" status="run"/></testsuite>', encoding="utf-8")
        expect(summary_of(script, results)[1], 0)
        results.write_text("<testsuite/>", encoding="utf-8")
        expect(summary_of(script, results), ("0 passed, 0 failed, 0 skipped\n", 1))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
