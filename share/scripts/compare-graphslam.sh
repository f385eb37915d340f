#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs MRPT's graph-slam engine on the benchmark logs with MRPT's deciders, with psi-slam's, and with combinations of both.
# Prints a table with the error of each path over the relations of the benchmark, the number of loops, and the time.
#
#     share/scripts/compare-graphslam.sh FOLDER [OUTPUT]     # FOLDER: filled by fetch-benchmark-logs.sh
#
# Environment variables:
#
#   LOGS            names of the logs; default: all five
#   LIMIT_S         limit of a run in seconds of processor time; default: 900
#   LIMIT_TIMES     limit of a run in multiples of the time of team 1; default: 10
#   SET             more settings for psi-slam's node decider, for example
#                   "local_maps.smoothing_sigma_m=0.2"
#   TEAMS           numbers of the combinations to run, in the order of the table; default: "1 2 3 4 5 6 7".
#                   Team 1 has psi-slam's deciders only
#   PSI_SLAM_BUILD  the build folder with the programs of share/scripts/build.sh; default: build/release
#
# If FOLDER/LOG.clf.gz is missing, the script uses LOG.rawlog with the true poses in LOG.rawlog.GT.txt. MRPT ships its
# graphslam-engine-demos in this form. The error is then that of each pose relative to the first pose.
# Writes the results to OUTPUT/LOG/DECIDERS, by default out/graphslam/LOG/DECIDERS.
set -euo pipefail

# shellcheck source=share/scripts/benchmark-logs.bash
source "$(dirname "$0")/benchmark-logs.bash" graphslam "psi-graphslam psi-slam" "$@"
limit_s=${LIMIT_S:-900}
limit_times=${LIMIT_TIMES:-10}
read -r -a set <<<"${SET:-}"
read -r -a numbers <<<"${TEAMS:-1 2 3 4 5 6 7}"
read -r -a logs <<<"${LOGS:-aces intel mit-killian mit-csail fr079}"
# psi-slam's team comes first, because the table gives times as multiples of its time.
all_teams=(
  "CPsiFrontEndNRD CPsiLoopCloserERD CPsiSpaGSO"
  "CFixedIntervalsNRD CLoopCloserERD CLevMarqGSO"
  "CICPCriteriaNRD CLoopCloserERD CLevMarqGSO"
  "CFixedIntervalsNRD CICPCriteriaERD CLevMarqGSO"
  "CFixedIntervalsNRD CLoopCloserERD CPsiSpaGSO"
  "CPsiFrontEndNRD CEmptyERD CPsiSpaGSO"
  "CPsiFrontEndNRD CPsiLoopCloserERD CLevMarqGSO"
)
[ "${numbers[0]}" = 1 ] || wrong_usage "TEAMS=\"$TEAMS\" must begin with 1, because the other teams are compared with team 1"
teams=()
for number in "${numbers[@]}"; do teams+=("${all_teams[number - 1]}"); done

# log_file LOG: prints the path of the log.
log_file() {
  local file
  for file in "$folder/$1.clf.gz" "$folder/$1.rawlog"; do
    [ ! -r "$file" ] || { echo "$file" && return; }
  done
}

# relations LOG FILE: copies the relations of the log to FILE, or computes them from the true poses.
relations() {
  if [ -r "$folder/$1.clf.gz" ]; then
    cp "$folder/$1.relations" "$2"
    return
  fi
  python3 - "$folder/$1.rawlog.GT.txt" >"$2" <<'END'
import math
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    poses = [[float(word) for word in line.split()] for line in file]
start, x0, y0, yaw0 = poses[0]
for time, x, y, yaw in poses[1:]:
    ahead = math.cos(yaw0) * (x - x0) + math.sin(yaw0) * (y - y0)
    left = math.cos(yaw0) * (y - y0) - math.sin(yaw0) * (x - x0)
    print(f"{start:.6f} {time:.6f} {ahead:.9f} {left:.9f} 0 0 0 {yaw - yaw0:.9f}")
END
}

