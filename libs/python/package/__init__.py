# SPDX-License-Identifier: BSD-3-Clause
"""Makes floor plans from the lidar scans of wheeled robots, with or without odometry.

    import psi_slam

    result = psi_slam.map("my.log", settings={"map.resolution_m": 0.1})
    print(result.verdict.sentence)
    result.save("out")

The page share/doc/python.md explains the module with examples.
"""

try:
    import numpy as _numpy  # _core needs it, and would only say that its initialization failed
except ModuleNotFoundError as _error:
    raise ImportError("psi_slam needs NumPy. Install python3-numpy, or run /usr/bin/python3") from _error

from psi_slam._core import (
    ErrorSummary,
    Evaluation,
    GridMap,
    HotSpot,
    Interrupted,
    Mapper,
    OpenStretch,
    Pose,
    Progress,
    Result,
    Scan,
    SceneChange,
    SystemFailure,
    UncheckedStretch,
    UserError,
    Verdict,
    __version__,
    evaluate,
    map,
)

__all__ = [
    "ErrorSummary",
    "Evaluation",
    "GridMap",
    "HotSpot",
    "Interrupted",
    "Mapper",
    "OpenStretch",
    "Pose",
    "Progress",
    "Result",
    "Scan",
    "SceneChange",
    "SystemFailure",
    "UncheckedStretch",
    "UserError",
    "Verdict",
    "__version__",
    "evaluate",
    "map",
]
