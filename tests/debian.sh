#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# README's two commands in a bare Debian: `tests/debian.sh RELEASE FOLDER [SUITE...]`, as root.
# RELEASE is bookworm (12) or trixie (13). debootstrap makes the root in FOLDER, if it is not there yet; what the last
# commit has is cloned into it. The suites are unit, verification and deck, or those named; `all` for every one.
# On trixie ParaView is installed, too, which a test looks at a run with; bookworm's is too old.
# Packages come from DEBIAN_ARCHIVE; proxies, PIP_CERT and PIP_INDEX_URL are handed on.
set -eu

# All that is mounted belongs to a namespace of its own and goes with its last process, whatever happens.
if [ "${DEM_APART-}" != yes ]; then
    [ $# -ge 2 ] || { echo "usage: $0 RELEASE FOLDER [SUITE...]" >&2; exit 2; }
    exec env DEM_APART=yes unshare --mount --pid --fork --kill-child "$0" "$@"
fi

release=$1
mkdir -p "$2"
root=$(cd "$2" && pwd)
shift 2
[ $# -gt 0 ] || set -- unit verification deck
suites=
[ "$1" = all ] || for suite in "$@"; do suites="$suites --suite $suite"; done

if [ ! -e "$root/made" ]; then
    debootstrap --variant=minbase "$release" "$root" "${DEBIAN_ARCHIVE:-http://deb.debian.org/debian}"
    touch "$root/made"
fi
mount -t proc proc "$root/proc"
mount -t devpts devpts "$root/dev/pts"
mount -t sysfs -o ro sysfs "$root/sys" # MPI looks there for cores
cp /etc/resolv.conf /etc/hosts "$root/etc/"
if [ -n "${PIP_CERT-}" ]; then cp "$PIP_CERT" "$root/root/certificates"; fi
rm -rf "$root/root/dem"
git clone -q "$(dirname "$0")/.." "$root/root/dem"

paraview=
[ "$release" != trixie ] || paraview="apt-get -q update &&
    DEBIAN_FRONTEND=noninteractive apt-get -qy install --no-install-recommends paraview python3-paraview xvfb xauth &&"

readme() { awk -v n="$1" '/^```/ { inside = /sh$/; next } inside && ++k == n' "$root/root/dem/README.md"; }

chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    ${http_proxy:+"http_proxy=$http_proxy"} ${https_proxy:+"https_proxy=$https_proxy"} \
    ${PIP_INDEX_URL:+"PIP_INDEX_URL=$PIP_INDEX_URL"} ${PIP_CERT:+PIP_CERT=/root/certificates} \
    sh -c "$paraview cd /root/dem && $(readme 1) && $(readme 2) $suites"
awk -v place="Debian $(cat "$root/etc/debian_version")" '/^(Ok|Skipped):/ { n[$1] = $2 }
    END { print place ": README'\''s two commands, " n["Ok:"] " tests passed, " n["Skipped:"] " skipped" }' \
    "$root/root/dem/build/meson-logs/testlog.txt"
