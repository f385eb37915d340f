#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Downloads the logs and relations of the Freiburg SLAM benchmark from their public home page (Kümmerle et al.,
# "On measuring the accuracy of SLAM algorithms", Autonomous Robots 27(4), 2009). Needs Internet access.
#
#     share/scripts/fetch-benchmark-logs.sh [-o FOLDER] [NAME...]
#
# Writes NAME.clf.gz and NAME.relations to FOLDER. The default of FOLDER is $PSI_SLAM_DATA, or out/benchmark-logs.
# Without a NAME, downloads all logs. Keeps files that exist. Called again, resumes an interrupted download.
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

# column NAME NUMBER: prints one column of the table above.
column() {
  awk -F ' *[|] *' -v name="$1" -v column="$2" '$1 == name { print $column }' <<<"$benchmark"
}

# count_scans FILE: prints the number of laser scans in a CARMEN log. Fails if the log has no scans, or if
# the garbled lines are more than 1 % of the scans.
count_scans() {
  LC_ALL=C awk '
    $1 == "FLASER" || $1 == "RLASER"    { if (NF == $2 + 11) ++scans; else ++garbled }
    $1 ~ /^(RAWLASER|ROBOTLASER)[0-9]$/ { if (NF >= $9 + 13) ++scans; else ++garbled }
    END { if (scans == 0 || garbled > scans / 100) exit 1; print scans }' "$1"
}

# count_relations FILE: prints the number of relations. Fails if the file contains anything but relations and comments.
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

# download URL FILE: resumes FILE at its end. Starts again from the beginning if the server cannot resume.
download() {
  if command -v curl >/dev/null; then
    local status=0
    local -a curl=(curl --fail --silent --show-error --location --connect-timeout 20 --retry 3 --output "$2" "$1")
    "${curl[@]}" --continue-at - || status=$?
    case $status in
      22 | 33 | 36) # the server refused the request or cannot resume
        if [ -s "$2" ]; then
          say "downloading $1 again from the beginning"
          status=0
          "${curl[@]}" || status=$?
        fi
        ;;
    esac
    return "$status"
  elif command -v wget >/dev/null; then
    wget --no-verbose --connect-timeout 20 --tries 3 --continue --output-document "$2" "$1"
  else
    say "neither curl nor wget is installed. Install one with sudo apt-get install curl"
    return 1
  fi
}

# fetch URL FILE KIND: downloads FILE and checks that it contains scans or relations, as KIND states. FILE appears only
# when it is complete.
fetch() {
  local url=$1 file=$2 kind=$3 count part
  part="$(dirname "$file")/.part-$(basename "$file")"
  if [ -e "$file" ]; then
    say "$file exists, so it is not downloaded"
    return 0
  fi
  say "downloading $url"
  if ! download "$url" "$part"; then
    say "$url: the download failed. Call this script again to resume it"
    return 1
  fi
  if ! count=$("count_$kind" "$part"); then
    rm -f "$part"
    say "$url: expected a file of $kind, but the server sent something else"
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
  [ -n "$(column "$name" 2)" ] || wrong_usage "unknown log \"$name\". The logs are $(names | paste -sd ' ')"
done

mkdir -p "$folder" || wrong_usage "cannot create the folder $folder. Name another one with -o"
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
  echo "The logs are in $folder. We thank those who recorded and published them:"
  for name in "${fetched[@]}"; do
    echo "  $name: $(column "$name" 4)"
  done
  echo "We thank Rainer Kümmerle and his co-authors for the relations. Cite their paper if you publish results."
fi
if [ "${#missing[@]}" -gt 0 ]; then
  say "not downloaded: ${missing[*]}. Check that this machine is online and that $home_page/datasets.php still lists the files"
  exit 1
fi
