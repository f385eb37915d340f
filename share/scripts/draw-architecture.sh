#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws share/doc/architecture.svg from architecture.dot. Needs Debian's package graphviz.
set -euo pipefail
cd "$(dirname "$0")/../doc"

command -v dot >/dev/null || {
  echo "draw-architecture.sh: the program dot is missing. Install it with sudo apt-get install graphviz" >&2
  exit 1
}
dot -Tsvg architecture.dot -o architecture.svg
