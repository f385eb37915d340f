# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the scripts that run programs over the benchmark's logs, with the scripts' own arguments behind
# two: the folder of results beneath out/, and the names of the programs as one word list. Sets
#
#     root, folder, outputs      the source tree, the folder of the logs, the folder for results
#     app                        where each of the programs is, by its name
#
# and ends the script, with its header as help or with one sentence, where it was called wrongly.

say() {
  echo "$(basename "$0"): $*" >&2
}

wrong_usage() {
  say "$*"
  exit 2
}

# has_log LOG: whether the folder has the log and its relations; says so where it has not.
has_log() {
  [ ! -r "$folder/$1.clf.gz" ] || [ ! -r "$folder/$1.relations" ] || return 0
  say "$folder has no $1.clf.gz with $1.relations"
  return 1
}

# expect_results NUMBER: of logs that were run.
expect_results() {
  [ "$1" -gt 0 ] || wrong_usage "$folder has none of the benchmark's logs; fetch-benchmark-logs.sh fetches them"
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
[ -d "$1" ] || wrong_usage "$1 is no folder"
folder=$(cd "$1" && pwd)
outputs=${2:-$outputs}
declare -A app
for program in "${programs[@]}"; do
  path=${PSI_SLAM_BUILD:-$root/build/release}/apps/$program/$program
  [ -x "$path" ] || wrong_usage "$path is missing; share/scripts/build.sh ${programs[*]} makes it"
  app[$program]=$path
done
