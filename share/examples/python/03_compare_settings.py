# SPDX-License-Identifier: BSD-3-Clause
"""Maps a log with several settings and compares the maps in a table of pandas.

    python3 03_compare_settings.py my.log [my.relations]
"""

import sys
from typing import Any, Optional

import pandas as pd

import psi_slam

VARIANTS: dict[str, dict[str, Any]] = {
    "defaults": {},
    "loop_closure.enabled = false": {"loop_closure.enabled": False},
    "loop_closure.matcher = csm": {"loop_closure.matcher": "csm"},
    "front_end.window_m = 0.3": {"front_end.window_m": 0.3},
}


def figures(log: str, settings: dict[str, Any], relations: Optional[str]) -> dict[str, Any]:
    result = psi_slam.map(log, settings)
    row: dict[str, Any] = {
        "verdict": result.verdict.state,
        "doubt_m": result.verdict.doubt_m,
        "loops": (result.loops["state"] == "accepted").sum(),
        "mean_response": result.poses["response"].mean(),
        "wall_s": result.summary["wall_s"],
    }
    if relations is not None:  # the true error, where it is known
        row["error_m"] = psi_slam.evaluate(result, relations).translation_abs_m.mean
    return row


def main() -> int:
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    relations = sys.argv[2] if len(sys.argv) == 3 else None
    try:
        rows = {name: figures(sys.argv[1], settings, relations) for name, settings in VARIANTS.items()}
    except psi_slam.UserError as error:
        print(error, file=sys.stderr)
        return 2
    table = pd.DataFrame.from_dict(rows, orient="index").sort_values("doubt_m")
    print(table.to_string(float_format="{:.4f}".format))
    return 0


if __name__ == "__main__":
    sys.exit(main())
