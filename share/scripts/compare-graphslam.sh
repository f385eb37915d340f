#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs MRPT's graph-slam engine over the benchmark's logs with its own deciders, with ours and with some of each, and
# prints, as a table, what each comes to: the error of the path over the true relations, the loops, and the time.
#
#     share/scripts/compare-graphslam.sh FOLDER [OUTPUT]     # FOLDER is the one that fetch-benchmark-logs.sh has filled
#
# LOGS are the names of the logs, by default all five; LIMIT_S is how many seconds of processor time a run may take, by default 900.
# Needs the programs that share/scripts/build.sh builds; PSI_SLAM_BUILD is the folder where they were built if not
# build/release. The results are left in OUTPUT/LOG/DECIDERS, by default out/graphslam/LOG/DECIDERS.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
programs=${PSI_SLAM_BUILD:-$root/build/release}/apps
psi_graphslam=$programs/psi-graphslam/psi-graphslam
psi_slam_eval=$programs/psi-slam-eval/psi-slam-eval
limit_s=${LIMIT_S:-900}
read -r -a logs <<<"${LOGS:-aces intel mit-killian mit-csail fr079}"
# Ours first: times are told as shares of its.
teams=(
  "CPsiFrontEndNRD CPsiLoopCloserERD CPsiSpaGSO"
  "CFixedIntervalsNRD CLoopCloserERD CLevMarqGSO"
  "CICPCriteriaNRD CLoopCloserERD CLevMarqGSO"
  "CFixedIntervalsNRD CICPCriteriaERD CLevMarqGSO"
  "CFixedIntervalsNRD CLoopCloserERD CPsiSpaGSO"
  "CPsiFrontEndNRD CEmptyERD CPsiSpaGSO"
  "CPsiFrontEndNRD CPsiLoopCloserERD CLevMarqGSO"
)

say() {
  echo "compare-graphslam.sh: $*" >&2
}

wrong_usage() {
  say "$*"
  exit 2
}

# settings LOG: ours, with what its own settings say of the sensor, in one thread.
settings() {
  local facts
  facts=$(sed -n '/^\[log\]/,/^\[/{/^[a-z_]* *=/s/^/log./p}' "$root/ini/$1.ini")
  sed -e "s/^run.threads.*/run.threads = 1/" -e '/^\[NodeRegistrationDeciderParameters\]/r /dev/stdin' \
    "$root/ini/graphslam.ini" <<<"$facts"
}

# run LOG TEAM FOLDER: one run and its evaluation; how it ended is left in FOLDER/end, its seconds in FOLDER/times.
run() {
  local node edge optimizer status=0
  read -r node edge optimizer <<<"$2"
  rm -rf "$3"
  mkdir -p "$3"
  settings "$1" >"$3/graphslam.ini"
  TIMEFORMAT='%U %S %R'
  # shellcheck disable=SC2016  # the inner shell expands them
  {
    time bash -c 'ulimit -S -t "$0" && exec "$@"' "$limit_s" "$psi_graphslam" -i "$3/graphslam.ini" \
      -r "$folder/$1.clf.gz" -n "$node" -e "$edge" -o "$optimizer" --disable-visuals --output-dir "$3/results" \
      </dev/null >"$3/messages" 2>&1
  } 2>"$3/times" ||
    status=$?
  case $status in
    0) "$psi_slam_eval" --json "$3/results/trajectory.tum" "$folder/$1.relations" >"$3/evaluation.json" ;;
    152) echo "not finished in $limit_s s of processor time" >"$3/end" ;;  # SIGXCPU
    1[3-9]*) echo "crashed (signal $((status - 128)))" >"$3/end" ;;
    *) tail -n 1 "$3/messages" >"$3/end" ;;
  esac
}

# rows LOG: a line for each team.
rows() {
  python3 - "$outputs/$1" "$1" "${teams[@]}" <<'END'
import json
import os
import sys

outputs, log, *teams = sys.argv[1:]


def seconds(folder):
    with open(f"{folder}/times", encoding="utf-8") as file:
        user, system, _ = file.read().split()[-3:]
    return float(user) + float(system)


def folder_of(team):
    return f"{outputs}/{team.replace(' ', '-')}"


ours = seconds(folder_of(teams[0]))
for team in teams:
    folder = folder_of(team)
    cells = [log, *team.split()]
    if os.path.exists(f"{folder}/end"):
        with open(f"{folder}/end", encoding="utf-8") as file:
            end = file.read().strip().replace("|", "/")
        print("| " + " | ".join(cells + [end, "–", "–", "–", "–"]) + " |")
        continue
    with open(f"{folder}/results/summary.json", encoding="utf-8") as file:
        summary = json.load(file)
    with open(f"{folder}/evaluation.json", encoding="utf-8") as file:
        evaluation = json.load(file)
    loops = summary["edge_decider_counts"].get("LC", 0)
    print("| " + " | ".join(cells + [
        f"{evaluation['translation_abs_m']['mean']:.4f}", f"{evaluation['rotation_abs_deg']['mean']:.3f}",
        f"{summary['nodes']:,}", f"{loops:,}", f"{seconds(folder) / ours:.2f}"]) + " |")
END
}

case ${1:-} in
  -h | --help)
    sed -n '3,/^set /{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
esac
[ $# -eq 1 ] || [ $# -eq 2 ] || wrong_usage "usage: $0 FOLDER [OUTPUT]"
[ -d "$1" ] || wrong_usage "$1 is no folder"
folder=$(cd "$1" && pwd)
outputs=${2:-$root/out/graphslam}
for program in "$psi_graphslam" "$psi_slam_eval"; do
  [ -x "$program" ] || wrong_usage "$program is missing; share/scripts/build.sh psi-graphslam psi-slam-eval makes it"
done

table=()
for log in "${logs[@]}"; do
  if [ ! -r "$folder/$log.clf.gz" ] || [ ! -r "$folder/$log.relations" ]; then
    say "$folder has no $log.clf.gz with $log.relations"
    continue
  fi
  for team in "${teams[@]}"; do
    say "$log with $team"
    run "$log" "$team" "$outputs/$log/${team// /-}"
  done
  table+=("$(rows "$log")")
done
[ "${#table[@]}" -gt 0 ] || wrong_usage "$folder has none of the benchmark's logs; fetch-benchmark-logs.sh fetches them"

echo "| log | node decider | edge decider | optimizer | translation [m] | rotation [deg] | nodes | loops | processor time, as a share of ours |"
echo "|---|---|---|---|---:|---:|---:|---:|---:|"
printf '%s\n' "${table[@]}"
