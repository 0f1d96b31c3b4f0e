#!/usr/bin/env bash
# Takes the README's pictures of the window: screenshots.sh PROGRAM, from anywhere. The program runs on a display of its
# own and is driven by mouse and keys as a person would. Needs xvfb, xdotool, imagemagick.
set -euo pipefail
program=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
export HOME=$work XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state XDG_CACHE_HOME=${XDG_CACHE_HOME:-$work/cache}
width=1600 height=900

Xvfb -displayfd 3 -screen 0 "${width}x${height}x24" 3> "$work/display" > "$work/xvfb.log" 2>&1 &
display_server=$!
viewer=
stop() {
    [ -z "$viewer" ] || kill "$viewer" 2> /dev/null || true
    kill "$display_server" 2> /dev/null || true
    wait 2> /dev/null || true
    rm -rf "$work"
}
trap stop EXIT
until [ -s "$work/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$work/display")
export DISPLAY

open_viewer() {
    "$program" "$1" > "$work/viewer.log" 2>&1 &
    viewer=$!
    until xdotool search --onlyvisible --pid "$viewer" > /dev/null 2>&1; do
        kill -0 "$viewer" 2> /dev/null || { cat "$work/viewer.log" >&2; exit 1; }
        sleep 0.2
    done
    xdotool mousemove 600 850
    settle
}
# The window shows the same for two seconds: nothing is being refined any more.
settle() {
    local before= now= same=0
    while [ "$same" -lt 6 ]; do
        sleep 0.3
        now=$(import -window root rgb:- | md5sum)
        if [ "$now" = "$before" ]; then same=$((same + 1)); else same=0; fi
        before=$now
    done
}
click() { xdotool mousemove "$1" "$2"; sleep 0.3; xdotool click 1; sleep 0.5; }
keys() { for key; do xdotool key "$key"; sleep 0.5; done; }
drag() { # FROM_X FROM_Y BY_X BY_Y
    xdotool mousemove "$1" "$2" mousedown 1
    for _ in 1 2 3 4 5 6 7 8; do
        sleep 0.1
        xdotool mousemove_relative -- $(($3 / 8)) $(($4 / 8))
    done
    xdotool mouseup 1
    sleep 0.5
}
save() {
    xdotool mousemove 600 850
    settle
    import -window root "$work/$1.png"
    convert "$work/$1.png" -strip -quality 90 "$here/$1.jpg"
    echo "$here/$1.jpg"
}
close_viewer() {
    kill "$viewer"
    wait "$viewer" 2> /dev/null || true
    viewer=
    rm -rf "$work/state"
}

cp -r "$here/../scenes" "$here/../looks" "$here/../meshes" "$here/../textures" "$work" 2> /dev/null
mkdir -p "$work/assets" && mv "$work/scenes" "$work/looks" "$work/meshes" "$work/textures" "$work/assets"

open_viewer "$work/assets/scenes/whirlpool.toml"
drag 176 777 560 0                 # the playhead to the middle of the flight
save window

keys b                             # the look as it is becomes B
drag 1460 617 160 0                # the disk's alpha power
click 403 43                       # A|B
save compare
close_viewer
