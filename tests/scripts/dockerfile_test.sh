#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks that check-debian.sh tests what the Dockerfile does: each command of the Dockerfile is a command of the script, for the
# same system and in the same order.
#
#     dockerfile_test.sh SOURCE
# shellcheck disable=SC2016  # words with $ are texts of the two files
set -euo pipefail
cd "$1"
script=share/scripts/check-debian.sh
dockerfile=share/docker/Dockerfile

fail() {
  echo "dockerfile_test.sh: $*" >&2
  exit 1
}

# Prints the commands of check-debian.sh, one a line: "system COMMAND" where it builds and "robot COMMAND" where it runs.
script_steps() {
  local line programs=() program
  while IFS= read -r line; do
    if [[ $line =~ ^for\ program\ in\ (.*)\;\ do$ ]]; then read -ra programs <<<"${BASH_REMATCH[1]}"; fi
    if [[ $line =~ ^cp\ .*\"\$system(/[^\"]*)\"\ \"\$robot(/[^\"]*)\"$ ]]; then
      echo "robot copy ${BASH_REMATCH[1]} ${BASH_REMATCH[2]}"
    fi
    [[ $line =~ ^\ *inside\ \"\$(system|robot)\"\ (.*) ]] || continue
    line="${BASH_REMATCH[1]} ${BASH_REMATCH[2]%% ||*}"
    line=${line%% >*}
    if [[ $line == *'"$program"'* ]]; then
      for program in "${programs[@]}"; do echo "${line//'"$program"'/$program}"; done
    else
      echo "$line"
    fi
  done <"$script"
}

# Prints the commands of the Dockerfile in the same form. The first stage builds, the second one runs.
docker_steps() {
  local line system=''
  while IFS= read -r line; do
    case "$line" in
      "FROM "*" AS build") system=system ;;
      "FROM "*) system=robot ;;
      "RUN "*)
        line=${line#RUN }
        echo "$system ${line% && rm -rf /var/lib/apt/lists/\*}"  # leaves the lists of packages out of the image
        ;;
      "COPY --from=build "*) echo "$system copy ${line#COPY --from=build }" ;;
      "" | "#"* | "ARG "* | "ENV "* | "WORKDIR "* | "ENTRYPOINT "* | "COPY "*) ;;
      *) fail "$dockerfile: this test does not know the line: $line" ;;
    esac
  done <"$dockerfile"
}

mapfile -t checked < <(script_steps)
steps=$(docker_steps)
next=0
while IFS= read -r step; do
  while [ "$next" -lt "${#checked[@]}" ] && [ "${checked[$next]}" != "$step" ]; do next=$((next + 1)); done
  [ "$next" -lt "${#checked[@]}" ] || fail "$dockerfile: check-debian.sh lacks this step, or has it earlier: $step"
done <<<"$steps"

for step in "system share/scripts/build.sh" "robot share/scripts/install-dependencies.sh runtime" "robot psi-slam --version"; do
  grep --quiet --line-regexp --fixed-strings -e "$step" <<<"$steps" || fail "$dockerfile lacks the step: $step"
done
release=$(sed -n 's/^ARG DEBIAN=//p' "$dockerfile")
grep --quiet "^  $release) release=" "$script" || fail "$dockerfile uses Debian $release, which check-debian.sh does not know"
[ "$(grep --count '^FROM debian:${DEBIAN}-slim' "$dockerfile")" -eq 2 ] ||
  fail "$dockerfile does not begin both stages with Debian"
while IFS= read -r line; do
  [ -e "${line%% *}" ] || fail "$dockerfile copies ${line%% *}, which does not exist"
done < <(sed -n 's/^COPY \([^-].*\)/\1/p' "$dockerfile")
