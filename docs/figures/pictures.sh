#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The pictures of docs/pictures.md, docs/tutorial.md and docs/studies.md that are not in docs/gallery.md, whose commands
# gallery.py runs: `pictures.sh [BUILD]`, about a minute.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "${1:-$here/../../build}/drivers" && pwd)
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

for deck in rectangle disc porous hammer brittle_disc; do
    "$programs/dem_batch" --outdir "$runs" "$here/../../inputs/$deck.nml" >"$runs/log"
done
cd "$here"
plot() { name=$1; shift; "$programs/dem_plot" "$runs/$name.vtkhdf" "$@"; }
plot rectangle -o rectangle.png --frames 0:10:2 --columns 6
plot disc -o disc.png --frames 0:5 --columns 6
plot porous -o porous_stress.png --color von_mises --frames 1,2,3 --columns 3
plot disc -o disc_zoom.png --zoom 0.01:0.06,-0.01:0.02 --frames 2,3
plot disc --history -o disc_history.svg
plot hammer -o hammer.png --frames 0,7,13,20,26,30 --columns 6 --color von_mises
plot brittle_disc --fragments -o brittle_disc_sizes.png

# Those of docs/tutorial.md, whose deck stands there, and docs/studies.md.
sed -n "/^cat >ring.nml/,/^END/p" ../tutorial.md | (cd "$runs" && sh)
"$programs/dem_batch" --outdir "$runs" "$runs/ring.nml" >"$runs/log"
plot ring -o rubber_ring.png --color von_mises --frames 0:10:2 --columns 6
"$programs/dem_batch" --outdir "$runs" "$here/../../inputs/kirsch.nml" --set output.name=lattice --set body.file= --set body.scale= \
    --set body.shape=rectangle --set body.lattice=square --set body.size=0.2,0.1 --set body.spacing=2e-3 \
    --set void.centre=-0.1,0 --set void.radius=0.01 >"$runs/log"
plot lattice -o kirsch_lattice.png --frames -1 --color stress_xx --range 3.1e6 --zoom -0.1:-0.07,0:0.02 --width 500
