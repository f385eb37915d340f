# SPDX-License-Identifier: BSD-3-Clause
"""Makes floor plans from the lidar scans of wheeled robots, with or without odometry.

    import psi_slam

    result = psi_slam.map("my.log", settings={"map.resolution_m": 0.1})
    print(result.verdict.sentence)
    result.save("out")

The page share/doc/python.md explains the module with examples.
"""

from psi_slam._core import (
    ErrorSummary,
    Evaluation,
    GridMap,
    HotSpot,
    Interrupted,
    Mapper,
    Pose,
    Progress,
    Result,
    Scan,
    SystemFailure,
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
    "Pose",
    "Progress",
    "Result",
    "Scan",
    "SystemFailure",
    "UserError",
    "Verdict",
    "__version__",
    "evaluate",
    "map",
]