# settings LOG: prints ini/graphslam.ini with one thread, the [log] settings of the log and SET.
settings() {
  local facts=""
  [ ! -r "$root/ini/$1.ini" ] || facts=$(sed -n '/^\[log\]/,/^\[/{/^[a-z_]* *=/s/^/log./p}' "$root/ini/$1.ini")
  [ "${#set[@]}" -eq 0 ] || facts+=$'\n'$(printf '%s\n' "${set[@]}")
  sed -e "s/^run.threads.*/run.threads = 1/" -e '/^\[NodeRegistrationDeciderParameters\]/r /dev/stdin' \
    "$root/ini/graphslam.ini" <<<"$facts"
}

# seconds FOLDER: prints the processor time of the run in FOLDER, rounded up to seconds.
seconds() {
  awk 'END { print int($1 + $2 + 1) }' "$1/times"
}

# run LOG TEAM FOLDER LIMIT_S: runs the engine and evaluates the path. Writes the times to FOLDER/times and the reason of a
# failure to FOLDER/end.
run() {
  local node edge optimizer status=0
  read -r node edge optimizer <<<"$2"
  rm -rf "$3"
  mkdir -p "$3"
  settings "$1" >"$3/graphslam.ini"
  TIMEFORMAT='%U %S %R'
  # shellcheck disable=SC2016  # the inner shell expands $0 and $@
  {
    time bash -c 'ulimit -S -t "$0" && exec "$@"' "$4" "${app[psi-graphslam]}" -i "$3/graphslam.ini" \
      -r "$(log_file "$1")" -n "$node" -e "$edge" -o "$optimizer" --disable-visuals --output-dir "$3/results" \
      </dev/null >"$3/messages" 2>&1
  } 2>"$3/times" ||
    status=$?
  case $status in
    0)
      relations "$1" "$3/relations"
      "${app[psi-slam]}" eval --json "$3/results/trajectory.tum" "$3/relations" >"$3/evaluation.json"
      ;;
    152) echo "not finished" >"$3/end" ;;  # SIGXCPU
    1[3-9]*) echo "crashed (signal $((status - 128)))" >"$3/end" ;;
    *) tail -n 1 "$3/messages" >"$3/end" ;;
  esac
}

# rows LOG: prints one line of the table per team.
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
    times = f"{seconds(folder) / ours:.2f}"
    if os.path.exists(f"{folder}/end"):
        with open(f"{folder}/end", encoding="utf-8") as file:
            end = file.read().strip().replace("|", "/")
        print("| " + " | ".join(cells + [end, "–", "–", "–", times + " until then"]) + " |")
        continue
    with open(f"{folder}/results/summary.json", encoding="utf-8") as file:
        summary = json.load(file)
    with open(f"{folder}/evaluation.json", encoding="utf-8") as file:
        evaluation = json.load(file)
    loops = summary["edge_decider_counts"].get("LC", 0)
    print("| " + " | ".join(cells + [
        f"{evaluation['translation_abs_m']['mean']:.4f}", f"{evaluation['rotation_abs_deg']['mean']:.3f}",
        f"{summary['nodes']:,}", f"{loops:,}", times]) + " |")
END
}

table=()
for log in "${logs[@]}"; do
  [ -r "$folder/$log.rawlog.GT.txt" ] && [ -r "$folder/$log.rawlog" ] || has_log "$log" || continue
  limit=$limit_s
  for team in "${teams[@]}"; do
    say "$log with $team"
    results=$outputs/$log/${team// /-}
    run "$log" "$team" "$results" "$limit"
    [ "$team" != "${teams[0]}" ] || limit=$((limit_times * $(seconds "$results")))
    limit=$((limit < limit_s ? limit : limit_s))
  done
  table+=("$(rows "$log")")
done
expect_results "${#table[@]}"

echo "| log | node decider | edge decider | optimizer | translation [m] | rotation [deg] | nodes | loops | processor time, relative to psi-slam |"
echo "|---|---|---|---|---:|---:|---:|---:|---:|"
printf '%s\n' "${table[@]}"
