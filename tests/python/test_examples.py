# SPDX-License-Identifier: BSD-3-Clause
import os
import pathlib
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).parents[2] / "share/examples/python"


def run_example(name, *arguments):
    run = subprocess.run(
        [sys.executable, EXAMPLES / name, *map(str, arguments)],
        capture_output=True, text=True, env={**os.environ, "MPLBACKEND": "agg"}, timeout=300, check=False,
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


def test_map_and_plot(log, tmp_path):
    pytest.importorskip("matplotlib")
    text = run_example("01_map_and_plot.py", log, tmp_path / "plot.png")
    assert "320 scans" in text
    assert (tmp_path / "plot.png").stat().st_size > 10000


def test_feed_scans(tmp_path):
    text = run_example("02_feed_scans.py", tmp_path / "out")
    assert "largest error" in text
    assert float(text.split("largest error ")[1].split()[0]) < 0.1
    assert (tmp_path / "out" / "map.png").stat().st_size > 1000


def test_compare_settings(log):
    pytest.importorskip("pandas")
    text = run_example("03_compare_settings.py", log)
    assert len([line for line in text.splitlines() if "loop_closure" in line]) >= 2
    assert "doubt_m" in text


def test_wrong_logs_are_told(tmp_path):
    for name in ("01_map_and_plot.py", "03_compare_settings.py"):
        run = subprocess.run(
            [sys.executable, EXAMPLES / name, tmp_path / "missing.log", tmp_path / "plot.png"][: 4 if "01" in name else 3],
            capture_output=True, text=True, check=False,
        )
        assert run.returncode == 2 and "missing.log" in run.stderr and "Traceback" not in run.stderr
