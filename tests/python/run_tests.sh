#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests the Python module of a build.
#
#     run_tests.sh PYTHON BUILD TEST...
#
# Ends with exit code 77 if PYTHON lacks pytest or NumPy.
set -euo pipefail

python=$1
PYTHONPATH="$(cd "$2" && pwd)/python"
PSI_SLAM_APPS="$(cd "$2" && pwd)/apps"
export PYTHONPATH PSI_SLAM_APPS PYTHONDONTWRITEBYTECODE=1
shift 2
"$python" -c 'import numpy, pytest' 2>/dev/null || {
  echo "run_tests.sh: $python lacks pytest or NumPy. Install Debian's packages python3-pytest and python3-numpy" >&2
  exit 77
}
status=0
"$python" -m pytest -q -rs -p no:cacheprovider "$@" || status=$?
[ "$status" -ne 5 ] || status=77  # all tests were skipped
exit "$status"
