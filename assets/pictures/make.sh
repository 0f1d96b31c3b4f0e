#!/bin/sh
# Renders the README's pictures from the demo scenes: make.sh PROGRAM, from anywhere. Needs oiiotool for the JPEGs.
set -eu
program=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" --batch "$here/../scenes/whirlpool.toml" --frames 96 --resolution 1600x900 --no-cache \
    --output "$work/whirlpool.png"
oiiotool --nosoftwareattrib "$work/whirlpool.png" --eraseattrib ".*" --quality 88 -o "$here/whirlpool.jpg"

# Four frames of each flight on one picture.
for flight in inclined:0080:0120:0230 nebula:0100:0160:0240; do
    IFS=: read -r name second third last <<END
$flight
END
    "$program" --batch "$here/../scenes/$name.toml" --frames "1,$second,$third,$last" --resolution 800x500 \
        --no-cache --output "$work/$name.####.png"
    oiiotool --nosoftwareattrib "$work/$name.0001.png" "$work/$name.$second.png" "$work/$name.$third.png" \
        "$work/$name.$last.png" --mosaic 2x2 --eraseattrib ".*" --quality 90 -o "$here/$name.jpg"
done

# Three frames for a dome.
"$program" --batch "$here/../scenes/dome.toml" --frames 1,120,240 --resolution 500x500 --no-cache --output "$work/dome.####.png"
oiiotool --nosoftwareattrib "$work/dome.0001.png" "$work/dome.0120.png" "$work/dome.0240.png" --mosaic 3x1 \
    --eraseattrib ".*" --quality 90 -o "$here/dome.jpg"

# Four frames of the way into the galaxy.
"$program" --batch "$here/../scenes/powers-of-ten.toml" --frames 1,100,200,300 --resolution 640x360 --no-cache \
    --output "$work/ten.####.png"
oiiotool --nosoftwareattrib "$work/ten.0001.png" "$work/ten.0100.png" "$work/ten.0200.png" "$work/ten.0300.png" --mosaic 4x1 --resize 1920x270 \
    --eraseattrib ".*" --quality 88 -o "$here/powers-of-ten.jpg"
