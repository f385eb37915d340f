#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fails if a library of psi-slam calls a function of the C library, or an operator of MRPT's poses that calls one, whose last
# bit differs between versions of the C library or between processors. One bit may change the map. base/portable_math.h and
# frames/pose_operations.h have functions that round alike everywhere. Not checked: libpsi_slam_graphslam.a, whose maps come from
# MRPT's own algorithms.
#
#     portable_functions_test.sh BUILD
set -euo pipefail

functions='(a?(sin|cos|tan)h?|atan2|sincos|exp(2|10|m1)?|log(2|10|1p)?|pow|hypot|cbrt|erfc?|[tl]gamma)f?'
pose_operators='_ZNK4mrpt4math7TPose2D(pl|mi)E.*|_ZNK4mrpt4math7TPose2D(inverseC|c)ompose.*|_ZN4mrpt5poses7CPose2D.*compose.*'
mapfile -t libraries < <(find "$1/libs" "$1/apps" -name '*.a' ! -name libpsi_slam_graphslam.a)
if [ "${#libraries[@]}" -eq 0 ]; then
  echo "portable_functions_test.sh: $1/libs contains no library. Build psi-slam first" >&2
  exit 1
fi
symbols=$(mktemp)
trap 'rm -f "$symbols"' EXIT
if ! nm --print-file-name "${libraries[@]}" >"$symbols" || ! grep --quiet ' T ' "$symbols"; then
  echo "portable_functions_test.sh: nm does not print the functions of the libraries in $1" >&2
  exit 1
fi
if calls=$(grep --extended-regexp " U ($functions|$pose_operators)\$" "$symbols"); then
  echo "portable_functions_test.sh: these files call functions that do not round alike everywhere:" >&2
  echo "$calls" >&2
  exit 1
fi
echo "${#libraries[@]} libraries call only functions that round alike everywhere"
