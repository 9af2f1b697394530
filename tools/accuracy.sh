#!/usr/bin/env bash
# The figures of docs/accuracy.md: all recordings of a data folder, colors trained from their samples only.
# usage: tools/accuracy.sh DATA [OUT] [samples|samples_mask]    DATA holds msl98/ (and ssl_onboard/); after `make release`
set -euo pipefail

if [ $# -lt 1 ]; then
  sed -n '2,3s/^# //p' "$0" >&2
  exit 2
fi
data=$(realpath "$1")
out=${2:-out/accuracy}
samples=${3:-samples}
tassilo=$(dirname "$(realpath "$0")")/../build/release/bin/tassilo
if [ ! -x "$tassilo" ]; then
  echo "accuracy: the program is not built; make release" >&2
  exit 1
fi
mkdir -p "$out"

for camera in div vga xga; do
  "$tassilo" train colors "$data/msl98/train_$camera/$samples.yaml" --output "$out/colors_$camera.yaml" --quiet
done
pairs=() colors=()
for folder in "$data"/msl98/d0*; do
  name=$(basename "$folder")
  camera=$(sed -n 's/^colors: .*colors_\(.*\)\.yaml$/\1/p' "$folder/robot.yaml")
  run=("$tassilo" run --quiet --robot "$folder/robot.yaml" --colors "$out/colors_$camera.yaml" --source "$folder/video.mkv"
    --odometry "$folder/odometry.jsonl")
  "${run[@]}" --label-maps "$out/$name"
  "${run[@]}" --output "$out/$name.jsonl"   # times are taken without writing label maps
  pairs+=("$folder/gt.jsonl" "$out/$name.jsonl")
  colors+=(--colors "$folder/labels" "$out/$name")
done
"$tassilo" eval "${pairs[@]}" "${colors[@]}" --json "$out/msl98.json"

if [ -d "$data/ssl_onboard" ] && [ "$samples" = samples ]; then
  real=$data/ssl_onboard
  "$tassilo" train colors "$real/samples.yaml" --output "$out/colors_ssl.yaml" --quiet
  "$tassilo" run --quiet --robot "$real/robot.yaml" --colors "$out/colors_ssl.yaml" --source "$real/images" --output "$out/ssl_onboard.jsonl"
  "$tassilo" eval --balls "$real/balls.json" "$out/ssl_onboard.jsonl" --exclude-samples "$real/samples.yaml"
fi
