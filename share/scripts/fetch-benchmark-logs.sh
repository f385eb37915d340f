#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Fetches the logs and true relations of the Freiburg SLAM benchmark (Kümmerle et al., "On measuring the accuracy
# of SLAM algorithms", Autonomous Robots 27(4), 2009) from their public home. This needs the Internet: on a machine
# without network there is nothing to try.
#
#     share/scripts/fetch-benchmark-logs.sh [-o FOLDER] [NAME...]
#
# FOLDER is $PSI_SLAM_DATA, else out/benchmark-logs, and gets NAME.clf.gz and NAME.relations; without a NAME all are
# fetched. Files that are there are kept; an interrupted download goes on where it stopped when it is called again.
set -euo pipefail

home_page=${PSI_SLAM_BENCHMARK_URL:-http://ais.informatik.uni-freiburg.de/slamevaluation}

# name | log | relations | recorded by
benchmark="
aces        | datasets/aces.clf                 | datasets/aces.relations        | Patrick Beeson
intel       | datasets/intel.clf                | datasets/intel.relations       | Dirk Hähnel
mit-killian | datasets/mit-killian.clf          | datasets/mit-killian.relations | Mike Bosse and John Leonard
mit-csail   | datasets/mit-csail.clf            | datasets/mit-csail.relations   | Cyrill Stachniss
fr079       | datasets/fr079.clf                | datasets/fr079.relations       | Cyrill Stachniss
fr-hospital | datasets/fr-clinic_robotlaser.clf | datasets/fr-clinic.relations   | Bastian Steder, Rainer Kümmerle, Christian Dornhege, Michael Ruhnke, Cyrill Stachniss, Giorgio Grisetti and Alexander Kleiner
"

say() {
  echo "fetch-benchmark-logs.sh: $*" >&2
}

wrong_usage() {
  say "$*"
  exit 2
}

names() {
  awk -F ' *[|] *' 'NF == 4 { print $1 }' <<<"$benchmark"
}

# column NAME NUMBER
column() {
  awk -F ' *[|] *' -v name="$1" -v column="$2" '$1 == name { print $column }' <<<"$benchmark"
}

# The number of laser scans in a CARMEN log; fails for anything else. A few lines may be garbled: logs are like that.
count_scans() {
  LC_ALL=C awk '
    $1 == "FLASER" || $1 == "RLASER"    { if (NF == $2 + 11) ++scans; else ++garbled }
    $1 ~ /^(RAWLASER|ROBOTLASER)[0-9]$/ { if (NF >= $9 + 13) ++scans; else ++garbled }
    END { if (scans == 0 || garbled > scans / 100) exit 1; print scans }' "$1"
}

# The number of relations in a file of nothing else; fails for anything else.
count_relations() {
  LC_ALL=C awk '
    { sub(/\r$/, "") }
    NF == 0 || $1 ~ /^#/ { next }
    {
      if (NF != 8) exit 1
      for (i = 1; i <= NF; ++i) if ($i !~ /^[-+]?[0-9]*[.]?[0-9]+([eE][-+]?[0-9]+)?$/) exit 1
      ++relations
    }
    END { if (relations == 0) exit 1; print relations }' "$1"
}

# download URL FILE: continues FILE where it ends. A server that cannot do so sends it all again.
download() {
  if command -v curl >/dev/null; then
    local status=0
    local -a curl=(curl --fail --silent --show-error --location --connect-timeout 20 --retry 3 --output "$2" "$1")
    "${curl[@]}" --continue-at - || status=$?
    case $status in
      22 | 33 | 36) # the server refused what was asked, or cannot resume
        if [ -s "$2" ]; then
          say "starting $1 again from its beginning"
          status=0
          "${curl[@]}" || status=$?
        fi
        ;;
    esac
    return "$status"
  elif command -v wget >/dev/null; then
    wget --no-verbose --connect-timeout 20 --tries 3 --continue --output-document "$2" "$1"
  else
    say "curl or wget is needed: sudo apt-get install curl"
    return 1
  fi
}

# fetch URL FILE KIND: FILE appears when it is complete and is what KIND (scans or relations) says; else fails.
fetch() {
  local url=$1 file=$2 kind=$3 count part
  part="$(dirname "$file")/.part-$(basename "$file")"
  if [ -e "$file" ]; then
    say "$file is there already"
    return 0
  fi
  say "fetching $url"
  if ! download "$url" "$part"; then
    say "cannot fetch $url; call again to continue"
    return 1
  fi
  if ! count=$("count_$kind" "$part"); then
    rm -f "$part"
    say "what $url sends is no file of $kind"
    return 1
  fi
  if [ "$file" != "${file%.gz}" ]; then
    gzip --best --stdout "$part" >"$part.gz" && mv "$part.gz" "$file" && rm -f "$part" || return 1
  else
    mv "$part" "$file" || return 1
  fi
  say "$file: $count $kind"
}

folder=${PSI_SLAM_DATA:-$(dirname "$0")/../../out/benchmark-logs}
if [ "${1:-}" = --help ]; then set -- -h; fi
while getopts ho: option; do
  case $option in
    h)
      sed -n '3,/^set /{/^#/s/^# \{0,1\}//p}' "$0"
      exit 0
      ;;
    o) folder=$OPTARG ;;
    *) wrong_usage "usage: $0 [-o FOLDER] [NAME...]" ;;
  esac
done
shift $((OPTIND - 1))
wanted=("$@")
if [ $# -eq 0 ]; then mapfile -t wanted < <(names); fi
for name in "${wanted[@]}"; do
  [ -n "$(column "$name" 2)" ] || wrong_usage "there is no log \"$name\"; the logs are $(names | paste -sd ' ')"
done

mkdir -p "$folder" || wrong_usage "cannot make the folder $folder"
folder=$(cd "$folder" && pwd)
fetched=()
missing=()
for name in "${wanted[@]}"; do
  if fetch "$home_page/$(column "$name" 2)" "$folder/$name.clf.gz" scans &&
    fetch "$home_page/$(column "$name" 3)" "$folder/$name.relations" relations; then
    fetched+=("$name")
  else
    missing+=("$name")
  fi
done

if [ "${#fetched[@]}" -gt 0 ]; then
  echo "The logs are in $folder. Thanks to those who recorded them and gave them away:"
  for name in "${fetched[@]}"; do
    echo "  $name: $(column "$name" 4)"
  done
  echo "and to Rainer Kümmerle and his co-authors for the relations: cite their paper when you publish results."
fi
if [ "${#missing[@]}" -gt 0 ]; then
  say "not fetched: ${missing[*]}; is this machine online, and are the files still listed at $home_page/datasets.php?"
  exit 1
fi
