#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the missing packages of one or more lists with apt-get. Does nothing if all of them are installed.
#
#     share/scripts/install-dependencies.sh [--print] [LIST...]     # default: build runtime
#
#     build      compiles the programs and the library
#     runtime    runs the compiled programs
#     test       runs the tests, and compiles the Python module: needed beside build and runtime
#     documentation   makes the site of all pages and of the C++ reference; part of the list test
#
# --print prints the packages and installs nothing. Names of libraries differ between releases, so the lists contain them
# as extended regular expressions.
set -euo pipefail
cd "$(dirname "$0")/../.."

readonly tried="Debian 12 and Debian 13"
readonly lock_timeout_s=300  # how long to wait for another program that installs packages
# shellcheck disable=SC2034  # the lists are read by their names
build=(
  build-essential cmake ninja-build pkg-config file
  libmrpt-dev libeigen3-dev libopencv-dev libwxgtk3.2-dev libgdal-dev
  libcli11-dev nlohmann-json3-dev libpng-dev zlib1g-dev libbz2-dev liblzma-dev liblz4-dev
  libzstd-dev libsqlite3-dev libssl-dev libsleef-dev cyclonedds-dev cyclonedds-tools
)
# shellcheck disable=SC2034
runtime=(
  'libmrpt-slam[0-9.]+' 'libmrpt-graphslam[0-9.]+' 'libmrpt-hwdrivers[0-9.]+' 'libmrpt-gui[0-9.]+' mrpt-common
  'libopencv-imgcodecs[0-9]+(t64)?' 'libwxgtk3.2-1(t64)?' 'libwxgtk-gl3.2-1(t64)?' 'libgdal[0-9]+(t64)?' 'libssl3(t64)?'
  'libpng16-16(t64)?' zlib1g libbz2-1.0 liblzma5 liblz4-1 libzstd1 libsqlite3-0 libsleef3 'libddsc0[a-z0-9]*' libgl1 libopengl0 libgl1-mesa-dri
)
# shellcheck disable=SC2034
test=(
  libgtest-dev libgmock-dev libx11-dev xauth xvfb openbox dpkg-dev
  pybind11-dev python3-dev python3-numpy python3-pytest python3-matplotlib python3-pandas mypy
  gdal-bin python3-gdal python3-ezdxf python3-pil librsvg2-bin man-db groff-base
)

# shellcheck disable=SC2034
documentation=(doxygen python3)
test+=("${documentation[@]}")

# Part of the list `test`. Where the release has no package of these, tests do without it or are skipped.
optional=(
  python3-rosbag python3-nav-msgs python3-sensor-msgs python3-tf2-msgs libg2o-dev python3-gtsam
  'lib(fastrtps|fastdds)-dev' fastddsgen ros-std-msgs ros-geometry-msgs ros-sensor-msgs ros-nav-msgs ros-tf2-msgs
  ros-rosgraph-msgs ros-visualization-msgs ros-diagnostic-msgs
)
test+=("${optional[@]}")

say() { echo "install-dependencies.sh: $*" >&2; }
fail() {
  say "$*"
  exit 1
}

# shellcheck disable=SC1091  # the file is part of the system
system_name() {
  (. /etc/os-release 2>/dev/null && echo "${PRETTY_NAME:-an unknown system}") || echo "an unknown system"
}

# Succeeds on a release that `tried` names.
# shellcheck disable=SC1091
is_tried_system() {
  (. /etc/os-release 2>/dev/null && [[ "${ID:-} ${VERSION_ID:-}" =~ ^debian\ (12|13)$ ]])
}

# without NAMES EXPRESSION...: prints the expressions that match no line of the file NAMES as a whole.
without() {
  local names=$1 expression
  shift
  for expression in "$@"; do
    grep --quiet --extended-regexp --line-regexp -e "$expression" "$names" || echo "$expression"
  done
}

