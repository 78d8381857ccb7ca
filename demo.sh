#!/usr/bin/env bash
# Installs what is missing, builds the program and computes the light in a furnished room: everything lands in out/demo/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

scene=(office nx=1 ny=1 nfurn=2 books=3)  # as for `exitance generate`
out=out/demo
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1

scripts/install_dependencies.sh
echo "== Building (Release)"
cmake --preset release --log-level=WARNING >/dev/null
cmake --build build --parallel "$(nproc)" --target exitance-cli

mkdir -p "$out"
exitance=build/bin/exitance
echo "== Making the room"
"$exitance" generate "${scene[@]}" -o "$out/room.obj"
echo "== Solving"
"$exitance" solve "$out/room.obj" -o "$out/solution.h5" --error 0.03
echo "== Rendering"
camera="0.2,0.2,1.7 2.3,2.3,1.05 86"
"$exitance" render "$out/solution.h5" -o "$out/picture.png" --camera "$camera" --exposure 0.3
"$exitance" render "$out/solution.h5" -o "$out/false_colour.png" --camera "$camera" --false-colour irradiance
echo "== Exporting"
"$exitance" export "$out/solution.h5" -o "$out/lit.glb"
"$exitance" export "$out/solution.h5" -o "$out/lit.hdf"
echo "== Reporting"
"$exitance" report "$out/solution.h5" -o "$out/report.html" --camera "$camera"

cat <<EOT

Done in $SECONDS s. In $out/:
  picture.png       the room as one would see it
  false_colour.png  the irradiance of its surfaces, with a legend
  report.html       pictures, tables and figures on one page (its numbers: report.json)
  lit.glb           the room with its light, for any glTF viewer
  lit.hdf           the elements, for ParaView
  solution.h5       the light, with what it took (exitance stats $out/solution.h5)
  room.obj          the scene
EOT
