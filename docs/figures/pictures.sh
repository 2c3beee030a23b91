#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The pictures of docs/pictures.md and docs/tutorial.md, from the shipped decks: `pictures.sh [BUILD]`, about four
# minutes, half of them for the discs in a hopper.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
programs=$(cd "${1:-$here/../../build}/drivers" && pwd)
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

for deck in rectangle disc porous two_discs mill hammer granular brittle_disc; do
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
plot two_discs -o two_discs.png --frames 0:20:4 --columns 6 --color von_mises
plot mill -o mill.png --frames 0,3,6,24 --columns 4 --color von_mises --zoom 0.1:0.2,-0.06:0.02
plot hammer -o hammer.png --frames 0,7,13,20,26,30 --columns 6 --color von_mises
plot granular -o granular.png --frames 0,5,8,12,18,36 --columns 3 --color von_mises --width 1000
plot brittle_disc -o brittle_disc.png --color fragment --cracks --frames 2,5,8,12,20,40 --columns 3
plot brittle_disc --fragments -o brittle_disc_sizes.png

# Those of docs/tutorial.md.
inputs=$here/../../inputs
"$programs/dem_batch" --outdir "$runs" "$inputs/ring_mesh.nml" "$inputs/kirsch.nml" >"$runs/log"
"$programs/dem_batch" --outdir "$runs" "$inputs/kirsch.nml" --set output.name=lattice --set body.file= --set body.scale= \
    --set body.shape=rectangle --set body.lattice=square --set body.size=0.2,0.1 --set body.spacing=2e-3 \
    --set void.centre=-0.1,0 --set void.radius=0.01 >"$runs/log"
plot ring_mesh -o ring.png --frames 2,12,22,60 --columns 4 --color von_mises --width 1000
plot kirsch -o kirsch_mesh.png --frames -1 --color stress_xx --range 3.1e6 --zoom 0:0.03,0:0.02 --width 500
plot lattice -o kirsch_lattice.png --frames -1 --color stress_xx --range 3.1e6 --zoom -0.1:-0.07,0:0.02 --width 500
