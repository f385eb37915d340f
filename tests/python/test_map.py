# SPDX-License-Identifier: BSD-3-Clause
import csv
import json
import pathlib
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import room
from same_results import assert_same_results

import psi_slam

ALL_FORMATS = {
    "map.align": "walls",
    "map.resolution_m": 0.1,
    "map.write_geotiff": True,
    "map.write_gpkg": True,
    "map.write_dxf": True,
    "run.seed": 3,
    "run.threads": 2,
}
EDITS = ["wall line=0,1;2,1 width_m=0.2", "keep_out polygon=1,1;2,1;2,2"]


def as_arguments(settings):
    texts = {True: "true", False: "false"}
    return [word for name, value in settings.items() for word in ("--set", f"{name}={texts.get(value, value)}")]


def test_saved_files_equal_those_of_the_program(log, result, psi_slam_program, tmp_path):
    assert psi_slam_program(log, "-o", tmp_path / "program").returncode == 0
    result.save(tmp_path / "python")
    assert_same_results(tmp_path / "program", tmp_path / "python")


def test_settings_and_edits_act_as_in_the_program(log, psi_slam_program, tmp_path):
    edits = tmp_path / "my.edits"
    edits.write_text("# psi-slam loop edits 1\n" + "\n".join(EDITS) + "\n")
    settings = {name: value for name, value in ALL_FORMATS.items() if name != "map.write_dxf"}
    run = psi_slam_program(log, "-o", tmp_path / "program", "--edits", edits, *as_arguments(settings))
    assert run.returncode == 0, run.stderr
    psi_slam.map(log, settings, edits=edits).save(tmp_path / "python")
    assert_same_results(tmp_path / "program", tmp_path / "python")
    of_lines = psi_slam.map(str(log), settings, edits=edits.read_text().splitlines())
    of_lines.save(str(tmp_path / "lines"))
    assert_same_results(tmp_path / "program", tmp_path / "lines")


def test_save_replaces_files_only_by_force(result, tmp_path):
    result.save(tmp_path / "out")
    with pytest.raises(psi_slam.UserError, match="is not empty.* replace the results in it with force=True$"):
        result.save(tmp_path / "out")
    result.save(tmp_path / "out", force=True)


@pytest.fixture(scope="module")
def turned(log, tmp_path_factory):
    """A result in a frame that differs from the mapper's, and its files."""
    result = psi_slam.map(log, {"map.align": "walls", "map.origin_x_m": 2})
    folder = tmp_path_factory.mktemp("turned")
    result.save(folder / "out")
    return result, folder / "out"


