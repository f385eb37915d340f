#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks what install-dependencies.sh installs, with an apt-get that only writes down its arguments.
#
#     install_dependencies_test.sh SOURCE
set -euo pipefail
install=$1/share/scripts/install-dependencies.sh
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() {
  echo "install_dependencies_test.sh: $*" >&2
  exit 1
}

# program NAME LINE...: makes a program that runs instead of the system's.
program() {
  local name=$1
  shift
  printf '%s\n' '#!/bin/sh' "$@" >"$scratch/bin/$name"
  chmod +x "$scratch/bin/$name"
}

# installs LIST...: prints what the script tells apt-get to install.
installs() {
  rm -f "$scratch/calls"
  PATH=$scratch/bin:$PATH "$install" "$@" 2>"$scratch/words" || return
  sed -n 's/.*install --yes --no-install-recommends //p' "$scratch/calls"
}

# The lists do not overlap, and those for build and run contain nothing for tests only.
all=$("$install" --print build runtime test)
[ -z "$(sort <<<"$all" | uniq -d)" ] || fail "lists share $(sort <<<"$all" | uniq -d)"
default=$("$install" --print)
[ "$default" = "$("$install" --print build runtime)" ] || fail "the default is not build and runtime"
if grep -E 'xvfb|openbox|rosbag|msgs|gtest|doxygen' <<<"$default"; then fail "build and runtime contain packages of tests"; fi

# A fake release: nothing installed but cmake; two versions of GDAL are available.
mkdir "$scratch/bin"
program apt-get "echo \"\$@\" >>'$scratch/calls'"
# shellcheck disable=SC2016  # the program expands $1 and $@
program sudo 'while [ "$1" = --non-interactive ]; do shift; done' 'exec "$@"'
program dpkg-query 'echo "installed cmake"' 'echo "config-files zlib1g"'
"$install" --print build runtime test | grep -v '[[(]' | sed 's/^/Package: /' >"$scratch/packages"
printf 'Package: %s\n' libgdal9 libgdal36t64 libgdal-grass libmrpt-slam2.14 libmrpt-graphslam2.14 libmrpt-hwdrivers2.14 \
  libmrpt-gui2.14 libopencv-imgcodecs410 libwxgtk3.2-1t64 libwxgtk-gl3.2-1t64 libssl3t64 libpng16-16t64 libddsc0debian >>"$scratch/packages"
program apt-cache "cat '$scratch/packages'"

runtime=" $(installs runtime) "
for package in libgdal36t64 libmrpt-gui2.14 zlib1g mrpt-common; do
  [[ "$runtime" == *" $package "* ]] || fail "the list runtime lacks $package:$runtime"
done
for package in libgdal9 libgdal-grass libgtest-dev cmake; do
  [[ "$runtime" != *" $package "* ]] || fail "the list runtime installs $package"
done
build=" $(installs build) "
if grep "another program" "$scratch/words"; then fail "says that it waits although nothing is locked"; fi
[[ "$build" == *" libmrpt-dev "* ]] || fail "the list build lacks libmrpt-dev:$build"
[[ "$build" != *" cmake "* ]] || fail "installs cmake again, which is installed"

# Packages of ROS may be missing.
sed -i '/python3-rosbag/d' "$scratch/packages"
tests=" $(installs test) "
[[ "$tests" == *" libgtest-dev "* ]] || fail "the list test is not installed without python3-rosbag: $(cat "$scratch/words")"
grep -q 'has no package python3-rosbag. Tests do without it or are skipped' "$scratch/words" ||
  fail "the missing package of ROS is not named: $(cat "$scratch/words")"

# A package that the release lacks stops the script before it installs anything.
sed -i '/libcli11-dev/d' "$scratch/packages"
if installs build; then fail "a missing package is no error"; fi
grep -q 'lacks the packages libcli11-dev' "$scratch/words" || fail "the missing package is not named: $(cat "$scratch/words")"
if grep -q install "$scratch/calls"; then fail "installs although a package is missing"; fi

# The script waits for another program that has locked the packages.
echo "Package: libcli11-dev" >>"$scratch/packages"
program apt-get "echo \"\$@\" >>'$scratch/calls'" \
  "if [ ! -e '$scratch/was_locked' ]; then" \
  "  touch '$scratch/was_locked'" \
  "  message='E: Konnte Sperre /var/lib/apt/lists/lock nicht bekommen.'" \
  "  if [ \"\$LC_ALL\" = C ]; then message='E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7'; fi" \
  "  echo \"\$message\" >&2" \
  "  exit 100" \
  "fi"
installs build >/dev/null || fail "a locked list of packages stops the script: $(cat "$scratch/words")"
grep -q "another program uses the lists of packages: waiting for it, at most 5 minutes" "$scratch/words" ||
  fail "the script does not say that it waits: $(cat "$scratch/words")"
[ "$(grep -c ' update$' "$scratch/calls")" -eq 2 ] || fail "the list is not updated again: $(cat "$scratch/calls")"
grep -q -- "--option DPkg::Lock::Timeout=300 install" "$scratch/calls" ||
  fail "apt-get does not wait for the lock of dpkg: $(cat "$scratch/calls")"
program apt-get "echo 'E: Could not resolve deb.debian.org' >&2" "exit 100"
if installs build; then fail "a failed update is no error"; fi
grep -q "apt-get update failed. Check that this machine is online" "$scratch/words" || fail "says $(cat "$scratch/words")"
program apt-get "echo \"\$@\" >>'$scratch/calls'"
touch "$scratch/calls"

# If all is installed, apt-get is not called.
program dpkg-query "sed -n 's/^Package: /installed /p' '$scratch/packages'"
rm "$scratch/calls"
PATH=$scratch/bin:$PATH "$install" runtime 2>/dev/null || fail "the list runtime fails though it is installed"
[ ! -e "$scratch/calls" ] || fail "calls apt-get though all is installed: $(cat "$scratch/calls")"

status=0
"$install" tests 2>"$scratch/words" || status=$?
[ "$status" -eq 2 ] || fail "an unknown list ends with $status"
grep -q "no list tests. Name one or more of build, runtime, test and documentation" "$scratch/words" ||
  fail "an unknown list gives $(cat "$scratch/words")"
echo "all lists are right"
