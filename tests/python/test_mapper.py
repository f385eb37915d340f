# SPDX-License-Identifier: BSD-3-Clause
import math
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import room
from same_results import comparable

import psi_slam

ANGLES = {"angle_min_rad": -math.pi / 2, "angle_increment_rad": math.pi / (room.BEAMS - 1)}


def scan_of(time_s, ranges, **further):
    arguments = {"time_s": time_s, "max_range_m": room.MAX_RANGE_M, **ANGLES, **further}
    return psi_slam.Scan(ranges, **arguments)


def fed(mapper, scans):
    poses = [mapper.add(scan_of(time_s, ranges), odometry) for time_s, odometry, ranges in room.drive(scans)]
    return mapper.finish(), poses


def test_fed_scans_give_the_map_of_their_log(log, tmp_path):
    result, poses = fed(psi_slam.Mapper(name=log.name), 320)
    of_log = psi_slam.map(log, {"log.max_range_m": room.MAX_RANGE_M, "log.mask_own_body": "off"})
    np.testing.assert_array_equal(result.poses, of_log.poses)
    np.testing.assert_array_equal(result.covariances, of_log.covariances)
    np.testing.assert_array_equal(result.loops, of_log.loops)
    np.testing.assert_array_equal(result.grid_map.occupancy, of_log.grid_map.occupancy)
    result.save(tmp_path / "fed")
    of_log.save(tmp_path / "log")
    names = {path.name for path in (tmp_path / "log").iterdir()}
    assert names == {path.name for path in (tmp_path / "fed").iterdir()}
    for name in names - {"summary.json", "report.html"}:  # these two state the settings of the log
        assert comparable(tmp_path / "fed" / name) == comparable(tmp_path / "log" / name), name
    assert len(poses) == 320 and all(pose.matched for pose in poses[1:])
    assert poses[0].time_s == 1000
    truth = np.array([room.true_pose(i)[:2] for i in (0, 160)])
    driven = math.hypot(poses[160].x_m - poses[0].x_m, poses[160].y_m - poses[0].y_m)
    assert driven == pytest.approx(np.linalg.norm(truth[1] - truth[0]), abs=0.05)


def test_scans_that_repeat_an_earlier_one_are_left_out_as_those_of_their_log(tmp_path):
    stalled = range(101, 126)  # the driver repeats scan 100
    path = tmp_path / "stalled.log"
    room.write_log(path, 320, stalled)
    of_log = psi_slam.map(path, {"log.max_range_m": room.MAX_RANGE_M, "log.mask_own_body": "off"})
    mapper = psi_slam.Mapper()
    for i, (time_s, odometry, ranges) in enumerate(room.drive(320, stalled)):
        pose = mapper.add(scan_of(time_s, ranges), odometry)
        assert pose.time_s == time_s
        assert pose.matched == (i > 0 and i not in stalled)
        moved = np.array(room.true_pose(i)[:2]) - room.true_pose(0)[:2]
        assert math.hypot(pose.x_m, pose.y_m) == pytest.approx(np.linalg.norm(moved), abs=0.1)
    result = mapper.finish()
    np.testing.assert_array_equal(result.poses, of_log.poses)
    sentences = [warning for warning in result.warnings if "repeat the readings" in warning]
    assert sentences == [warning for warning in of_log.warnings if "repeat the readings" in warning]
    assert sentences[0].startswith("25 scans repeat")


def test_bearings_and_other_arrays_give_the_same_map():
    by_angles, _ = fed(psi_slam.Mapper(), 40)
    mapper = psi_slam.Mapper()
    for time_s, odometry, ranges in room.drive(40):
        scan = psi_slam.Scan(
            ranges.astype(np.float32).tolist(),
            time_s=time_s,
            max_range_m=room.MAX_RANGE_M,
            bearings_rad=room.bearings_rad(),
        )
        mapper.add(scan, np.array(odometry))
    np.testing.assert_array_equal(mapper.finish().poses, by_angles.poses)


