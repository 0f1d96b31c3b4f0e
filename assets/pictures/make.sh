#!/bin/sh
# Renders the README's pictures from the demo scenes: make.sh PROGRAM, from anywhere. Needs oiiotool for the JPEGs.
set -eu
program=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for picture in whirlpool:96 nebula:1; do
    name=${picture%:*} frame=${picture#*:}
    "$program" --batch "$here/../scenes/$name.toml" --frames "$frame" --resolution 1600x900 --no-cache \
        --output "$work/$name.png"
    oiiotool --nosoftwareattrib "$work/$name.png" --eraseattrib ".*" --quality 88 -o "$here/$name.jpg"
done

# Four frames of the flight on one picture.
"$program" --batch "$here/../scenes/spiral.toml" --frames 1,100,140,240 --resolution 800x600 --no-cache \
    --output "$work/spiral.####.png"
oiiotool --nosoftwareattrib "$work/spiral.0001.png" "$work/spiral.0100.png" "$work/spiral.0140.png" \
    "$work/spiral.0240.png" --mosaic 2x2 --eraseattrib ".*" --quality 90 -o "$here/spiral.jpg"
