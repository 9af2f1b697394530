#!/usr/bin/env bash
# How well the pose holds when things go wrong: the runs behind the table of docs/accuracy.md.
# usage: tools/accuracy_pose.sh DATA [OUT]    after `tools/accuracy.sh DATA OUT`, whose color tables are used
set -euo pipefail

if [ $# -lt 1 ]; then
  sed -n '2,3s/^# //p' "$0" >&2
  exit 2
fi
data=$(realpath "$1")
out=${2:-out/accuracy}
root=$(dirname "$(realpath "$0")")/..
tassilo=$root/build/release/bin/tassilo
if [ ! -e "$out/colors_div.yaml" ]; then
  echo "accuracy_pose: $out has no color tables; run tools/accuracy.sh first" >&2
  exit 1
fi

# one NAME: all recordings with what the functions below say, pooled.
odometry() { echo "--odometry $folder/odometry.jsonl"; }
every=1
way="localization: model"
robot() { cat "$folder/robot.yaml"; }
one() {
  local pairs=()
  mkdir -p "$out/$1"
  for folder in "$data"/msl98/d0*; do
    local name camera
    name=$(basename "$folder")
    camera=$(sed -n 's/^colors: .*colors_\(.*\)\.yaml$/\1/p' "$folder/robot.yaml")
    robot | sed "s|^camera: .*|camera: $folder/camera.yaml|" >"$out/$1/$name.yaml"
    echo "vision: {$way}" >>"$out/$1/$name.yaml"
    # shellcheck disable=SC2046
    "$tassilo" run --quiet --robot "$out/$1/$name.yaml" --colors "$out/colors_$camera.yaml" --source "$folder/video.mkv" \
      $(odometry) --every "$every" --output "$out/$1/$name.jsonl"
    awk -v every="$every" '(NR - 1) % every == 0' "$folder/gt.jsonl" >"$out/$1/$name.gt.jsonl"
    pairs+=("$out/$1/$name.gt.jsonl" "$out/$1/$name.jsonl")
  done
  printf '\n%s\n' "$1"
  "$tassilo" eval "${pairs[@]}" --json "$out/$1.json" | sed -n -e '/^pose/,/normalized/p' -e '/ total /p'
}
longer() {
  awk -F'[:,}]' '{printf "{\"t\":%s,\"x\":%.6f,\"y\":%.6f,\"theta\":%s}\n", $2, 1.2 * $4, 1.2 * $6, $8}' "$folder/odometry.jsonl" >"$out/longer.jsonl"
  echo "--odometry $out/longer.jsonl"
}
# each PREFIX: what goes wrong on real robots, one after the other.
each() {
  one "$1as_given"
  (odometry() { :; }; one "$1without_odometry")
  (odometry() { longer; }; one "$1odometry_20_percent_long")
  (every=2; one "$1every_other_frame")
  (robot() { grep -v '^start_pose' "$folder/robot.yaml"; }; one "$1without_start_pose")
}

each ""
(way="localization: boundary, field_boundary: skeleton"; each skeleton_)
(way="localization: boundary, field_boundary: subpixel"; each subpixel_)

if [ -d "$data/ssl_onboard" ]; then
  printf '\nssl_onboard: each image from 50 starts, 30 cm and 15 degrees off\n'
  "$root/tools/pose_draws.py" "$tassilo" "$data/ssl_onboard" "$out/colors_ssl.yaml" "$out/ssl_draws.jsonl"
  "$tassilo" eval --poses "$data/ssl_onboard/poses.csv" "$out/ssl_draws.jsonl"
fi
