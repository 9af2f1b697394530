#!/usr/bin/env bash
# The shipped recording from start to end: train colors from samples, run the vision, measure it against the truth.
# usage: tools/recording.sh [PROGRAM] [OUTPUT_FOLDER]      after `make release`; `make recording` does both
set -euo pipefail
cd "$(dirname "$0")/.."

program=${1:-build/release/bin/tassilo}
out=${2:-out/recording}
recording=data/msl98/d01_approach

if [ ! -x "$program" ]; then
  echo "recording: $program is not built; 'make recording' builds and runs it" >&2
  exit 1
fi
say() { printf '\n== %s\n' "$*"; }
mkdir -p "$out"

say "colors from the samples of the training stills -> $out/colors.yaml"
"$program" train colors data/msl98/train_div/samples.yaml --output "$out/colors.yaml"

say "what the robot sees on $recording/video.mkv"
"$program" run --robot "$recording/robot.yaml" --colors "$out/colors.yaml" --source "$recording/video.mkv" \
  --odometry "$recording/odometry.jsonl" --output "$out/scenes.jsonl" --overlay "$out/overlay.mkv"

say "compared with the truth of the recording"
"$program" eval "$recording/gt.jsonl" "$out/scenes.jsonl"

cat <<EOF

The annotated video:      $out/overlay.mkv    (ffplay $out/overlay.mkv, or any player)
One line of JSON a frame: $out/scenes.jsonl
Next: the five-minute tour in README.md, on your own camera or video.
EOF
