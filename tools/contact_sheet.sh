#!/usr/bin/env bash
# Many frames at one look: pictures of an annotated video, or of a folder of PNGs, side by side in one image.
# usage: tools/contact_sheet.sh VIDEO|FOLDER SHEET.png [COLUMNSxROWS] [WIDTH_OF_ONE]
set -euo pipefail

if [ $# -lt 2 ]; then
  sed -n '2,3s/^# //p' "$0" >&2
  exit 2
fi
source=$1
sheet=$2
grid=${3:-4x4}
width=${4:-480}
if [[ ! $grid =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]]; then
  echo "contact_sheet: grid is $grid, must be like 4x4" >&2
  exit 2
fi
if [ ! -e "$source" ]; then
  echo "contact_sheet: $source: does not exist" >&2
  exit 1
fi
input=(-i "$source")
if [ -d "$source" ]; then input=(-framerate 25 -pattern_type glob -i "$source/*.png"); fi

frames=$(ffprobe -v error -count_packets -select_streams v:0 -show_entries stream=nb_read_packets -of csv=p=0 \
  "${input[@]}" | tr -d ',')
cells=$((${grid%x*} * ${grid#*x}))
step=$(((frames + cells - 1) / cells))
if [ "$step" -lt 1 ]; then step=1; fi
ffmpeg -v error -y "${input[@]}" -vf "select='not(mod(n,$step))',scale=$width:-2,tile=$grid" -frames:v 1 "$sheet"
echo "$sheet: every ${step}. of $frames frames"
