#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fails if a library of psi-slam calls one of the C library's functions for floats, such as atan2f(). Their last bit differs
# between versions of the C library, and one bit may change the map. Compute in double and round, as base/float_hypot.h does.
#
#     float_functions_test.sh BUILD
set -euo pipefail

functions='(a?(sin|cos|tan)h?|atan2|sincos|exp(2|10|m1)?|log(2|10|1p)?|pow|hypot|cbrt|erfc?|[tl]gamma)f'
mapfile -t libraries < <(find "$1/libs" -name '*.a')
if [ "${#libraries[@]}" -eq 0 ]; then
  echo "float_functions_test.sh: $1/libs contains no library. Build psi-slam first" >&2
  exit 1
fi
symbols=$(mktemp)
trap 'rm -f "$symbols"' EXIT
if ! nm --print-file-name "${libraries[@]}" >"$symbols" || ! grep --quiet ' T ' "$symbols"; then
  echo "float_functions_test.sh: nm does not print the functions of the libraries in $1/libs" >&2
  exit 1
fi
if calls=$(grep --extended-regexp " U $functions\$" "$symbols"); then
  echo "float_functions_test.sh: these files call functions for floats:" >&2
  echo "$calls" >&2
  exit 1
fi
echo "${#libraries[@]} libraries call no function for floats"
