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
