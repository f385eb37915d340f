# SPDX-License-Identifier: BSD-3-Clause
# Common part of the scripts that run programs on the benchmark logs. A script sources this file with these arguments:
# the name of its results folder in out/, the names of its programs as one string, and its own arguments. This file sets
#
#     root, folder, outputs      the source tree, the folder of the logs, the folder for results
#     app                        the path of each program, by its name
#
# It prints the header of the script for --help. It ends the script with a message if the arguments are wrong.

say() {
  echo "$(basename "$0"): $*" >&2
}

wrong_usage() {
  say "$*"
  exit 2
}

# has_log LOG: succeeds if the folder has the log and its relations, otherwise prints a message.
has_log() {
  [ ! -r "$folder/$1.clf.gz" ] || [ ! -r "$folder/$1.relations" ] || return 0
  say "$folder: no $1.clf.gz with $1.relations, so this log is skipped"
  return 1
}

# expect_results NUMBER: ends the script with a message if NUMBER, the count of processed logs, is 0.
expect_results() {
  [ "$1" -gt 0 ] || wrong_usage "$folder: no benchmark logs. Download them with share/scripts/fetch-benchmark-logs.sh -o $folder"
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
outputs=$root/out/$1
read -r -a programs <<<"$2"
shift 2
case ${1:-} in
  -h | --help)
    sed -n '3,/^set /{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
esac
[ $# -eq 1 ] || [ $# -eq 2 ] || wrong_usage "usage: $0 FOLDER [OUTPUT]"
[ -d "$1" ] || wrong_usage "$1 is not a folder. Name the folder of the benchmark logs"
folder=$(cd "$1" && pwd)
outputs=${2:-$outputs}
declare -A app
for program in "${programs[@]}"; do
  path=${PSI_SLAM_BUILD:-$root/build/release}/apps/$program/$program
  [ -x "$path" ] || wrong_usage "$path is missing. Build it with share/scripts/build.sh ${programs[*]}"
  app[$program]=$path
done
