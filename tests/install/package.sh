#!/usr/bin/env bash
# Builds the .deb in one clean Debian root and installs it in another, as a newcomer would: what it asks for comes with it,
# what a desktop reads of it is valid, a frame has the pixels of the program given, and the window opens on a screen without
# a graphics card and closes by its key. In: the program, and a folder for the roots.
set -euo pipefail
program=$1 roots=$2
. "$(dirname "${BASH_SOURCE[0]}")/roots.sh"
begin_roots

make_root built
copy_sources built /source
in_root built "bash /source/third_party/install.sh build window
    apt-get install --yes --no-install-recommends dpkg-dev file
    cmake -S /source -B /build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DASTROSPLAT_TESTS=OFF
    cmake --build /build
    cd /build && cpack"

make_root used
cp "$roots"/built/build/astrosplat_*.deb "$roots/used/tmp/"
in_root used "apt-get update
    apt-get install --yes --no-install-recommends /tmp/astrosplat_*.deb"
in_root used "astrosplat --version
    ! ldd /usr/bin/astrosplat | grep 'not found'
    zcat -f /usr/share/man/man1/astrosplat.1* | grep -q astrosplat
    zcat -f /usr/share/man/man5/astrosplat-scene.5* | grep -q astrosplat"
check_pixels used "$program" astrosplat

# What only this test needs.
in_root used "apt-get install --yes --no-install-recommends appstream bash-completion desktop-file-utils libxml2-utils xvfb xdotool
    desktop-file-validate /usr/share/applications/org.astrosplat.Astrosplat.desktop
    appstreamcli validate --no-net /usr/share/metainfo/org.astrosplat.Astrosplat.metainfo.xml
    xmllint --noout /usr/share/mime/packages/org.astrosplat.Astrosplat.xml /usr/share/icons/hicolor/scalable/apps/org.astrosplat.Astrosplat.svg
    bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader astrosplat; complete -p astrosplat'"
in_root used "export DISPLAY=:57 HOME=/tmp
    Xvfb :57 -screen 0 1280x800x24 & screen=\$!
    trap 'kill \$screen' EXIT
    until xdotool getdisplaygeometry; do kill -0 \$screen; sleep 1; done
    cd /films && astrosplat assets/scenes/s106.toml & viewer=\$!
    timeout 120 xdotool search --sync --onlyvisible --class astrosplat windowfocus --sync
    sleep 5
    xdotool key ctrl+q
    wait \$viewer"
echo "the package installs, renders the same pixels and opens its window"
