#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks psi-slam on a bare Debian: installs the release with debootstrap in a folder, runs quickstart.sh, build.sh and test.sh
# there, and then runs the installed programs on a second bare Debian that has only the packages of the list `runtime`.
# Makes the Debian packages, and checks them with check-package.sh and lintian. Prints a checksum of path, map and pose graph of
# the quickstart, which must be the same on all releases. share/docker/Dockerfile has the same steps, without quickstart and checks.
#
#     share/scripts/check-debian.sh 12|13 [FOLDER]
#
# FOLDER must not exist or be empty. The script keeps it, with the built sources in FOLDER/build/psi-slam. Without FOLDER, the
# script uses a new folder in ${TMPDIR:-/tmp} and deletes it at the end. It needs 12 GB of disk and about an hour on two cores.
#
# Needs root, debootstrap and the network. Copies the files that git tracks, with their uncommitted changes.
# PSI_SLAM_DEBIAN_MIRROR names a mirror other than deb.debian.org. PSI_SLAM_DATA and PSI_SLAM_METRIC_TOOL enable tests as in
# CONTRIBUTING.md.
set -euo pipefail

say() { echo "check-debian.sh: $*" >&2; }
fail() {
  say "$*"
  exit 1
}
usage() {
  say "$*. Usage: share/scripts/check-debian.sh 12|13 [FOLDER]"
  exit 2
}

if [ $# -lt 1 ] || [ $# -gt 2 ]; then usage "expected one or two arguments, found $#"; fi
case "$1" in
  12) release=bookworm ;;
  13) release=trixie ;;
  *) usage "$1 is not a release of Debian that can be checked" ;;
esac
readonly version=$1
if [ -n "${2:-}" ] && [ -e "$2" ]; then
  [ -d "$2" ] || usage "$2 is not a folder"
  [ -z "$(ls -A "$2")" ] || usage "the folder $2 is not empty"
fi
[ "$(id -u)" -eq 0 ] || fail "only root can install a Debian in a folder. Run sudo share/scripts/check-debian.sh $*"
command -v debootstrap >/dev/null || fail "debootstrap is missing. Install it with apt-get install debootstrap"
mirror=${PSI_SLAM_DEBIAN_MIRROR:-http://deb.debian.org/debian}
data=${PSI_SLAM_DATA:+$(realpath "$PSI_SLAM_DATA")}
metric_tool=${PSI_SLAM_METRIC_TOOL:+$(realpath "$PSI_SLAM_METRIC_TOOL")}

if [ -n "${2:-}" ]; then
  mkdir -p "$2"
  work=$(realpath "$2")
else
  work=$(realpath "$(mktemp -d "${TMPDIR:-/tmp}/psi-slam-debian-XXXXXX")")
fi
cd "$(dirname "$0")/../.."
readonly system=$work/build      # builds and tests
readonly robot=$work/run         # runs only
readonly bare=$work/bare         # stays bare, for the check of the packages
readonly source=/psi-slam        # in both systems
child=

# Sends a signal to all processes in the two systems. Succeeds if there were any.
signal_processes() {
  local process root found=1
  for process in /proc/[0-9]*; do
    root=$(readlink "$process/root" 2>/dev/null) || continue
    case $root in  # check-package.sh runs programs in a further system within
      "$system" | "$system"/* | "$robot")
        kill "-$1" "${process##*/}" 2>/dev/null || true
        found=0
        ;;
    esac
  done
  return "$found"
}

