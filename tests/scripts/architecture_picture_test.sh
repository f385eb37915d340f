#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every library and every program is in the picture of the architecture, in its text source and in what was drawn of it.
#
#     architecture_picture_test.sh SOURCE
set -euo pipefail
cd "$1"

status=0
drawn=$(sed 's/&#45;/-/g' share/doc/architecture.svg)
for folder in libs/*/ apps/*/; do
  name=$(basename "$folder")
  grep -Eq "(^|[^a-z_-])$name([^a-z_-]|$)" share/doc/architecture.dot || { echo "architecture.dot lacks $name"; status=1; }
  grep -q ">$name</text>" <<<"$drawn" ||
    { echo "architecture.svg lacks $name: run share/scripts/draw-architecture.sh"; status=1; }
done
grep -q '](architecture.svg)' share/doc/architecture.md || { echo "architecture.md does not show it"; status=1; }
exit "$status"
