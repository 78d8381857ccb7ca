#!/usr/bin/env bash
# Installs what is missing, builds the program and computes the light in a furnished room: everything is written to out/demo/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

source scripts/demo_room
source scripts/build_settings
out=out/demo

scripts/install_dependencies.sh
echo "== Building (Release)"
choose_units build
cmake --preset release "${unit_options[@]}" --log-level=WARNING >/dev/null
cmake --build build --parallel "$(build_jobs)" --target exitance-cli

mkdir -p "$out"
exitance=build/bin/exitance
echo "== Making the room"
make_demo_room "$exitance" "$out/room.obj"
echo "== Solving"
"$exitance" solve "$out/room.obj" -o "$out/solution.h5" --error 0.03
echo "== Rendering"
"$exitance" render "$out/solution.h5" -o "$out/picture.png" --camera "$demo_camera" --size 960x600
"$exitance" render "$out/solution.h5" -o "$out/false_colour.png" --camera "$demo_camera" --size 960x600 \
    --false-colour illuminance --unit lux --isolux
echo "== Exporting"
"$exitance" export "$out/solution.h5" -o "$out/lit.glb"
"$exitance" export "$out/solution.h5" -o "$out/lit.hdf"
echo "== Reporting"
"$exitance" report "$out/solution.h5" -o "$out/report.html" --camera "$demo_camera"

cat <<EOT

Done in $SECONDS s. In $out/:
  picture.png       the room as one would see it
  false_colour.png  the illuminance of its surfaces, with a legend
  report.html       pictures, tables and figures on one page (its numbers: report.json)
  lit.glb           the room with its light, for any glTF viewer
  lit.hdf           the elements, for ParaView
  solution.h5       the light; exitance stats $out/solution.h5 prints its error and costs
  room.obj          the scene
EOT