def test_scans_without_odometry_are_mapped():
    mapper = psi_slam.Mapper()
    for time_s, _, ranges in room.drive(60):
        mapper.add(scan_of(time_s, ranges))
    result = mapper.finish()
    assert any("no odometry" in warning for warning in result.warnings)
    moved = np.hypot(*(result.poses[axis][59] - result.poses[axis][0] for axis in ("x_m", "y_m")))
    truth = np.array([room.true_pose(i)[:2] for i in (0, 59)])
    assert moved == pytest.approx(np.linalg.norm(truth[1] - truth[0]), abs=0.05)


def test_a_mount_moves_the_laser():
    mapper = psi_slam.Mapper()
    for time_s, odometry, ranges in room.drive(3):
        mapper.add(scan_of(time_s, ranges, mount=(0.2, 0, math.pi / 2)), odometry)
    assert mapper.finish().summary["log"]["robot_T_laser"] == [0.2, 0, pytest.approx(math.pi / 2, abs=1e-6)]


def test_covariances_come_if_they_are_asked_for():
    _, without = fed(psi_slam.Mapper(), 30)
    assert without[5].covariance is None
    _, poses = fed(psi_slam.Mapper(estimate_covariance=True), 30)
    covariance = poses[-1].covariance
    assert covariance.shape == (3, 3)
    np.testing.assert_allclose(covariance, covariance.T, rtol=1e-9)
    assert (np.linalg.eigvalsh(covariance) > 0).all()


def test_ranges_that_are_no_returns_are_marked():
    mapper = psi_slam.Mapper()
    for time_s, odometry, ranges in room.drive(5):
        ranges[:20] = np.inf
        ranges[20:40] = np.nan
        ranges[40:50] = 0
        ranges[50:60] = room.MAX_RANGE_M
        mapper.add(scan_of(time_s, ranges, min_range_m=0.1), odometry)
    assert mapper.finish().summary["log"]["returns"] == pytest.approx((room.BEAMS - 60) / room.BEAMS, abs=1e-4)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"ranges_m": [[1, 2]]}, "ranges_m has the shape (1, 2), expected an array of one dimension"),
        ({"ranges_m": []}, "ranges_m is empty"),
        ({"ranges_m": "near"}, "ranges_m"),
        ({"bearings_rad": [0.1]}, "either by angle_min_rad and angle_increment_rad, or by bearings_rad"),
        ({"angle_min_rad": None}, "either by angle_min_rad and angle_increment_rad, or by bearings_rad"),
        ({"angle_min_rad": -90, "angle_increment_rad": 1}, "may state degrees"),
        ({"angle_min_rad": math.nan}, "a beam bearing is not finite"),
        ({"time_s": math.nan}, "time_s is nan, expected a time in seconds"),
        ({"max_range_m": 0}, "max_range_m is 0, expected a number of metres above 0"),
        ({"min_range_m": 10}, "min_range_m is 10, expected a number of metres from 0 to below max_range_m, which is 10"),
        ({"min_range_m": math.nan}, "min_range_m is nan, expected"),
        ({"min_range_m": -1}, "min_range_m is -1, expected"),
        ({"mount": (1, 2)}, "mount is (1, 2), expected (x, y, yaw)"),
        ({"mount": (1, 2000, 0)}, "mount is (1, 2000, 0), expected (x, y, yaw)"),
    ],
)
def test_wrong_scans_are_refused(arguments, sentence):
    right = {"ranges_m": np.ones(room.BEAMS), "time_s": 1.0, "max_range_m": 10.0, **ANGLES}
    psi_slam.Scan(**right)
    with pytest.raises(psi_slam.UserError) as caught:
        psi_slam.Scan(**{**right, **arguments})
    assert sentence in str(caught.value)


def test_numbers_of_bearings_and_ranges_are_compared():
    with pytest.raises(psi_slam.UserError, match="2 bearings for 3 ranges"):
        psi_slam.Scan([1, 2, 3], time_s=0, max_range_m=10, bearings_rad=[0, 1])


