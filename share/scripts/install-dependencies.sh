#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the packages that are needed to build psi-slam on Debian 12. Does nothing if all of them are installed.
set -euo pipefail
cd "$(dirname "$0")/../.."

packages=(
  build-essential cmake ninja-build pkg-config
  libmrpt-dev mrpt-common libeigen3-dev libopencv-dev libwxgtk3.2-dev
  libgl1-mesa-dri xauth xvfb
  libcli11-dev nlohmann-json3-dev zlib1g-dev libbz2-dev liblz4-dev libzstd-dev libsqlite3-dev
  libssl-dev libnanoflann-dev libgdal-dev libgtest-dev libgmock-dev python3
  doxygen python3-rosbag python3-nav-msgs python3-sensor-msgs python3-tf2-msgs
  libopenmpi-dev openmpi-bin
  gdal-bin python3-gdal python3-ezdxf python3-pil librsvg2-bin man-db groff-base dpkg-dev file
)
packages+=(pybind11-dev python3-dev python3-numpy)  # the Python module
packages+=(python3-pytest python3-matplotlib python3-pandas mypy)  # its tests

fail() {
  echo "install-dependencies.sh: $*" >&2
  exit 1
}

# shellcheck disable=SC1091  # the file is part of the system
system_name() {
  (. /etc/os-release 2>/dev/null && echo "${PRETTY_NAME:-an unknown system}") || echo "an unknown system"
}

# Succeeds on Debian 12 or later. Debian testing states no version and is accepted.
# shellcheck disable=SC1091
is_supported_system() {
  command -v apt-get >/dev/null && command -v dpkg-query >/dev/null || return 1
  (. /etc/os-release 2>/dev/null && [ "${ID:-}" = debian ] && [ "${VERSION_ID:-12}" -ge 12 ])
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
      echo "$package"
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

apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get --quiet "$@"
}

check_cmake() {
  local needed found
  needed=$(sed -n 's/^cmake_minimum_required(VERSION \([0-9.]*\)).*/\1/p' CMakeLists.txt)
  found=$(cmake --version 2>/dev/null | sed -n 's/^cmake version \([0-9.]*\).*/\1/p')
  [ -n "$found" ] || fail "cmake is installed but prints no version. Check it with cmake --version"
  [ "$(printf '%s\n' "$needed" "$found" | sort --version-sort | head -n 1)" = "$needed" ] ||
    fail "CMake $needed or later is needed, but $(command -v cmake) is version $found. Put a newer one first in PATH"
}

is_supported_system ||
  fail "this system is $(system_name), but the script needs Debian 12 or later. Install the packages that" \
    "share/doc/install.md lists under Dependencies, then run cmake --preset release"

mapfile -t missing < <(missing_packages)
if [ "${#missing[@]}" -eq 0 ]; then
  echo "install-dependencies.sh: all packages that psi-slam needs are installed" >&2
else
  echo "install-dependencies.sh: installing ${missing[*]}" >&2
  apt_get update >&2 || fail "apt-get update failed. Check that this machine is online"
  apt_get install --yes --no-install-recommends "${missing[@]}" >&2 ||
    fail "apt-get install failed. Read its message above"
fi
check_cmake
