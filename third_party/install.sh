#!/usr/bin/env bash
# Installs those Debian packages of packages.txt that are missing. Silent and quick when there is nothing to do.
# In: sections of packages.txt ("build", "window", "tests"; default: build). As root, or with a sudo that asks for no password,
# it installs; otherwise it prints the one line to run, with the size of the download, and stops with exit code 2.
set -euo pipefail
export LC_ALL=C DEBIAN_FRONTEND=noninteractive
list="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/packages.txt"

packages_of_section() {
    awk -v wanted="[$1]" '{ sub(/#.*/, "") } /^\[/ { here = ($1 == wanted); next } here && NF { print $1 }' "$list"
}

is_installed() {
    [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# "91.2 MB", as apt counts it, or words where the package lists have never been fetched.
download_size() {
    local size
    size=$(apt-get install --print-uris --yes --no-install-recommends "$@" 2>/dev/null |
        sed -n 's/^Need to get \(.*\) of archives\.$/\1/p') || true
    echo "${size:-a size apt does not know before its first update}"
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "third_party/install.sh: this system has no apt-get; install the libraries named in third_party/packages.txt by hand" >&2
    exit 2
fi

missing=()
for section in "${@:-build}"; do
    for package in $(packages_of_section "$section"); do
        is_installed "$package" || missing+=("$package")
    done
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null && sudo --non-interactive true 2>/dev/null; then
        as_root=(sudo --non-interactive --preserve-env=DEBIAN_FRONTEND)
    else
        echo "astrosplat needs ${#missing[@]} more packages ($(download_size "${missing[@]}") to download). Please run this, then try again:" >&2
        echo "sudo apt-get update && sudo apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 2
    fi
fi

echo "installing ${#missing[@]} packages: ${missing[*]}" >&2
${as_root[@]+"${as_root[@]}"} apt-get update --quiet=2 || echo "apt-get update failed; trying with the lists at hand" >&2
${as_root[@]+"${as_root[@]}"} apt-get install --quiet=2 --yes --no-install-recommends \
    -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 "${missing[@]}" >&2
