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

# shellcheck source=share/scripts/benchmark-logs.bash
source "$(dirname "$0")/benchmark-logs.bash" graphslam "psi-graphslam psi-slam-eval" "$@"
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
    time bash -c 'ulimit -S -t "$0" && exec "$@"' "$limit_s" "${app[psi-graphslam]}" -i "$3/graphslam.ini" \
      -r "$folder/$1.clf.gz" -n "$node" -e "$edge" -o "$optimizer" --disable-visuals --output-dir "$3/results" \
      </dev/null >"$3/messages" 2>&1
  } 2>"$3/times" ||
    status=$?
  case $status in
    0) "${app[psi-slam-eval]}" --json "$3/results/trajectory.tum" "$folder/$1.relations" >"$3/evaluation.json" ;;
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

table=()
for log in "${logs[@]}"; do
  has_log "$log" || continue
  for team in "${teams[@]}"; do
    say "$log with $team"
    run "$log" "$team" "$outputs/$log/${team// /-}"
  done
  table+=("$(rows "$log")")
done
expect_results "${#table[@]}"

echo "| log | node decider | edge decider | optimizer | translation [m] | rotation [deg] | nodes | loops | processor time, as a share of ours |"
echo "|---|---|---|---|---:|---:|---:|---:|---:|"
printf '%s\n' "${table[@]}"
