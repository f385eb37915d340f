#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks the words that the bash completion scripts offer. Needs no terminal.
#
#     completion_test.sh BUILD
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir maps
touch my.log my.ini "my other.log"

failures=0
for program in "$build"/apps/*/psi-*; do
  [ -f "$program" ] || continue
  # shellcheck disable=SC1090  # the build makes the file
  source "$build/completions/${program##*/}"
done

# answers LINE: prints the completions of LINE, sorted, each followed by a bar.
answers() {
  COMP_LINE=$1
  COMP_POINT=${#COMP_LINE}
  COMPREPLY=()
  read -ra COMP_WORDS <<<"$1"
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  local program=${1%% *}
  "_${program//-/_}"
  printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' '|'
}

# expect LINE ANSWERS: checks that answers LINE prints ANSWERS, which may be a pattern with *.
expect() {
  local found
  found=$(answers "$1")
  # shellcheck disable=SC2053  # $2 may be a pattern
  if [[ $found != $2 ]]; then
    echo "completion_test.sh: completing \"$1\" offers $found, expected $2" >&2
    failures=$((failures + 1))
  fi
}

COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'
expect "psi-slam --out" "--output|"
expect "psi-slam --o" "--output|"
expect "psi-slam ch" "check|"
expect "psi-slam my" "my other.log|my.ini|my.log|"
expect "psi-slam mer" "merge|"
expect "psi-slam merge --st" "--start|"
expect "psi-slam sweep --set map.write_d" "map.write_dxf=|"
expect "psi-slam --resume my.l" "my.log|"
expect "psi-slam check my.l" "my.log|"
expect "psi-slam check --j" "--json|"
expect "psi-slam options --m" "--markdown|"
expect "psi-slam check --ou" "|"
expect "psi-slam my.log -o m" "maps|"
expect "psi-slam -c my.i" "my.ini|"
expect "psi-slam -o check --th" "--threads|"
expect "psi-slam --seed " "|"
expect "psi-slam --set map.write_d" "map.write_dxf=|"
expect "psi-slam --set map.write_dxf=" "false|true|"
expect "psi-slam --set map.write_dxf=t" "true|"
expect "psi-slam --set=map.write_dxf=f" "false|"
expect "psi-slam --set loop_closure.matcher=c" "csm|csm_ga|"
expect "psi-slam --set log.max_range_m=" "auto|"
expect "psi-slam --set map.resolution_m=" "|"
expect "psi-slam check my.log --set run.th" "run.threads=|"
expect "psi-slam --config=my.i" "my.ini|"
expect "psi-slam-gui --ed" "--edits|"
expect "psi-slam-gui --set psi.psi_" "psi.psi_1=|psi.psi_2=|"
expect "psi-slam eval --per-relation ma" "maps|"
expect "psi-slam-bench f" "false-loops|freiburg|"
expect "psi-slam-bench freiburg --basel" "--baseline*"
expect "psi-slam-bench match --data ma" "maps|"
expect "psi-graphslam -r my.l" "my.log|"
expect "psi-graphslam --ini my.i" "my.ini|"
expect "psi-graphslam --output-dir m" "maps|"
expect "psi-graphslam --list-n" "--list-node-regs|"
expect "psi-slam map --th" "--threads|"
expect "psi-slam map my.l" "my.log|"
expect "psi-slam map ch" "|"
expect "psi-slam map my.log -o m" "maps|"
expect "psi-slam map --set map.write_d" "map.write_dxf=|"
expect "psi-slam map --set map.write_dxf=t" "true|"
expect "psi-slam help b" "bench|"
expect "psi-slam help m" "map|merge|"
expect "psi-slam help " "bench|check|diff|eval|graphslam|gui|help|live|localize|map|merge|options|play|sweep|"
expect "psi-slam help check my" "|"
expect "psi-slam ev" "eval|"
expect "psi-slam eval --per-relation ma" "maps|"
expect "psi-slam eval my.l" "my.log|"
expect "psi-slam bench f" "false-loops|freiburg|"
expect "psi-slam  bench  match --data ma" "maps|"
expect "psi-slam gui --set map.write_dxf=t" "true|"
expect "psi-slam graphslam --ini my.i" "my.ini|"
expect "psi-slam --man" "|"

# The script of psi-slam loads those of the programs that its commands start.
# shellcheck disable=SC2016  # the inner shell expands the variables
found=$(bash -c 'set -u; source "$1/psi-slam"; COMP_LINE="psi-slam bench f"; COMP_POINT=${#COMP_LINE}
  COMP_WORDS=(psi-slam bench f); COMP_CWORD=2; _psi_slam; echo "${COMPREPLY[*]}"' _ "$build/completions")
if [ "$found" != "false-loops freiburg" ] && [ "$found" != "freiburg false-loops" ]; then
  echo "completion_test.sh: psi-slam bench f offers \"$found\" before psi-slam-bench was completed" >&2
  failures=$((failures + 1))
fi

# Completion offers every key of the settings file.
count=$("$build/apps/psi-slam/psi-slam" --dump-config | grep -c '^[a-z_0-9]* = ')
offered=$(answers "psi-slam --set " | tr '|' '\n' | grep -c '=$')
if [ "$count" -ne "$offered" ]; then
  echo "completion_test.sh: --set offers $offered of $count options" >&2
  failures=$((failures + 1))
fi

COMP_WORDBREAKS=$' \t\n"'  # zsh does not split words at = and :, so it gets the whole word
expect "psi-slam --set map.write_dxf=t" "map.write_dxf=true|"
expect "psi-slam --config=my.i" "--config=my.ini|"
[ "$failures" -eq 0 ]
