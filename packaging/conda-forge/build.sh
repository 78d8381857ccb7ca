#!/usr/bin/env bash
# Called by conda build. This recipe was not run.
set -euo pipefail

# Where tinygltf and cpp-httplib are headers only, the build needs a library of each.
make_library() {  # NAME, source text
    if compgen -G "$PREFIX/lib/lib$1.*" >/dev/null; then return; fi
    echo "$2" >"$1.cpp"
    "$CXX" -std=c++20 -O2 -fPIC -I"$PREFIX/include" -c "$1.cpp" -o "$1.o"
    "$AR" rcs "$PREFIX/lib/lib$1.a" "$1.o"
}
make_library tinygltf '#define TINYGLTF_IMPLEMENTATION
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <tiny_gltf.h>'
make_library cpp-httplib '#include <httplib.h>'

# DejaVu Sans labels pictures. The package of conda-forge has the monospaced face only, which serves as well.
font=$(find "$PREFIX/fonts" -name 'DejaVuSans*.ttf' | sort | head -n 1)

cmake -S . -B build-conda -G Ninja ${CMAKE_ARGS:-} -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH="$PREFIX" \
    -D CMAKE_INSTALL_PREFIX="$PREFIX" -D EXITANCE_TESTS=OFF -D EXITANCE_VIEWER=OFF -D EXITANCE_DISTRIBUTED=OFF \
    -D EXITANCE_PYTHON=ON -D Python_EXECUTABLE="$PYTHON" -D EXITANCE_FONT="$font"
cmake --build build-conda --parallel "${CPU_COUNT:-2}" --target exitance-cli exitance-static exitance-shared exitance-python \
    exitance-reference exitance-package-files
cmake --install build-conda
mkdir -p "$SP_DIR"
mv "$PREFIX/lib/python3/dist-packages/exitance" "$SP_DIR/exitance"
