#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the Debian packages of a build, installs them with apt-get on a bare Debian 12 in a folder of its own, maps a
# log and builds the examples there.
#
#   share/scripts/check-package.sh [BUILD]        default: build/release, all of it built
#
# It needs root, debootstrap and the network; where one of them is missing it says so and ends with exit code 77.
# PSI_SLAM_DEBIAN_MIRROR names another mirror than deb.debian.org, PSI_SLAM_BARE_DEBIAN a folder with a bare system
# that debootstrap made before: it is copied, not changed.
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

[ "$(id -u)" -eq 0 ] || skip "it needs root, to make a bare system in a folder"
command -v dpkg-shlibdeps >/dev/null || skip "it needs dpkg-shlibdeps (package dpkg-dev)"
if [ -z "${PSI_SLAM_BARE_DEBIAN:-}" ]; then
  command -v debootstrap >/dev/null || skip "it needs debootstrap"
  # shellcheck disable=SC2016  # $1 is the other shell's
  timeout 20 bash -c 'exec 3<>"/dev/tcp/$1/80"' _ "$(cut -d/ -f3 <<<"$mirror")" 2>/dev/null ||
    skip "$mirror cannot be reached"
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/psi-slam-package-XXXXXX")
system=$work/debian
mounted=()
clean_up() {
  local folder
  for folder in "${mounted[@]}"; do umount "$folder" || return; done  # rather a folder too many than /proc deleted
  rm -rf "$work"
}
trap clean_up EXIT

say "packing"
(cd "$build" && cpack -G DEB -B "$work/packages" >"$work/cpack.log" 2>&1) || fail "cpack failed: $(cat "$work/cpack.log")"
programs=$(find "$work/packages" -maxdepth 1 -name 'psi-slam_*.deb')
library=$(find "$work/packages" -maxdepth 1 -name 'libpsi-slam-dev_*.deb')
cluster=$(find "$work/packages" -maxdepth 1 -name 'psi-slam-mpi_*.deb')  # where MPI was found
[ -f "$programs" ] && [ -f "$library" ] || fail "expected psi-slam and libpsi-slam-dev, found $(ls "$work/packages")"
# Seen through files: grep --quiet may end before dpkg-deb has written all.
dpkg-deb --field "$programs" Depends >"$work/depends.txt"
dpkg-deb --contents "$programs" >"$work/programs.txt"
dpkg-deb --contents "$library" >"$work/library.txt"
for library_name in libc6 libmrpt-maps2.5 libwxgtk3.2-1 libgdal32; do
  grep -q "\b$library_name\b" "$work/depends.txt" || fail "psi-slam does not depend on $library_name"
done
if grep -q openmpi "$work/depends.txt"; then fail "psi-slam depends on Open MPI"; fi
mapfile -t program_names < <(sed -n 's|.* ./usr/bin/\(..*\)$|\1|p' "$work/programs.txt")
files=(./usr/bin/psi-slam ./usr/bin/psi-graphslam ./usr/share/man/man5/psi-slam.ini.5.gz ./usr/share/psi-slam/ini/psi-slam.ini
  ./usr/share/doc/psi-slam/copyright)
for program in "${program_names[@]}"; do
  files+=("./usr/share/man/man1/$program.1.gz" "./usr/share/bash-completion/completions/$program")
done
for file in "${files[@]}"; do
  grep -q " $file$" "$work/programs.txt" || fail "psi-slam does not hold $file"
done
grep -q "cmake/psi-slam/psi-slam-config.cmake$" "$work/library.txt" || fail "libpsi-slam-dev has no CMake package"
if grep -q " ./usr/bin/" "$work/library.txt"; then fail "libpsi-slam-dev holds programs"; fi

if [ -n "${PSI_SLAM_BARE_DEBIAN:-}" ]; then
  cp --archive --reflink=auto "$PSI_SLAM_BARE_DEBIAN" "$system"
else
  say "making a bare Debian 12"
  debootstrap --variant=minbase bookworm "$system" "$mirror" >"$work/debootstrap.log" 2>&1 ||
    fail "debootstrap failed: $(tail -5 "$work/debootstrap.log")"
fi
cp /etc/resolv.conf "$system/etc/resolv.conf" 2>/dev/null || true
mount --bind /proc "$system/proc" 2>/dev/null && mounted+=("$system/proc")
inside() { chroot "$system" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

say "installing psi-slam there"
cp "$programs" "$system/tmp/psi-slam.deb"
inside apt-get update --quiet --quiet || fail "apt-get update failed"
inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/psi-slam.deb >"$work/install.log" 2>&1 ||
  fail "the package does not install: $(tail -5 "$work/install.log")"

say "running it there"
for program in "${program_names[@]}"; do
  inside "$program" --version || fail "$program does not run"
done
log=${PSI_SLAM_LOG:-"/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"}
if [ -f "$log" ]; then
  cp "$log" "$system/tmp/a.rawlog"
  inside psi-slam -c /usr/share/psi-slam/ini/psi-slam.ini /tmp/a.rawlog -o /tmp/out --set map.write_geotiff=true \
    --set map.epsg=25832 || fail "psi-slam does not map $log there"
  for file in report.html map.png map.yaml map.svg map.dxf map.tif trajectory.tum; do
    [ -s "$system/tmp/out/$file" ] || fail "psi-slam wrote no $file"
  done
else
  say "no log to map: that of the package mrpt-common is not installed here"
fi
if [ -n "$cluster" ]; then
  say "installing psi-slam-mpi there"
  cp "$cluster" "$system/tmp/psi-slam-mpi.deb"
  inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/psi-slam-mpi.deb >"$work/install-mpi.log" 2>&1 ||
    fail "psi-slam-mpi does not install: $(tail -5 "$work/install-mpi.log")"
  for program in psi-slam-sweep-mpi psi-slam-bench-mpi; do
    inside "$program" --version || fail "$program does not run"
  done
  inside apt-get purge --quiet --quiet --yes psi-slam-mpi >"$work/purge-mpi.log" 2>&1 || fail "psi-slam-mpi cannot be removed"
fi
inside apt-get purge --quiet --quiet --yes psi-slam >"$work/purge.log" 2>&1 || fail "the package cannot be removed"
if [ -e "$system/usr/share/psi-slam" ]; then fail "the package leaves /usr/share/psi-slam behind"; fi

say "building the examples with libpsi-slam-dev there"
cp "$library" "$system/tmp/libpsi-slam-dev.deb"
inside apt-get install --quiet --quiet --yes --no-install-recommends /tmp/libpsi-slam-dev.deb cmake g++ make \
  >"$work/install-dev.log" 2>&1 || fail "libpsi-slam-dev does not install: $(tail -5 "$work/install-dev.log")"
inside sh -c "cmake -S /usr/share/doc/libpsi-slam-dev/examples -B /tmp/examples && cmake --build /tmp/examples" \
  >"$work/examples.log" 2>&1 || fail "the examples do not build: $(tail -5 "$work/examples.log")"
inside test -x /tmp/examples/01_map_a_log || fail "the examples were not built"
say "the packages are in order"
