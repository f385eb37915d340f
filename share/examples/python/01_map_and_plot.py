# SPDX-License-Identifier: BSD-3-Clause
"""Maps a log and plots the map, the path and the closed loops with matplotlib.

    python3 01_map_and_plot.py my.log [plot.png]      without plot.png: opens a window
"""

import sys

import matplotlib.pyplot as plt

import psi_slam


def show_progress(progress: psi_slam.Progress) -> None:
    print(f"\r{progress.phase}: {progress.share:4.0%}, {progress.scans} scans", end="", file=sys.stderr)


def plot(result: psi_slam.Result) -> None:
    grid = result.grid_map
    poses = result.poses
    figure, axes = plt.subplots(figsize=(9, 9))
    axes.imshow(grid.occupancy, origin="lower", extent=grid.extent, cmap="gray_r", vmin=0, vmax=1)
    axes.plot(poses["x_m"], poses["y_m"], linewidth=1, label="path")
    for loop in result.loops[result.loops["state"] == "accepted"]:
        node = poses[loop["frame"]]
        anchor = poses[poses["node"] == loop["anchor"]][0]
        axes.plot([anchor["x_m"], node["x_m"]], [anchor["y_m"], node["y_m"]], "g-", linewidth=0.5)
    for spot in result.verdict.hot_spots:
        axes.plot(spot.x_m, spot.y_m, "rx", markersize=10)
    axes.set(xlabel="x [m]", ylabel="y [m]", title=f"The map is {result.verdict.state}")
    axes.legend()
    figure.tight_layout()


def main() -> int:
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        result = psi_slam.map(sys.argv[1], progress=show_progress)
    except psi_slam.UserError as error:
        print(error, file=sys.stderr)
        return 2
    except psi_slam.Interrupted as interrupted:  # Ctrl-C: plots the scans so far
        result = interrupted.result
    print(f"{len(result.poses)} scans. Verdict: {result.verdict.sentence}.")
    plot(result)
    if len(sys.argv) == 3:
        plt.savefig(sys.argv[2], dpi=150)
    else:
        plt.show()
    return 0


if __name__ == "__main__":
    sys.exit(main())
