#!/usr/bin/env bash
# Builds and tests a clone of this repository on Debian 13, in a folder, with the packages of scripts/install_dependencies.sh.
# Needs root, mmdebstrap and the registry that apt uses here. Takes as long as ./test.sh.
#
# usage: scripts/check_debian13.sh [quick]
#
# quick: configures, compiles the program and the Python module, solves an office with each, and compares ten small whole
# runs with the results that Debian 12 recorded (tests/golden), without the rest of the test suite.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

ten_runs=matrix,matrix-galerkin2,progressive,substructuring,hierarchical,wavelet-multiwavelet3,discontinuity,monte-carlo,auto,auto-sky
root=${EXITANCE_DEBIAN13:-$(mktemp -d)}  # EXITANCE_DEBIAN13 names a folder to keep and to use again
uri=$(apt-get indextargets --format '$(SITE)' "Created-By: Packages" | head -n 1)
[[ -n ${EXITANCE_DEBIAN13:-} ]] || trap 'rm -rf "$root"' EXIT

if [[ ! -e $root/etc/debian_version ]]; then
    mmdebstrap --variant=minbase --mode=root trixie "$root" "$uri"
    cp /etc/apt/apt.conf.d/* "$root/etc/apt/apt.conf.d/"
fi
rm -rf "$root/exitance"
git clone -q . "$root/exitance"
run() { chroot "$root" env -C /exitance HOME=/root LC_ALL=C.UTF-8 "$@"; }
run scripts/install_dependencies.sh
run g++ --version | head -n 1
if [[ ${1:-} == quick ]]; then
    run cmake --preset release --log-level=WARNING -D EXITANCE_PYTHON=ON -D EXITANCE_VIEWER=OFF
    run cmake --build build --parallel "$(nproc)" --target exitance-cli exitance-python
    run build/bin/exitance generate office nx=1 ny=1 -o /tmp/room.obj
    run build/bin/exitance solve /tmp/room.obj -o /tmp/room.h5 --error 0.05
    run env PYTHONPATH=build/python python3 -c \
        'import exitance as ex; print(ex.solve(ex.load("/tmp/room.obj"), error=0.05))'
    run tests/golden/golden --program build/bin/exitance --jobs "$(nproc)" --runs "$ten_runs"
    run build/bin/exitance --version
else
    run ./test.sh
fi
echo "passed on Debian $(cat "$root/etc/debian_version")"
