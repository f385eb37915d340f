#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the site of the target docs and checks its links. Doxygen fails if a public symbol is undocumented and on every other
# warning.
#
#     site_test.sh SOURCE BUILD
set -euo pipefail
source=$(cd "$1" && pwd)
cd "$2"
if ! command -v doxygen >/dev/null || [ ! -e Doxyfile.docs ]; then
  printf 'site_test.sh: Skipped\nneeds Doxygen and a build configured with it: install-dependencies.sh documentation\n'
  exit 77
fi
"$source/share/scripts/site-pages.py" "$source" site-pages site
doxygen Doxyfile.docs
"$source/tests/scripts/site_links_test.py" "$source" site

# A link to a missing file or heading is found.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r site "$scratch/site"
sed -i 's/psi-slam-verdict-about-the-map/psi-slam-renamed/g' "$scratch/site/psi-slam.html"
sed -i '0,/tutorial\.html/s//no-such-page.html/' "$scratch/site/all-pages.html"
if "$source/tests/scripts/site_links_test.py" "$source" "$scratch/site" >"$scratch/words"; then
  echo "site_test.sh: broken links are not found" >&2
  exit 1
fi
for words in 'which does not exist' 'has no such anchor'; do
  if ! grep -q "$words" "$scratch/words"; then
    echo "site_test.sh: no link is reported as one $words: $(cat "$scratch/words")" >&2
    exit 1
  fi
done
