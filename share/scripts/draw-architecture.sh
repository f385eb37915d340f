#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws share/doc/architecture.svg and scan-to-map.svg from the .dot files beside them. Needs Debian's package graphviz.
set -euo pipefail
cd "$(dirname "$0")/../doc"

command -v dot >/dev/null || {
  echo "draw-architecture.sh: the program dot is missing. Install it with sudo apt-get install graphviz" >&2
  exit 1
}
for picture in architecture scan-to-map; do
  dot -Tsvg "$picture.dot" -o "$picture.svg"
done
