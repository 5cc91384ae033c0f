#!/usr/bin/env bash
# run.sh BUILD SECONDS TARGET…: runs built fuzz targets for SECONDS each, one after the other. Writes findings to
# BUILD/findings, and inputs that cover more than the seeds to BUILD/corpus. Exit status 1 if anything was found.
set -euo pipefail
build=$(cd "$1" && pwd) seconds=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
project=$(cd "$here/../../.." && pwd)

# words TARGET: prints the words of a format for libFuzzer's dictionary: all quoted words in the code that reads it.
words() {
  cd "$project"
  case $1 in
    read_mesh) set -- collision/geometry/{*_reader,gltf_json,ply_header}.cpp ;;
    read_cloud) set -- collision/geometry/{pcd_reader,ply_header,occupancy_map}.cpp ;;
    read_urdf | read_srdf) set -- planner/robot/{urdf_*,srdf_file,joint_types}.cpp ;;
    read_campaign) set -- planner/{benchmark/campaign_yaml,problem/keys,problem/checker_yaml}.cpp ;;
    read_trajectory) set -- planner/trajectory/*_table.cpp ;;
    read_solution) set -- planner/solve/solution.cpp ;;
    read_*) set -- planner/problem/*.cpp planner/import/*.cpp ;;
    *) return ;;
  esac
  grep -oh '"[A-Za-z_][A-Za-z_0-9-]*"' "$@" | sort -u
}

folder=/dev/shm  # a file is written for each input
[[ -d $folder && -w $folder ]] || folder=${TMPDIR:-/tmp}
TMPDIR=$(mktemp -d "$folder/corridor_fuzz.XXXXXX")
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT

mkdir -p "$build/findings"
status=0
printf '%-18s %12s %8s %8s %8s  %s\n' target executions seconds cov ft found
for target in "$@"; do
  corpus=$build/corpus/$target log=$build/findings/$target.log
  mkdir -p "$corpus"
  "$here/seeds.sh" "$target" "$build/seeds/$target"
  dictionary=()  # libFuzzer refuses an empty one
  words "$target" >"$build/seeds/$target.dict"
  [[ ! -s $build/seeds/$target.dict ]] || dictionary=(-dict="$build/seeds/$target.dict")
  longest=10
  found=none
  if ! "$build/tests/stress/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=$longest -rss_limit_mb=2048 \
    -malloc_limit_mb=1024 -print_final_stats=1 "${dictionary[@]}" \
    -artifact_prefix="$build/findings/$target-" "$corpus" "$build/seeds/$target" >"$log" 2>&1; then
    status=1
    found=$(sed -n 's/.*Test unit written to //p' "$log" | tail -1)
    found="$(grep -m1 -E '^FINDING|ERROR: |runtime error' "$log" || tail -1 "$log") [${found:-$log}]"
  fi
  number() { sed -n "$1" "$log" | tail -1; }
  printf '%-18s %12s %8s %8s %8s  %s\n' "$target" "$(number 's/^stat::number_of_executed_units: *//p')" \
    "$(number 's/^Done .* runs in \([0-9]*\) second.*/\1/p')" "$(number 's/^#.* cov: \([0-9]*\) .*/\1/p')" \
    "$(number 's/^#.* ft: \([0-9]*\) .*/\1/p')" "$found"
done
exit $status