def test_wrong_use_of_a_mapper_is_refused():
    with pytest.raises(psi_slam.UserError, match="log.every_nth_scan applies to logs"):
        psi_slam.Mapper({"log.every_nth_scan": 2})
    mapper = psi_slam.Mapper({"log.max_range_m": 20})
    with pytest.raises(psi_slam.UserError, match="^Mapper: no scan was added. Call add"):
        mapper.finish()
    assert repr(mapper) == "<psi_slam.Mapper: 0 scans>"
    scan = scan_of(1, np.ones(room.BEAMS))
    for wrong in ((1, 2), (1, 2, math.nan), "here"):
        with pytest.raises(psi_slam.UserError, match="odometry is .*, expected None or"):
            mapper.add(scan, wrong)
    mapper.add(scan, (0, 0, 0))
    assert repr(mapper) == "<psi_slam.Mapper: 1 scan>"
    result = mapper.finish()
    with pytest.raises(psi_slam.UserError, match="finish.. was called"):
        mapper.add(scan)
    assert mapper.finish() is result


def printed_by(script):
    """Runs a script that may not end in a process of its own."""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=False)
    return run.stdout + run.stderr


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"prior.map": "missing.yaml"}, "missing.yaml"),
        ({"prior.extend": True}, "prior.extend needs a map to extend"),
    ],
)
def test_a_wrong_prior_map_is_refused(settings, sentence):
    output = printed_by(f"import psi_slam\npsi_slam.Mapper({settings!r})")
    assert "UserError" in output and sentence in output


@pytest.mark.parametrize("use", ["mapper.finish()", "mapper.add(scan, (0, 0, 0))"])
def test_a_progress_function_cannot_use_its_mapper(use):
    output = printed_by(f"""
import numpy, psi_slam
scan = psi_slam.Scan(numpy.ones(181), time_s=1, max_range_m=10, angle_min_rad=-1.5, angle_increment_rad=0.01)
mapper = psi_slam.Mapper()
mapper.add(scan, (0, 0, 0))
try:
    mapper.finish(lambda progress: {use})
except psi_slam.UserError as error:
    print(error)
print(len(mapper.finish().poses))
""")
    assert output.startswith("Mapper: a progress function or signal handler cannot use the mapper that calls it")
    assert output.endswith("\n1\n")


def raise_lookup_error(progress):
    raise LookupError(progress.phase)


def test_an_exception_of_progress_leaves_the_map():
    mapper = psi_slam.Mapper()
    for time_s, odometry, ranges in room.drive(60):
        mapper.add(scan_of(time_s, ranges), odometry)
    with pytest.raises(LookupError, match="final search"):
        mapper.finish(raise_lookup_error)
    assert len(mapper.finish(raise_lookup_error).poses) == 60


def test_an_exception_of_progress_goes_before_complaints_about_the_scans():
    mapper = psi_slam.Mapper()
    mapper.add(scan_of(1, np.full(room.BEAMS, np.inf)), (0, 0, 0))
    with pytest.raises(LookupError):
        mapper.finish(raise_lookup_error)


def test_a_mapper_that_is_dropped_ends():
    mapper = psi_slam.Mapper()
    mapper.add(scan_of(1, np.ones(room.BEAMS)), (0, 0, 0))
    del mapper


def test_ctrl_c_while_finishing_keeps_the_map():
    mapper = psi_slam.Mapper()
    for time_s, odometry, ranges in room.drive(160):
        mapper.add(scan_of(time_s, ranges), odometry)
    came = []

    def interrupt_once(progress):
        if not came:
            came.append(progress.phase)
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(psi_slam.Interrupted) as caught:
        mapper.finish(interrupt_once)
    assert len(caught.value.result.poses) == 160
    assert caught.value.result.interrupted


def test_another_thread_may_add_scans():
    mapper = psi_slam.Mapper()
    thread = threading.Thread(
        target=lambda: [mapper.add(scan_of(time_s, ranges), odometry) for time_s, odometry, ranges in room.drive(40)]
    )
    thread.start()
    thread.join()
    expected, _ = fed(psi_slam.Mapper(), 40)
    np.testing.assert_array_equal(mapper.finish().poses, expected.poses)
