#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a first map on a fresh Debian 12 or 13. Installs what build and run need, builds psi-slam, and maps the Telecom Faculty
# log from MRPT's data package. Prints the path of the map. Takes about 5 minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."

log="/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"
output=out/quickstart

share/scripts/build.sh psi-slam
if [ ! -r "$log" ]; then
  echo "quickstart.sh: $log is missing. Restore it with sudo apt-get install --reinstall mrpt-common" >&2
  exit 1
fi
build/release/apps/psi-slam/psi-slam "$log" -o "$output" --force
echo "The map is $PWD/$output/map.png. The report is $PWD/$output/report.html."