# Prints the newest package of each expression that the release has.
packages_of() {
  local expression
  for expression in "$@"; do
    grep --extended-regexp --line-regexp -e "$expression" "$work/available" | sort --version-sort | tail -n 1 || true
  done
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo ${CI:+--non-interactive} "$@"
  else
    fail "installing packages needs root. Run this script as root, or install sudo"
  fi
}

# Waits while another program installs packages, which apt-get says. Its messages are in English, see update_lists.
apt_get() {
  as_root env LC_ALL=C DEBIAN_FRONTEND=noninteractive apt-get --quiet --option "DPkg::Lock::Timeout=$lock_timeout_s" "$@"
}

# Updates the lists of packages. apt-get itself does not wait for another program that updates them.
update_lists() {
  local end=$((SECONDS + lock_timeout_s))
  until apt_get update >"$work/update" 2>&1; do
    cat "$work/update" >&2
    grep --quiet "get lock" "$work/update" || fail "apt-get update failed. Check that this machine is online"
    [ "$SECONDS" -lt "$end" ] ||
      fail "another program has used the lists of packages for $((lock_timeout_s / 60)) minutes. Wait for its end, and try again"
    say "another program uses the lists of packages: waiting for it, at most $((lock_timeout_s / 60)) minutes"
    sleep 5
  done
}

check_cmake() {
  local needed found
  needed=$(sed -n 's/^cmake_minimum_required(VERSION \([0-9.]*\)).*/\1/p' CMakeLists.txt)
  found=$(cmake --version 2>/dev/null | sed -n 's/^cmake version \([0-9.]*\).*/\1/p')
  [ -n "$found" ] || fail "cmake is installed but prints no version. Check it with cmake --version"
  [ "$(printf '%s\n' "$needed" "$found" | sort --version-sort | head -n 1)" = "$needed" ] ||
    fail "CMake $needed or later is needed, but $(command -v cmake) is version $found. Put a newer one first in PATH"
}

only_print=false
if [ "${1:-}" = --print ]; then
  only_print=true
  shift
fi
if [ $# -eq 0 ]; then set -- build runtime; fi
wanted=()
for list in "$@"; do
  case "$list" in
    build | runtime | test | documentation)
      declare -n packages=$list
      wanted+=("${packages[@]}")
      ;;
    *)
      say "there is no list $list. Name one or more of build, runtime, test and documentation"
      exit 2
      ;;
  esac
done
if $only_print; then
  printf '%s\n' "${wanted[@]}"
  exit
fi
command -v apt-get >/dev/null ||
  fail "this system is $(system_name), which has no apt-get. Install the packages that share/doc/install.md lists under" \
    "Dependencies, then run cmake --preset release"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p' >"$work/installed"
mapfile -t missing < <(without "$work/installed" "${wanted[@]}")
if [ "${#missing[@]}" -eq 0 ]; then
  say "all packages for $* are installed"
else
  is_tried_system || say "psi-slam was tried on $tried, but not on $(system_name). Packages may be missing or too old there"
  update_lists
  # Packages that depend on a name make it known, even if the release does not have it: print only what has a version.
  apt-cache dumpavail | sed -n 's/^Package: //p' >"$work/available"
  mapfile -t unavailable < <(without "$work/available" "${missing[@]}")
  needed=()
  for package in "${unavailable[@]}"; do
    if [[ " ${optional[*]} " == *" $package "* ]]; then
      say "$(system_name) has no package $package. Tests do without it or are skipped"
    else
      needed+=("$package")
    fi
  done
  [ "${#needed[@]}" -eq 0 ] ||
    fail "$(system_name) lacks the packages ${needed[*]}. Use $tried, or build what is missing from source and run" \
      "cmake --preset release"
  mapfile -t packages_to_install < <(packages_of "${missing[@]}")
  if [ "${#packages_to_install[@]}" -gt 0 ]; then
    say "installing ${packages_to_install[*]}"
    apt_get install --yes --no-install-recommends "${packages_to_install[@]}" >&2 ||
      fail "apt-get install failed. Read its message above"
  fi
fi
if [[ " $* " == *" build "* ]]; then check_cmake; fi
