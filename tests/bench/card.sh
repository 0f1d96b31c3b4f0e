#!/usr/bin/env bash
# Everything that a machine with a graphics card has to show, in ten minutes at most: what draws, frames that have to have
# the processor's bits, times pass by pass, a flight rendered by both, and two programs on the card at once.
# Usage: card.sh FOLDER_OF_THE_PROGRAMS (astrosplat, test_gl, card_bench) [SCENE] [FRAMES]
set -uo pipefail

programs=${1:?usage: card.sh FOLDER_OF_THE_PROGRAMS [SCENE] [FRAMES]}
scene=${2:-$(dirname "$0")/../../assets/scenes/layers.toml}
frames=${3:-1-100}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

flight() {  # NAME DEVICE: renders, and prints the rate of rendering alone
    timeout 150 "$programs/astrosplat" --batch --no-cache --device "$2" -f "$frames" --resolution 1920x1080 \
        -o "$out/$1.####.exr" --stats "$out/$1.json" --progress none -q "$scene"
    python3 - "$out/$1.json" <<'PY'
import json, sys
frames = json.load(open(sys.argv[1]))["frames"]
mean = lambda key: sum(f[key] for f in frames) / len(frames)
print(f"{frames[-1]['device']}: {len(frames)} frames, rendering {1e3 * mean('render_seconds'):.1f} ms, writing "
      f"{1e3 * mean('write_seconds'):.1f} ms, all {1e3 * mean('seconds'):.1f} ms a frame")
PY
}
hashes() { python3 -c "import json, sys; print([f['sha256'] for f in json.load(open(sys.argv[1]))['frames']])" "$out/$1.json"; }

echo "== what draws"
lscpu | grep -E "Model name|^CPU\(s\)"
time timeout 60 "$programs/astrosplat" device --no-cache --device gpu
echo "== bits"
timeout 90 "$programs/test_gl" --gtest_brief=1
echo "== times"
timeout 200 "$programs/card_bench"
echo "== little memory"
timeout 60 "$programs/card_bench" --room=0.6 "10 M 5 px over 1080p"
timeout 60 "$programs/card_bench" --room=2.2 "44 M 3 px screen 1080p"
echo "== a flight"
flight cpu cpu
flight gpu gpu
[ "$(hashes cpu)" = "$(hashes gpu)" ] && echo "the same hashes" || echo "HASHES DIFFER"
echo "== two programs at once"
flight one gpu & flight two gpu
wait
[ "$(hashes one)" = "$(hashes cpu)" ] && [ "$(hashes two)" = "$(hashes cpu)" ] && echo "the same hashes" || echo "HASHES DIFFER"
