#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the Debian packages of a build and installs them with apt-get in a minimal system of the same Debian release, in a
# temporary folder. Maps a log and builds the examples there. Checks the packages with lintian where it is installed.
#
#   share/scripts/check-package.sh [BUILD]        default: build/release, with all targets built
#
# Needs root, debootstrap and the network. If one is missing, prints a message and ends with exit code 77.
# PSI_SLAM_DEBIAN_MIRROR names a mirror other than deb.debian.org. PSI_SLAM_BARE_DEBIAN names a folder with a system
# of this release that debootstrap made earlier. The script copies that folder and does not change it.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath "${1:-build/release}")
mirror=${PSI_SLAM_DEBIAN_MIRROR:-http://deb.debian.org/debian}

say() { echo "check-package.sh: $*" >&2; }
skip() {
  say "skipped: $*"
  exit 77
}
fail() {
  say "$*"
  exit 1
}

[ "$(id -u)" -eq 0 ] || skip "this check needs root to install a Debian system in a folder"
# codename SYSTEM: prints the release of the Debian in the folder SYSTEM, such as bookworm.
# shellcheck disable=SC1091  # the file is part of the system
codename() { (. "$1/etc/os-release" 2>/dev/null && [ "${ID:-}" = debian ] && echo "${VERSION_CODENAME:-}"); }
release=$(codename "") || skip "this system is not a Debian, so its packages fit no Debian"
readonly release
command -v dpkg-shlibdeps >/dev/null || skip "this check needs dpkg-shlibdeps (package dpkg-dev)"
if [ -n "${PSI_SLAM_BARE_DEBIAN:-}" ]; then
  [ "$(codename "$PSI_SLAM_BARE_DEBIAN")" = "$release" ] ||
    fail "$PSI_SLAM_BARE_DEBIAN does not hold a Debian $release, for which this build is made. Make one with" \
      "debootstrap --variant=minbase $release FOLDER"
else
  command -v debootstrap >/dev/null || skip "this check needs debootstrap (package debootstrap)"
  # shellcheck disable=SC2016  # the inner shell expands $1
  timeout 20 bash -c 'exec 3<>"/dev/tcp/$1/80"' _ "$(cut -d/ -f3 <<<"$mirror")" 2>/dev/null ||
    skip "$mirror cannot be reached"
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/psi-slam-package-XXXXXX")
system=$work/debian
mounted=()
clean_up() {
  local folder
  for folder in "${mounted[@]}"; do umount "$folder" || return; done  # keep the folder rather than delete the real /proc
  rm -rf "$work"
}
trap clean_up EXIT

say "making the packages"
(cd "$build" && cpack -G DEB -B "$work/packages" >"$work/cpack.log" 2>&1) || fail "cpack failed: $(cat "$work/cpack.log")"
programs=$(find "$work/packages" -maxdepth 1 -name 'psi-slam_*.deb')
bench=$(find "$work/packages" -maxdepth 1 -name 'psi-slam-bench_*.deb')
library=$(find "$work/packages" -maxdepth 1 -name 'libpsi-slam-dev_*.deb')
python=$(find "$work/packages" -maxdepth 1 -name 'python3-psi-slam_*.deb')  # exists only if CMake found pybind11
[ -f "$programs" ] && [ -f "$bench" ] && [ -f "$library" ] ||
  fail "expected psi-slam, psi-slam-bench and libpsi-slam-dev, found $(ls "$work/packages")"
if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error "$work"/packages/*.deb >"$work/lintian.txt" ||
    fail "lintian finds errors: $(grep '^E:' "$work/lintian.txt")"
else
  say "the packages are not checked by lintian, because it is not installed"
fi
# Use files instead of pipes: grep --quiet may end before dpkg-deb has written everything.
dpkg-deb --field "$programs" Depends >"$work/depends.txt"
dpkg-deb --contents "$programs" >"$work/programs.txt"
dpkg-deb --contents "$bench" >"$work/bench.txt"
dpkg-deb --contents "$library" >"$work/library.txt"
# Names of libraries differ between releases.
for library_name in libc6 'libmrpt-maps[0-9.]+' 'libmrpt-hwdrivers[0-9.]+' 'libwxgtk3[.]2-1(t64)?' 'libgdal[0-9]+(t64)?'; do
  grep -Eq "(^|, )$library_name( |,|$)" "$work/depends.txt" || fail "psi-slam does not depend on $library_name"
done
mapfile -t program_names < <(sed -n 's|.* ./usr/bin/\(..*\)$|\1|p' "$work/programs.txt")
files=(./usr/bin/psi-slam ./usr/bin/psi-graphslam ./usr/share/man/man5/psi-slam.ini.5.gz ./usr/share/psi-slam/ini/psi-slam.ini
  './usr/lib/.*/psi-slam-sensors[.]so' ./usr/share/doc/psi-slam/copyright)
for program in "${program_names[@]}"; do
  files+=("./usr/share/man/man1/$program.1.gz" "./usr/share/bash-completion/completions/$program")
done
for file in "${files[@]}"; do
  grep -q " $file$" "$work/programs.txt" || fail "the package psi-slam lacks $file"
done
for file in ./usr/bin/psi-slam-bench ./usr/share/man/man1/psi-slam-bench.1.gz \
  ./usr/share/bash-completion/completions/psi-slam-bench ./usr/share/doc/psi-slam-bench/copyright; do
  grep -q " $file$" "$work/bench.txt" || fail "the package psi-slam-bench lacks $file"
done
grep -q "cmake/psi-slam/psi-slam-config.cmake$" "$work/library.txt" ||
  fail "the package libpsi-slam-dev lacks psi-slam-config.cmake"
if grep -q " ./usr/bin/" "$work/library.txt"; then fail "the package libpsi-slam-dev contains programs"; fi
if grep -q "psi-slam-bench\(.1.gz\)\?$" "$work/programs.txt"; then fail "the package psi-slam contains psi-slam-bench"; fi

if [ -n "${PSI_SLAM_BARE_DEBIAN:-}" ]; then
  cp --archive --reflink=auto "$PSI_SLAM_BARE_DEBIAN" "$system"
else
  say "installing a minimal Debian $release"
  debootstrap --variant=minbase "$release" "$system" "$mirror" >"$work/debootstrap.log" 2>&1 ||
    fail "debootstrap failed: $(tail -5 "$work/debootstrap.log")"
fi
cp /etc/resolv.conf "$system/etc/resolv.conf" 2>/dev/null || true
mount --bind /proc "$system/proc" 2>/dev/null && mounted+=("$system/proc")
inside() { chroot "$system" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

say "installing psi-slam in the minimal Debian $release"
cp "$programs" "$system/tmp/psi-slam.deb"
inside apt-get update --quiet --quiet || fail "apt-get update failed"
inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/psi-slam.deb >"$work/install.log" 2>&1 ||
  fail "the package psi-slam cannot be installed: $(tail -5 "$work/install.log")"

say "running the installed programs"
for program in "${program_names[@]}"; do
  inside "$program" --version || fail "$program does not run"
done
log=${PSI_SLAM_LOG:-"/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"}
if [ -f "$log" ]; then
  cp "$log" "$system/tmp/a.rawlog"
  inside psi-slam -c /usr/share/psi-slam/ini/psi-slam.ini /tmp/a.rawlog -o /tmp/out --set map.write_geotiff=true \
    --set map.write_gpkg=true --set map.epsg=25832 || fail "the installed psi-slam cannot map $log"
  for file in report.html map.png map.yaml map.svg map.dxf map.tif map.gpkg trajectory.tum; do
    [ -s "$system/tmp/out/$file" ] || fail "the installed psi-slam wrote no $file"
  done
else
  say "no log was mapped, because the package mrpt-common with the log is not installed here"
fi
if inside psi-slam bench match >"$work/no-bench.txt" 2>&1; then fail "psi-slam bench runs without the package psi-slam-bench"; fi
grep -q "Debian's package psi-slam-bench contains it" "$work/no-bench.txt" ||
  fail "psi-slam bench does not name its package: $(cat "$work/no-bench.txt")"
say "installing psi-slam-bench in the minimal Debian $release"
cp "$bench" "$system/tmp/psi-slam-bench.deb"
inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/psi-slam-bench.deb >"$work/install-bench.log" 2>&1 ||
  fail "the package psi-slam-bench cannot be installed: $(tail -5 "$work/install-bench.log")"
inside psi-slam bench --version || fail "psi-slam bench does not run"
if [ -n "$python" ]; then
  say "installing python3-psi-slam in the minimal Debian $release"
  cp "$python" "$system/tmp/python3-psi-slam.deb"
  inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/python3-psi-slam.deb >"$work/install-python.log" 2>&1 ||
    fail "the package python3-psi-slam cannot be installed: $(tail -5 "$work/install-python.log")"
  inside python3 -c 'import psi_slam; print("psi_slam", psi_slam.__version__)' || fail "Python cannot import psi_slam"
  inside python3 /usr/share/doc/python3-psi-slam/examples/02_feed_scans.py /tmp/fed ||
    fail "the installed example 02_feed_scans.py fails"
  [ -s "$system/tmp/fed/map.png" ] || fail "the installed Python module wrote no map.png"
  inside apt-get purge --quiet --quiet --yes python3-psi-slam >"$work/purge-python.log" 2>&1 ||
    fail "the package python3-psi-slam cannot be removed"
fi
inside apt-get purge --quiet --quiet --yes psi-slam >"$work/purge.log" 2>&1 || fail "the package psi-slam cannot be removed"
if [ -e "$system/usr/share/psi-slam" ]; then fail "removing the package psi-slam leaves /usr/share/psi-slam"; fi

say "building the examples with libpsi-slam-dev"
cp "$library" "$system/tmp/libpsi-slam-dev.deb"
inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/libpsi-slam-dev.deb cmake g++ make \
  >"$work/install-dev.log" 2>&1 || fail "the package libpsi-slam-dev cannot be installed: $(tail -5 "$work/install-dev.log")"
inside sh -c "cmake -S /usr/share/doc/libpsi-slam-dev/examples -B /tmp/examples && cmake --build /tmp/examples" \
  >"$work/examples.log" 2>&1 || fail "the examples do not build: $(tail -5 "$work/examples.log")"
inside test -x /tmp/examples/01_map_a_log || fail "the build of the examples made no 01_map_a_log"
say "all packages passed"
