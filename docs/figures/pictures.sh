#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The pictures of docs/pictures.md, from the shipped decks: `pictures.sh [BUILD]`, about half a minute.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "${1:-$here/../../build}/drivers" && pwd)
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

for deck in rectangle disc porous; do
    "$programs/dem_batch" --outdir "$runs" "$here/../../inputs/$deck.nml" >"$runs/log"
done
cd "$here"
plot() { name=$1; shift; "$programs/dem_plot" "$runs/$name.vtkhdf" "$@"; }
plot rectangle -o rectangle.png --frames 0:10:2 --columns 6
plot disc -o disc.png --frames 0:5 --columns 6
plot porous -o porous.png --frames 0:10:2 --columns 6
plot porous -o porous_stress.png --color von_mises --frames 1,2,3 --columns 3
plot disc -o disc_zoom.png --zoom 0.01:0.06,-0.01:0.02 --frames 2,3
plot disc --history -o disc_history.svg
