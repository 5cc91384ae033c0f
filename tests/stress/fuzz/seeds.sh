#!/usr/bin/env bash
# seeds.sh TARGET FOLDER: fills FOLDER with the inputs from which fuzzing TARGET starts: the files in seeds/TARGET, and
# small files of the project. For targets that read several formats, the first line is the file's extension.
set -euo pipefail
mkdir -p "$2"
target=$1 folder=$(cd "$2" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
project=$here/../../..
largest=20000  # bytes
shopt -s nullglob

rm -f "$folder"/*

# seeds FILE…: copies seeds, with the extension as first line if the target needs it.
seeds() {
  local file name
  for file in "$@"; do
    (($(stat -c %s "$file") <= largest)) || continue
    name=${file#"$here"/}
    case $target in
      read_mesh | read_cloud | read_solution) { echo "${file##*.}" && cat "$file"; } >"$folder/${name//\//_}" ;;
      *) cp "$file" "$folder/${name//\//_}" ;;
    esac
  done
}

seeds "$here/seeds/$target"/*
cd "$project"
case $target in
  read_mesh) seeds problems/*/*.{obj,stl,ply} robots/*/*.{obj,stl,ply} ;;
  read_problem) seeds problems/*/problem.yaml ;;
  read_robot) seeds robots/*/robot.yaml ;;
  read_campaign) seeds problems/campaigns/*.yaml ;;
  read_urdf) seeds robots/*/*.urdf ;;
  read_srdf) seeds robots/*/*.srdf ;;
esac
# Any bytes make a scene: 64 inputs of random bytes, always the same.
if [[ $target == compare_* ]]; then
  for i in {1..64}; do
    RANDOM=$i bytes=
    for ((k = 0; k < 64 + 8 * i; ++k)); do
      printf -v byte '\\x%02x' $((RANDOM & 255))
      bytes+=$byte
    done
    printf %b "$bytes" >"$folder/bytes_$i"
  done
fi
