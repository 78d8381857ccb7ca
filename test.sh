#!/usr/bin/env bash
# Installs what is missing, builds everything in Release and runs the whole test suite. With CI set in the environment
# the suite then runs once more under the address and undefined-behaviour sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

jobs=$(nproc)
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1

run_suite() {  # PRESET FOLDER
    local start=$SECONDS
    echo "== $1: configure and build"
    cmake --preset "$1" --log-level=WARNING
    cmake --build "$2" --parallel "$jobs"
    echo "== $1: test (built in $((SECONDS - start)) s)"
    ctest --test-dir "$2" --parallel "$jobs" --output-on-failure --no-tests=error --progress
}

scripts/install_dependencies.sh
run_suite release build
if [[ -n ${CI:-} ]]; then
    run_suite asan build-asan
fi
