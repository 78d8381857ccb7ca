#!/usr/bin/env bash
# Installs the Debian packages that building, testing and benchmarking need; with CI set in the environment also the
# formatter, the compiler with the thread sanitizer, and a compiler for 64-bit ARM. Does nothing when all are there.
set -euo pipefail

packages=(
    g++ cmake ninja-build ccache                                             # to build
    libembree-dev libtbb-dev libcgal-dev libhdf5-dev zlib1g-dev libpng-dev libopenexr-dev  # the library
    libtinygltf-dev libjpeg-dev                                              # scenes as glTF, and their textures
    libfreetype-dev fonts-dejavu-core                                        # text in pictures
    libfmt-dev libcli11-dev nlohmann-json3-dev                               # the program
    libcpp-httplib-dev                                                       # the viewer's server
    libtomlplusplus-dev gnuplot-nox                                          # the test bed's studies and their plots
    libopenmpi-dev openmpi-bin libpetsc64-real-dev                           # several processes
    pybind11-dev python3-dev python3-numpy python3-scipy                     # the Python module
    python3-pytest mypy python3-pip python3-venv python3-setuptools python3-wheel  # its tests and its package
    python3-matplotlib                                                       # the notebooks' pictures
    libgtest-dev librapidcheck-dev python3-h5py python3-vtk9                 # the tests; our files in other readers
    qemu-user                                                                # the tests; an older processor
    libbenchmark-dev                                                         # the benchmarks
)
# The viewer's page is built by node and npm, of any origin; without them everything else is built.
command -v node >/dev/null && command -v npm >/dev/null || packages+=(nodejs npm)
[[ -z ${CI:-} ]] || packages+=(clang-format-14 clang-14 libclang-rt-14-dev g++-aarch64-linux-gnu)

missing=()
for package in "${packages[@]}"; do
    [[ $(dpkg-query --show --showformat '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
        echo "error: these packages are missing and neither root nor sudo is at hand: ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