def test_poses_and_covariances_equal_the_table(turned):
    result, folder = turned
    with open(folder / "trajectory.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(result.poses) == len(result.covariances) == 320
    columns = {"time_s": "time_s", "x_m": "x_m", "y_m": "y_m", "theta_rad": "yaw_rad", "run": "run"}
    for name, field in columns.items():
        table = np.array([float(row[name]) for row in rows])
        np.testing.assert_allclose(result.poses[field], table, rtol=0, atol=1e-6)
    for name, (i, j) in {"cov_xx_m2": (0, 0), "cov_xtheta_m_rad": (0, 2), "cov_ytheta_m_rad": (2, 1)}.items():
        table = np.array([float(row[name]) for row in rows])
        np.testing.assert_allclose(result.covariances[:, i, j], table, rtol=0, atol=1e-10)
    assert result.poses["matched"][1:].all() and not result.poses["matched"][0]
    assert set(result.poses["node"]) - {-1} == set(range(result.summary["nodes"]))


def test_loops_equal_the_table(turned):
    result, folder = turned
    with open(folder / "loops.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(result.loops) > 0
    for name in ("frame", "node", "local_map", "anchor", "evaluations"):
        assert [int(row[name]) for row in rows] == result.loops[name].tolist()
    for name in ("state", "reason", "matcher", "search"):
        assert [row[name] for row in rows] == result.loops[name].tolist()
    assert [row["in_last_pass"] == "1" for row in rows] == result.loops["in_final_search"].tolist()
    columns = {"x_m": "x_m", "theta_rad": "yaw_rad", "std_y_m": "sigma_y_m", "std_theta_rad": "sigma_yaw_rad"}
    for name, field in columns.items():
        table = np.array([float(row[name]) for row in rows])
        np.testing.assert_allclose(result.loops[field], table, rtol=0, atol=1e-6)
    accepted = (result.loops["state"] == "accepted").sum()
    assert accepted == result.summary["loop_counts"]["accepted"] > 0


def test_grid_map_equals_the_image(turned):
    result, folder = turned
    grid = result.grid_map
    data = (folder / "map.pgm").read_bytes()
    _, size, _, pixels = data.split(b"\n", 3)
    width, height = map(int, size.split())
    image = np.frombuffer(pixels, np.uint8).reshape(height, width)[::-1]
    np.testing.assert_array_equal(grid.occupied, image == 0)
    np.testing.assert_array_equal(grid.free, image == 254)
    assert grid.occupied.sum() > 100 and grid.free.sum() > 1000
    assert grid.occupancy.dtype == np.float32
    assert (grid.occupancy[grid.occupied] > 0.65).all() and (grid.occupancy[grid.free] < 0.2).all()
    yaml = dict(line.split(": ", 1) for line in (folder / "map.yaml").read_text().splitlines())
    assert grid.resolution_m == float(yaml["resolution"])
    assert tuple(json.loads(yaml["origin"])[:2]) == grid.origin
    assert repr(grid) == f"<psi_slam.GridMap: {height} rows, {width} columns, cells of 0.05 m>"
    assert grid.extent[1] - grid.extent[0] == pytest.approx(width * grid.resolution_m, abs=1e-4)


def test_verdict_and_summary_equal_the_file(turned):
    result, folder = turned
    summary = json.loads((folder / "summary.json").read_text())
    assert result.summary["nodes"] == summary["nodes"]
    assert result.summary["map"] == summary["map"]
    assert result.verdict.state == summary["verdict"]["state"]
    assert result.verdict.sentence == summary["verdict"]["sentence"]
    assert result.verdict.error_m == pytest.approx(summary["verdict"]["error_m"], abs=1e-4)
    assert [spot.advice for spot in result.verdict.hot_spots] == [
        spot["advice"] for spot in summary["verdict"]["hot_spots"]
    ]
    assert [spot.edit or None for spot in result.verdict.hot_spots] == [
        spot["edit"] for spot in summary["verdict"]["hot_spots"]
    ]
    assert [spot.moved_m for spot in result.verdict.hot_spots] == [
        moved_m and pytest.approx(moved_m, abs=1e-3)
        for moved_m in (spot["moved_m"] for spot in summary["verdict"]["hot_spots"])
    ]
    assert len(result.verdict.changes) == len(summary["verdict"]["changes"])
    assert result.verdict.more_hot_spots == summary["verdict"]["more_hot_spots"]
    assert result.settings == summary["settings"]
    assert result.warnings == summary["warnings"]
    assert result.broken_off is None and not result.interrupted


def test_an_unchecked_map_names_the_path_to_drive_again(tmp_path):
    room.write_log(tmp_path / "once.log", 80)
    verdict = psi_slam.map(tmp_path / "once.log").verdict
    assert verdict.state == "unchecked"
    assert verdict.held_share == 0
    (stretch,) = verdict.unchecked_stretches
    assert stretch.first_scan == 0 and 70 < stretch.last_scan < 80
    assert stretch.first_place == pytest.approx((0, 0), abs=0.05)
    assert stretch.length_m == pytest.approx(10, abs=1)
    assert 0 < stretch.sigma_m < 1
    assert f"scans 0 to {stretch.last_scan}" in verdict.sentence
    assert verdict.open_stretches == []
    assert verdict.changes == []


def test_arrays_are_computed_once_and_read_only(result):
    assert result.poses is result.poses
    assert result.grid_map is result.grid_map
    for array in (result.poses, result.covariances, result.loops, result.grid_map.occupancy):
        assert not array.flags.writeable


def test_a_damaged_log_is_mapped_up_to_the_damage(log, tmp_path):
    import gzip

    damaged = tmp_path / "damaged.log.gz"
    damaged.write_bytes(gzip.compress(log.read_bytes())[:-2000])
    result = psi_slam.map(damaged)
    assert 100 < len(result.poses) < 320
    assert "damaged.log.gz" in result.broken_off
    assert result.broken_off in result.warnings


@pytest.mark.parametrize(
    ("settings", "arguments"),
    [
        ({"map.resolution": 1}, ["--set", "map.resolution=1"]),
        ({"map.resolution_m": "fine"}, ["--set", "map.resolution_m=fine"]),
        ({"map.resolution_m": 0}, ["--set", "map.resolution_m=0"]),
        ({"log.min_range_m": 9.0, "log.max_range_m": 5}, ["--set", "log.min_range_m=9", "--set", "log.max_range_m=5"]),
    ],
)
def test_wrong_settings_have_the_sentences_of_the_program(log, psi_slam_program, tmp_path, settings, arguments):
    with pytest.raises(psi_slam.UserError) as caught:
        psi_slam.map(log, settings)
    run = psi_slam_program(log, "-o", tmp_path / "out", *arguments)
    assert run.returncode == 2
    assert str(caught.value).replace("settings: ", "--set: ") in run.stderr


def test_wrong_files_have_the_sentences_of_the_program(log, psi_slam_program, tmp_path):
    edits = tmp_path / "wrong.edits"
    edits.write_text("# psi-slam loop edits 1\nremove scan=1\n")
    ini = tmp_path / "wrong.ini"
    ini.write_text("[map]\nresolution = 1\n")
    missing = tmp_path / "missing.log"
    for given, arguments in (
        ({"log": missing}, [missing]),
        ({"log": log, "edits": edits}, [log, "--edits", edits]),
        ({"log": log, "edits": tmp_path / "missing.edits"}, [log, "--edits", tmp_path / "missing.edits"]),
        ({"log": log, "config": ini}, [log, "-c", ini]),
    ):
        with pytest.raises(psi_slam.UserError) as caught:
            psi_slam.map(**given)
        run = psi_slam_program(*arguments, "-o", tmp_path / "out")
        assert run.returncode == 2 and str(caught.value) in run.stderr


def test_a_missing_file_of_edits_is_called_so(log, tmp_path):
    with pytest.raises(psi_slam.UserError, match="missing.edits does not exist, expected a file of edits"):
        psi_slam.map(log, edits=tmp_path / "missing.edits")


def test_numpy_is_named_where_it_is_missing():
    script = "import sys; sys.modules['numpy'] = None; import psi_slam"
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 1
    assert run.stderr.endswith("psi_slam needs NumPy. Install python3-numpy, or run /usr/bin/python3\n")


def test_names_that_are_not_utf8_are_told(tmp_path):
    with pytest.raises(psi_slam.UserError, match="does not exist|cannot"):
        psi_slam.map(tmp_path / "not-utf8-\udcff.log")


def test_settings_take_python_values(log):
    settings = {
        "map.resolution_m": np.float64(0.1),
        "map.keep_moving": np.bool_(False),
        "run.seed": np.int64(7),
        "log.sweep_time_s": None,
        "log.every_nth_scan": 4,
        "psi.psi_1": 1,
    }
    result = psi_slam.map(log, settings)
    assert len(result.poses) == 80
    assert result.settings["map.resolution_m"] == "0.1"
    assert result.settings["map.keep_moving"] == "false"
    assert result.settings["run.seed"] == "7"
    assert result.settings["log.sweep_time_s"] == "auto"
    with pytest.raises(psi_slam.UserError, match="map.resolution_m is of type list, expected"):
        psi_slam.map(log, {"map.resolution_m": [0.1]})
    with pytest.raises(psi_slam.UserError, match="expected a dict"):
        psi_slam.map(log, ["map.resolution_m=0.1"])
    with pytest.raises(psi_slam.UserError, match="missing.yaml"):
        psi_slam.map(log, {"prior.map": pathlib.Path("missing.yaml")})


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"config": 3}, "config is of type int, expected the path of a settings file"),
        ({"edits": 3}, "edits is of type int, expected the path of a file of edits, or a list of its lines"),
        ({"edits": [3]}, "edits: a line is of type int, expected a text"),
    ],
)
def test_arguments_of_wrong_types_are_refused(log, arguments, sentence):
    with pytest.raises(psi_slam.UserError, match=sentence):
        psi_slam.map(log, **arguments)


