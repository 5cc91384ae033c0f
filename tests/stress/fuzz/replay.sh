#!/usr/bin/env bash
# replay.sh PROGRAM TARGET FOLDER [OPTION…]: runs a fuzz target that was built without libFuzzer (replay.cpp) on its seeds
# and on mutations of them. If it crashes, leaves the input in FOLDER/finding.
set -euo pipefail
program=$1 target=$2 folder=$3
shift 3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

memory=/dev/shm  # a file is written for each input
[[ -d $memory && -w $memory ]] || memory=${TMPDIR:-/tmp}
TMPDIR=$(mktemp -d "$memory/corridor_fuzz.XXXXXX")
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT

"$here/seeds.sh" "$target" "$folder/seeds"
"$program" "$target" "$@" "$folder/seeds" || {
  status=$?
  mv "$TMPDIR/input" "$folder/finding"
  echo "the input is in $folder/finding" >&2
  exit "$status"
}
