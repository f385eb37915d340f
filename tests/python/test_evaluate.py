# SPDX-License-Identifier: BSD-3-Clause
import json
import math

import numpy as np
import pytest
import room

import psi_slam

FIGURES = (
    "translation_abs_m",
    "translation_sq_m2",
    "rotation_abs_deg",
    "rotation_sq_deg2",
    "cartographer_translation_abs_m",
    "cartographer_translation_sq_m2",
)


def relations_array():
    """True relations between scans; every third time lies between two scans, and the last one after all scans."""
    rows = []
    for i in range(0, 300, 7):
        (x1, y1, yaw1), (x2, y2, yaw2) = room.true_pose(i), room.true_pose(i + 20)
        dx, dy = x2 - x1, y2 - y1
        rows.append(
            (
                1000 + i * 0.25 + (0.1 if i % 3 == 0 else 0),
                1000 + (i + 20) * 0.25,
                math.cos(yaw1) * dx + math.sin(yaw1) * dy,
                -math.sin(yaw1) * dx + math.cos(yaw1) * dy,
                yaw2 - yaw1,
            )
        )
    rows.append((1000, 5000, 1, 1, 0))
    names = ("time1_s", "time2_s", "x_m", "y_m", "yaw_rad")
    return np.array(rows, dtype=[(name, float) for name in names])


@pytest.fixture(scope="module")
def files(result, tmp_path_factory):
    folder = tmp_path_factory.mktemp("evaluation")
    result.save(folder / "out")
    with open(folder / "relations", "w") as file:
        for time1, time2, x, y, yaw in relations_array().tolist():
            file.write(f"{time1!r} {time2!r} {x!r} {y!r} 0 0 0 {yaw!r}\n")
    return folder / "out" / "trajectory.tum", folder / "relations"


def assert_figures(evaluation, expected, tolerance):
    for count in ("used", "exact", "interpolated", "skipped"):
        assert getattr(evaluation, count) == expected["relations"][count], count
    for figure in FIGURES:
        for name, value in expected[figure].items():
            assert getattr(getattr(evaluation, figure), name) == pytest.approx(value, abs=tolerance), figure


@pytest.fixture(scope="module")
def expected(files, psi_slam_program):
    return json.loads(psi_slam_program("eval", *files, "--json").stdout)


def test_files_give_the_figures_of_the_program(files, expected):
    assert_figures(psi_slam.evaluate(*files), expected, 0)
    assert expected["relations"]["used"] == 43 and expected["relations"]["interpolated"] == 15


def test_results_and_arrays_give_the_same_figures(result, files, expected):
    # Files have fewer decimals.
    for trajectory in (result, result.poses, str(files[0])):
        assert_figures(psi_slam.evaluate(trajectory, relations_array()), expected, 1e-4)
    plain = np.stack([result.poses[name] for name in ("time_s", "x_m", "y_m", "yaw_rad")], axis=1)
    assert_figures(psi_slam.evaluate(plain, relations_array()), expected, 1e-4)


def test_tables_of_pandas_give_the_same_figures(result, files, expected):
    pandas = pytest.importorskip("pandas")
    evaluation = psi_slam.evaluate(pandas.DataFrame(result.poses), pandas.DataFrame(relations_array()))
    assert_figures(evaluation, expected, 1e-4)


def test_the_table_of_a_run_gives_the_same_figures(files, expected, psi_slam_program):
    table = files[0].with_suffix(".csv")
    assert_figures(psi_slam.evaluate(table, files[1]), expected, 1e-4)  # the table has fewer decimals
    run = psi_slam_program("eval", table, files[1], "--json")
    assert json.loads(run.stdout)["relations"] == expected["relations"]
    array = np.genfromtxt(table, delimiter=",", names=True)
    assert "theta_rad" in array.dtype.names and "yaw_rad" not in array.dtype.names
    assert_figures(psi_slam.evaluate(array, relations_array()), expected, 1e-4)


def test_errors_belong_to_the_relations_used(result):
    evaluation = psi_slam.evaluate(result, relations_array())
    assert len(evaluation.errors) == evaluation.used == 43
    assert evaluation.errors["translation_m"].mean() == pytest.approx(evaluation.translation_abs_m.mean)
    assert evaluation.errors["interpolated"].sum() == evaluation.interpolated
    np.testing.assert_array_equal(evaluation.errors["time2_s"], relations_array()["time2_s"][:-1])
    assert evaluation.translation_abs_m.mean < 0.05


def test_the_longest_gap_can_be_set(result):
    assert psi_slam.evaluate(result, relations_array(), max_gap_s=0.1).skipped == 16


def test_wrong_arguments_are_refused(result, files, tmp_path):
    relations = relations_array()
    for arguments, sentence in (
        ((result, np.zeros((3, 4))), "relations: the array has the shape (3, 4), expected"),
        ((np.zeros(3), relations), "trajectory: the array has the shape (3,), expected"),
        ((result.poses[["time_s", "x_m", "y_m"]], relations), "trajectory: the column yaw_rad is missing"),
        ((tmp_path / "missing.tum", relations), "missing.tum"),
        ((result, relations[-1:]), "relation"),
    ):
        with pytest.raises(psi_slam.UserError) as caught:
            psi_slam.evaluate(*arguments)
        assert sentence in str(caught.value)
    with pytest.raises(psi_slam.UserError, match="max_gap_s is -1, expected"):
        psi_slam.evaluate(result, relations, max_gap_s=-1)
    with pytest.raises(psi_slam.UserError, match="trajectory: the column time_s holds other values than numbers"):
        psi_slam.evaluate([list("abcd")] * 2, relations)


def test_values_that_are_not_finite_are_refused_with_their_row(result):
    for value in (math.nan, math.inf):
        for name in ("time_s", "x_m", "yaw_rad"):
            broken = result.poses.copy()
            broken[name][3] = value
            with pytest.raises(psi_slam.UserError, match=f"trajectory: {name} of row 3 .* is {value}, expected"):
                psi_slam.evaluate(broken, relations_array())
        broken = relations_array()
        broken["y_m"][2] = value
        with pytest.raises(psi_slam.UserError, match=f"relations: y_m of row 2 .* is {value}, expected"):
            psi_slam.evaluate(result, broken)
    broken = result.poses.copy()
    broken["time_s"][3] = 1e20
    with pytest.raises(psi_slam.UserError, match="trajectory: a time is 1e.20"):
        psi_slam.evaluate(broken, relations_array())
