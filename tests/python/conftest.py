# SPDX-License-Identifier: BSD-3-Clause
import os
import subprocess

import pytest
import room

SCANS = 320


def program(name):
    return os.path.join(os.environ["PSI_SLAM_APPS"], name, name)


@pytest.fixture(scope="session")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("logs") / "room.log"
    room.write_log(path, SCANS)
    return path


@pytest.fixture(scope="session")
def psi_slam_program():
    """Runs the program psi-slam, or another one of its programs."""

    def run(*arguments, name="psi-slam"):
        return subprocess.run(
            [program(name), *map(str, arguments)], capture_output=True, text=True, timeout=300, check=False
        )

    return run


@pytest.fixture(scope="session")
def result(log):
    import psi_slam

    return psi_slam.map(log)