# Prints the folders in `work` on which something is mounted, the newest first.
mounts() {
  local folder
  while read -r _ folder _; do
    folder=$(printf '%b' "$folder")
    if [[ "$folder" == "$work"/* ]]; then echo "$folder"; fi
  done </proc/mounts | tac
}

clean_up() {
  local folder signal
  trap '' INT TERM HUP
  if [ -n "$child" ]; then kill "$child" 2>/dev/null || true; fi
  for signal in TERM TERM TERM KILL KILL; do
    signal_processes "$signal" || break
    sleep 1
  done
  while read -r folder; do umount "$folder" || umount --lazy "$folder" || true; done < <(mounts)
  if [ "$keep" = true ]; then return; fi
  if [ -n "$(mounts)" ]; then
    say "something is still mounted in $work. Unmount it, then delete the folder"
  else
    rm -rf --one-file-system "$work"
  fi
}
keep=false
if [ -n "${2:-}" ]; then keep=true; fi
trap clean_up EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

# run COMMAND...: runs a command such that a signal ends the script at once, while the command still runs.
run() {
  local status=0
  "$@" </dev/null &
  child=$!
  wait "$child" || status=$?
  child=
  return "$status"
}

# inside SYSTEM COMMAND...
inside() {
  local root=$1
  shift
  run chroot "$root" env -i -C "$source" PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 CI=true \
    ${data:+PSI_SLAM_DATA=/psi-slam-data} ${metric_tool:+PSI_SLAM_METRIC_TOOL=/usr/local/lib/metric-tool} "$@"
}

# mount_in FOLDER ARGUMENT...: mounts something on FOLDER. clean_up() unmounts it.
mount_in() {
  mkdir -p "$1"
  mount "${@:2}" "$1"
}

# Copies the tracked files, and mounts what programs expect.
prepare() {
  local root=$1
  mkdir -p "$root$source"
  git ls-files -z | tar --create --null --files-from - | tar --extract --no-same-owner --directory "$root$source"
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  mount_in "$root/proc" -t proc proc
  mount_in "$root/dev/shm" -t tmpfs tmpfs
  mount_in "$root/dev/pts" -t devpts -o newinstance,ptmxmode=0666 devpts  # tests of sensors need pseudo-terminals
  ln -sf pts/ptmx "$root/dev/ptmx"
}

say "installing a bare Debian $version in $work"
run debootstrap --variant=minbase "$release" "$system" "$mirror" >"$work/debootstrap.log" 2>&1 ||
  fail "debootstrap failed: $(tail -n 5 "$work/debootstrap.log")"
echo force-unsafe-io >"$system/etc/dpkg/dpkg.cfg.d/unsafe-io"  # makes installation much faster
cp --archive "$system" "$robot"
cp --archive "$system" "$bare"
prepare "$system"
prepare "$robot"
if [ -n "$data" ]; then
  mount_in "$system/psi-slam-data" --bind "$data"
  mount -o remount,bind,ro "$system/psi-slam-data"
fi
if [ -n "$metric_tool" ]; then cp "$metric_tool" "$system/usr/local/lib/metric-tool"; fi

say "Debian $version: running quickstart.sh"
inside "$system" share/scripts/quickstart.sh || fail "quickstart.sh failed. Read its message above"
for unwanted in xvfb openbox python3-rosbag python3-gtsam pybind11-dev libgtest-dev; do
  inside "$system" dpkg-query --show "$unwanted" >/dev/null 2>&1 && fail "quickstart.sh installed $unwanted"
done

say "Debian $version: running build.sh"
inside "$system" share/scripts/build.sh || fail "build.sh failed. Read its message above"

say "Debian $version: running test.sh"
status=0
inside "$system" share/scripts/test.sh || status=$?

say "Debian $version: running the installed programs with the packages of the list runtime"
inside "$system" env DESTDIR=/tmp/installed cmake --install build/release >/dev/null || fail "cmake --install failed"
inside "$robot" share/scripts/install-dependencies.sh runtime || fail "the packages of the list runtime cannot be installed"
cp --archive --no-target-directory "$system/tmp/installed/usr" "$robot/usr"
for program in psi-slam psi-slam-bench psi-graphslam psi-slam-gui; do
  inside "$robot" "$program" --version || fail "$program does not run with the packages of the list runtime"
done
log="/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"
inside "$robot" psi-slam --quiet "$log" -o /tmp/map || fail "psi-slam does not map with the packages of the list runtime"
built=$system$source/out/quickstart
for file in trajectory.csv map.pgm graph.g2o; do
  cmp "$robot/tmp/map/$file" "$built/$file" || fail "the installed psi-slam writes another $file than quickstart.sh"
done

say "Debian $version: checking the packages"
mount_in "$system/bare" --bind "$bare"
inside "$system" apt-get install --quiet --quiet --yes --no-install-recommends lintian >/dev/null ||
  fail "lintian cannot be installed"
inside "$system" env PSI_SLAM_BARE_DEBIAN=/bare share/scripts/check-package.sh ||
  fail "the packages are faulty. Read the message above"

say "Debian $version: checksum of the quickstart's results: $(cd "$built" && cat trajectory.csv map.pgm graph.g2o | sha256sum | cut -d" " -f1)"
if [ "$status" -ne 0 ]; then fail "Debian $version: tests failed. Their names are above"; fi
say "Debian $version: quickstart, tests, installed programs and packages passed"
