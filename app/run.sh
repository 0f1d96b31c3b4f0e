#!/usr/bin/env bash
# From a fresh clone to pictures: installs what is missing, builds the Release program, makes bodies of the demo's one
# picture and renders a still and a short flight into renders/. Run again, it renders only what has changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scene=assets/scenes/inclined.toml

bash third_party/install.sh build window
cmake --preset release -DASTROSPLAT_TESTS=OFF >/dev/null
cmake --build --preset release --target astrosplat

program=build/release/astrosplat
"$program" --batch "$scene" --frames 80 --resolution 1600x1000 --output renders/inclined.png --resume --overwrite
"$program" --batch "$scene" --frames 1-231x10 --resolution 800x500 --output renders/flight/inclined.####.png --resume --overwrite

echo "The pictures are in $PWD/renders: inclined.png and flight/"
