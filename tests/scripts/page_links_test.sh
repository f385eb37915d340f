#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks the links of the pages. Every linked file and heading must exist. A link whose text is the name of a C++ function or
# class must lead to a file that contains this name. Checks the README's length.
#
#     page_links_test.sh SOURCE
set -euo pipefail
cd "$1"

status=0
complain() {
  echo "$*"
  status=1
}

# anchors PAGE: the anchors that GitHub gives to the headings of a page.
anchors() {
  # shellcheck disable=SC2016  # the backquotes are those of Markdown
  sed -n '/^```/,/^```/d; s/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' | sed 's/[^[:alnum:] _-]//g; s/ /-/g'
}

# links PAGE: its links as lines "TEXT<tab>TARGET", without those in code blocks and to other sites.
links() {
  # shellcheck disable=SC2016
  sed '/^```/,/^```/d' "$1" | tr '\n' ' ' | grep -oE '\[[^][]*\]\([^() ]+\)' | sed -E 's/^\[([^][]*)\]\((.*)\)$/\1\t\2/' |
    grep -vE $'\t(https?|mailto):' || true
}

pages=(README.md CONTRIBUTING.md CHANGELOG.md share/doc/*.md share/doc/history/*.md)
for page in "${pages[@]}"; do
  while IFS=$'\t' read -r text target; do
    file=$page
    [ "${target%%#*}" = '' ] || file=$(realpath --no-symlinks --canonicalize-missing --relative-to=. "$(dirname "$page")/${target%%#*}")
    if [ ! -e "$file" ]; then
      complain "$page links to $target, which does not exist"
    elif [[ $target == *#* ]] && ! anchors "$file" | grep -qxF -- "${target#*#}"; then
      complain "$page links to $target, but $file has no such heading"
    elif [[ $file =~ \.(cpp|h)$ && $text =~ ^\`([A-Za-z_:]+)\`$ ]]; then
      name=${BASH_REMATCH[1]}
      grep -qE "(^|[^A-Za-z_])$name([^A-Za-z_]|$)" "$file" || complain "$page links $name to $file, which does not contain it"
    fi
  done < <(links "$page")
done

lines=$(wc -l <README.md)
[ "$lines" -le 150 ] || complain "README.md has $lines lines; move what exceeds 150 to a page in share/doc"
exit "$status"
