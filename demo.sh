#!/usr/bin/env bash
# Installs what is missing, builds the program and computes the light in a furnished room: everything lands in out/demo/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

scene=(office nx=1 ny=1 nfurn=4 books=3)  # as for `exitance generate`
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
"$exitance" solve "$out/room.obj" -o "$out/solution.h5"
echo "== Exporting"
"$exitance" export "$out/solution.h5" -o "$out/lit.glb"
"$exitance" export "$out/solution.h5" -o "$out/lit.vtkhdf"

cat <<EOT

Done in $SECONDS s. In $out/:
  room.obj      the scene
  solution.h5   the light, with what it took (exitance stats $out/solution.h5); ParaView opens it as it is
  lit.glb       the room with its light, for any glTF viewer
  lit.vtkhdf    the elements, for ParaView
EOT