def test_warnings_do_not_depend_on_what_was_read_before(log):
    result = psi_slam.map(log, edits=["wall line=500,500;501,500 width_m=0.2"])
    first = result.warnings
    assert any("500" in warning for warning in first), first
    assert result.summary["warnings"] == first == result.warnings


def test_progress_reports_the_phases(log):
    seen = []
    psi_slam.map(log, progress=lambda progress: seen.append((progress.phase, progress.share, progress.scans)))
    phases = [phase for phase, _, _ in seen]
    assert phases == sorted(phases, key=["mapping", "final search"].index)
    assert set(phases) == {"mapping", "final search"}
    assert all(0 <= share <= 1 for _, share, _ in seen)
    assert seen[-1][2] == 320


def test_an_exception_of_progress_ends_the_mapping(log):
    def fail(progress):
        raise LookupError(f"after {progress.scans} scans")

    with pytest.raises(LookupError, match="after [01] scans"):
        psi_slam.map(log, progress=fail)
    with pytest.raises(TypeError, match="progress"):
        psi_slam.map(log, progress=3)


@pytest.mark.parametrize("raised", [LookupError, KeyboardInterrupt])
def test_an_exception_of_progress_goes_before_complaints_about_the_map(tmp_path, raised):
    log = tmp_path / "empty.log"
    ranges = " ".join(["50.0"] * 181)
    log.write_text("".join(f"FLASER 181 {ranges} 0 0 0 0 0 0 {i} robot {i}\n" for i in range(5)))
    settings = {"log.max_range_m": 40}
    with pytest.raises(psi_slam.UserError, match="has a return"):
        psi_slam.map(log, settings)

    def fail(progress):
        raise raised("stop")

    with pytest.raises(raised) as caught:
        psi_slam.map(log, settings, progress=fail)
    assert not isinstance(caught.value, psi_slam.Interrupted)


