#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks that the architecture picture shows every library and every program. Checks both architecture.dot and the
# architecture.svg drawn from it.
#
#     architecture_picture_test.sh SOURCE
set -euo pipefail
cd "$1"

status=0
drawn=$(sed 's/&#45;/-/g' share/doc/architecture.svg)
for folder in libs/*/ apps/*/; do
  name=$(basename "$folder")
  [ "$name" != include ] || continue  # the public headers of all libraries
  grep -Eq "(^|[^a-z_-])$name([^a-z_-]|$)" share/doc/architecture.dot ||
    { echo "share/doc/architecture.dot lacks $name"; status=1; }
  grep -q ">$name</text>" <<<"$drawn" ||
    { echo "share/doc/architecture.svg lacks $name. Run share/scripts/draw-architecture.sh"; status=1; }
done
grep -q '](architecture.svg)' share/doc/architecture.md ||
  { echo "share/doc/architecture.md does not show architecture.svg"; status=1; }
exit "$status"
