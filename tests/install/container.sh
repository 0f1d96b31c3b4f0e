#!/usr/bin/env bash
# Does what app/install/Containerfile says, in clean Debian roots and without a container engine: each stage in a root of
# its own, COPY by cp, RUN in a chroot. Then the entry point renders a frame there, and its pixels have to be those of the
# program given. In: the program, and a folder for the roots, which are removed at the end. Ends with 77 (skipped) where
# it cannot run: it has to be root, with debootstrap and Debian's packages in reach.
set -euo pipefail
program=$1 roots=$2
source="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
recipe="$source/app/install/Containerfile"
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" = 0 ] || skip "roots can only be made by root"
command -v debootstrap >/dev/null || skip "debootstrap is not installed"
mirror=http://deb.debian.org/debian
rm -rf "$roots"
mkdir -p "$roots"
trap 'for mount in "$roots"/*/proc; do umount "$mount" 2>/dev/null || true; done; rm -rf "$roots"' EXIT

debootstrap --variant=minbase bookworm "$roots/clean" $mirror >"$roots/log" 2>&1 || skip "no root could be made: $(tail -n 1 "$roots/log")"

stage=""
while IFS= read -r line; do
    while [[ $line == *\\ ]]; do
        IFS= read -r more
        line="${line%\\} $more"
    done
    read -r word rest <<<"$line"
    case "$word" in
    '' | '#'*) ;;
    FROM)
        stage="$roots/${rest##*AS }"
        [[ $rest == *" AS "* ]] || stage="$roots/last"
        cp -a "$roots/clean" "$stage"
        cp /etc/resolv.conf "$stage/etc/" 2>/dev/null || true
        mount -t proc proc "$stage/proc" ;;
    COPY)
        from="" to="${rest##* }" what="${rest% *}"
        if [[ $what == --from=* ]]; then
            from="$roots/${what#--from=}"; from="${from%% *}"; what="${what#* }"
            (cd "$from" && cp -a ./${what#/} "$stage$to")
        else
            mkdir -p "$stage$to"
            git -C "$source" ls-files -z | (cd "$source" && xargs -0 cp --parents -t "$stage$to")
        fi ;;
    RUN) echo "$rest"; chroot "$stage" /bin/sh -ec "$rest" >"$roots/log" 2>&1 || { tail -n 30 "$roots/log"; exit 1; } ;;
    ENTRYPOINT) entry=$(tr -d '[]",' <<<"$rest") ;;
    *) echo "$recipe: '$word' is not known here"; exit 1 ;;
    esac
done <"$recipe"

depends=$(chroot "$stage" dpkg-query --show --showformat='${Depends}' astrosplat)
! grep -E 'libgl1|libegl1|libglfw3|libimgui' <<<"$depends" || { echo "the package asks for OpenGL"; exit 1; }
mkdir "$stage/films"
cp -a "$source/assets" "$stage/films/"
arguments=(--batch assets/scenes/s106.toml --frames 1 --resolution 160x120 --overwrite --no-cache -q)
pixels() { sed -n 's/.*"sha256": "\([0-9a-f]*\)".*/\1/p' "$1"; }
chroot "$stage" /bin/sh -c "cd /films && $entry ${arguments[*]} --output there.exr --stats there.json"
(cd "$stage/films" && "$program" "${arguments[@]}" --output here.exr --stats here.json)
[ -n "$(pixels "$stage/films/here.json")" ]
[ "$(pixels "$stage/films/there.json")" = "$(pixels "$stage/films/here.json")" ] || { echo "other pixels"; exit 1; }
chroot "$stage" /bin/sh -c "$entry; [ \$? = 2 ]"
echo "the container's program renders the same pixels"