def test_other_threads_run_while_mapping(log):
    counted = []
    done = threading.Event()

    def count():
        while not done.wait(0.001):
            counted.append(1)

    reports = []
    thread = threading.Thread(target=count)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)  # the interpreter itself does not switch to the other thread
    try:
        thread.start()
        psi_slam.map(log, progress=lambda progress: reports.append(len(counted)))
    finally:
        sys.setswitchinterval(interval)
        done.set()
        thread.join()
    assert reports[-1] > reports[0]  # the thread worked between two calls of progress


def test_ctrl_c_keeps_the_scans_so_far(log, tmp_path):
    def interrupt(progress):
        if progress.scans > 0 and progress.phase == "mapping":
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(psi_slam.Interrupted) as caught:
        psi_slam.map(log, progress=interrupt)
    result = caught.value.result
    assert isinstance(caught.value, KeyboardInterrupt)
    assert 0 < len(result.poses) < 320 and result.interrupted
    result.save(tmp_path / "out")
    lines = (tmp_path / "out" / "trajectory.tum").read_text().splitlines()
    assert len(lines) == len(result.poses)
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["interrupted"]


def test_ctrl_c_of_a_terminal(log, tmp_path):
    script = tmp_path / "interrupted.py"
    script.write_text(
        "import sys, psi_slam\n"
        "try:\n"
        "    while True:\n"
        "        psi_slam.map(sys.argv[1], progress=lambda p: print('mapping', flush=True))\n"
        "except psi_slam.Interrupted as interrupted:\n"
        "    interrupted.result.save(sys.argv[2])\n"
        "    print('saved')\n"
    )
    command = [sys.executable, script, log, tmp_path / "out"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "mapping\n"
        child.send_signal(signal.SIGINT)
        output, _ = child.communicate(timeout=120)
    assert child.returncode == 0 and output.endswith("saved\n")
    assert (tmp_path / "out" / "report.html").stat().st_size > 1000


def test_a_second_ctrl_c_ends_without_a_map(log):
    phases = []

    def interrupt_in_each_phase(progress):
        if progress.scans > 0 and progress.phase not in phases:
            phases.append(progress.phase)
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt) as caught:
        psi_slam.map(log, progress=interrupt_in_each_phase)
    assert phases == ["mapping", "final search"]
    assert not isinstance(caught.value, psi_slam.Interrupted)


def test_a_prior_map_has_a_phase_and_is_never_replaced(log, tmp_path):
    psi_slam.map(log).save(tmp_path / "prior")
    phases = []

    def note_phase(progress):
        if not phases or phases[-1] != progress.phase:
            phases.append(progress.phase)

    image = (tmp_path / "prior" / "map.pgm").read_bytes()
    result = psi_slam.map(log, {"prior.map": tmp_path / "prior" / "map.yaml"}, progress=note_phase)
    assert phases == ["mapping", "prior map", "final search"]
    with pytest.raises(psi_slam.UserError, match="Choose another folder for the results"):
        result.save(tmp_path / "prior", force=True)
    assert (tmp_path / "prior" / "map.pgm").read_bytes() == image
