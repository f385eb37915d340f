#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From a bare Debian 12 to a first map: installs the dependencies, builds, and maps the Telecom Faculty log that
# MRPT's data package brings along. Prints where the map is.
set -euo pipefail
cd "$(dirname "$0")/../.."

log="/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"
output=out/quickstart

share/scripts/build.sh psi-slam psi-slam-eval
if [ ! -r "$log" ]; then
  echo "quickstart.sh: $log is missing; sudo apt-get install --reinstall mrpt-common brings it back" >&2
  exit 1
fi
build/release/apps/psi-slam/psi-slam -c ini/psi-slam.ini "$log" -o "$output" --force
echo "The map is $PWD/$output/map.png, and $PWD/$output/report.html tells how it was made."
