#!/usr/bin/env bash
# From a fresh clone to pictures: installs what is missing, builds the Release program, renders the demo scene's still
# and a short fly-through into renders/. Run again, it renders only what has changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scene=assets/scenes/whirlpool.toml

bash third_party/install.sh build
cmake --preset release -DASTROSPLAT_TESTS=OFF >/dev/null
cmake --build --preset release --target astrosplat

program=build/release/astrosplat
"$program" --batch "$scene" --frames 96 --resolution 1920x1080 --output renders/whirlpool.png --resume --overwrite
"$program" --batch "$scene" --frames 1-231x10 --resolution 960x540 --output renders/flight/whirlpool.####.png --resume --overwrite

echo "The pictures are in $PWD/renders: whirlpool.png and flight/"
