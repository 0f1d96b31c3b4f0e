# Clean Debian roots for the tests that build and install the program in them; to be sourced. In: $roots, the folder
# they lie in, which goes at the end. Ends the script with 77 (skipped) where there can be none: making them takes root,
# debootstrap, and Debian's packages in reach.
source="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
skip() { echo "skipped: $1"; exit 77; }

begin_roots() {
    [ "$(id -u)" = 0 ] || skip "roots can only be made by root"
    command -v debootstrap >/dev/null || skip "debootstrap is not installed"
    rm -rf "$roots"
    mkdir -p "$roots"
    trap end_roots EXIT
    debootstrap --variant=minbase bookworm "$roots/clean" http://deb.debian.org/debian >"$roots/log" 2>&1 ||
        skip "no root could be made: $(tail -n 1 "$roots/log")"
}

end_roots() {
    for mount in "$roots"/*/proc; do umount "$mount" 2>/dev/null || true; done
    # What is still mounted is the machine's own.
    ! grep -q " $roots/" /proc/mounts || { echo "$roots is still in use, and stays"; return; }
    rm -rf "$roots"
}

# make_root NAME: a root like the clean one.
make_root() {
    cp -a "$roots/clean" "$roots/$1"
    cp /etc/resolv.conf "$roots/$1/etc/" 2>/dev/null || true
    mount -t proc proc "$roots/$1/proc"
}

# in_root NAME COMMAND: by its shell; says what the command said where it fails.
in_root() {
    chroot "$roots/$1" /bin/sh -ec "$2" >"$roots/log" 2>&1 || { tail -n 30 "$roots/log"; echo "failed: $2"; exit 1; }
}

# copy_sources NAME FOLDER: what git knows of, into a root's folder.
copy_sources() {
    mkdir -p "$roots/$1$2"
    git -C "$source" ls-files -z | (cd "$source" && xargs -0 cp --parents -t "$roots/$1$2")
}

# check_pixels NAME PROGRAM THERE: a frame that the root's command THERE renders has the pixels of PROGRAM's out here.
check_pixels() {
    local films=$roots/$1/films arguments="--batch assets/scenes/s106.toml --frames 1 --resolution 160x120 --overwrite --no-cache -q"
    mkdir -p "$films"
    cp -a "$source/assets" "$films/"
    in_root "$1" "cd /films && $3 $arguments --output there.exr --stats there.json"
    (cd "$films" && "$2" $arguments --output here.exr --stats here.json)
    local hash
    hash=$(sed -n 's/.*"sha256": "\([0-9a-f]*\)".*/\1/p' "$films/here.json")
    [ -n "$hash" ] && grep -q "$hash" "$films/there.json" || { echo "other pixels"; exit 1; }
}
