#!/usr/bin/env bash
# tests/run.sh goes on with what app/run.sh built: configuring a build folder with the tests, and with a ccache that was
# installed in between, changes none of the program's commands. In: a folder for the build folder; it goes at the end.
set -euo pipefail
source="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
folder=$1
rm -rf "$folder"
mkdir -p "$folder/bin"
trap 'rm -rf "$folder"' EXIT
ln -s /bin/true "$folder/bin/ccache"

# commands NAME OPTION...: configures, and writes the commands that make the program to NAME.
commands() {
    cmake -S "$source" -B "$folder/build" -G Ninja -DCMAKE_UNITY_BUILD=ON "${@:2}" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
    ninja -C "$folder/build" -t commands astrosplat >"$folder/$1"
    [ "$(grep --count --fixed-strings -- ' -c ' "$folder/$1")" -gt 20 ] || { echo "$1: no commands"; exit 1; }
}

commands program -DASTROSPLAT_TESTS=OFF -DCCACHE=
# As where none was found at first.
commands tests -DASTROSPLAT_TESTS=ON -DCCACHE=CCACHE-NOTFOUND "-DCMAKE_PROGRAM_PATH=$folder/bin"
diff "$folder/program" "$folder/tests" || { echo "tests/run.sh would compile the program again"; exit 1; }
