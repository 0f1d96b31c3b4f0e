#!/usr/bin/env bash
# Does what app/install/Containerfile says, in clean Debian roots and without a container engine: each stage in a root of
# its own, COPY by cp, RUN in a chroot. Then the entry point renders a frame there, and its pixels have to be those of the
# program given. In: the program, and a folder for the roots.
set -euo pipefail
program=$1 roots=$2
. "$(dirname "${BASH_SOURCE[0]}")/roots.sh"
recipe="$source/app/install/Containerfile"
begin_roots

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
        stage="${rest##*AS }"
        [[ $rest == *" AS "* ]] || stage=last
        make_root "$stage" ;;
    COPY)
        to="${rest##* }" what="${rest% *}"
        if [[ $what == --from=* ]]; then
            from="$roots/${what#--from=}"; from="${from%% *}"; what="${what#* }"
            (cd "$from" && cp -a ./${what#/} "$roots/$stage$to")
        else
            copy_sources "$stage" "$to"
        fi ;;
    RUN) echo "$rest"; in_root "$stage" "$rest" ;;
    ENTRYPOINT) entry=$(tr -d '[]",' <<<"$rest") ;;
    *) echo "$recipe: '$word' is not known here"; exit 1 ;;
    esac
done <"$recipe"

depends=$(chroot "$roots/$stage" dpkg-query --show --showformat='${Depends}' astrosplat)
! grep -E 'libgl1|libegl1|libglfw3|libimgui' <<<"$depends" || { echo "the package asks for OpenGL"; exit 1; }
check_pixels "$stage" "$program" "$entry"
in_root "$stage" "code=0; $entry || code=\$?; [ \$code = 2 ]"
echo "the container's program renders the same pixels"
