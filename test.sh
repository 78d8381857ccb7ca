#!/usr/bin/env bash
# Installs what is missing, builds everything in Release and runs the whole test suite. With CI set in the environment
# it also checks the layout of the code, builds the documentation, runs the tests of units once more under the address and
# undefined-behaviour sanitizers, and what runs on several threads under the thread sanitizer, both compiled by Clang.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

source scripts/build_settings

check_layout() {
    echo "== layout of the code"
    find src tests bench \( -name '*.cpp' -o -name '*.hpp' \) -print0 | xargs -0 clang-format-14 --dry-run --Werror
}

run_suite() {  # PRESET FOLDER
    local start=$SECONDS
    echo "== $1: configure and build"
    choose_units "$2"
    cmake --preset "$1" "${unit_options[@]}" --log-level=WARNING -D EXITANCE_PYTHON=ON
    cmake --build "$2" --parallel "$(build_jobs)"
    echo "== $1: test (built in $((SECONDS - start)) s)"
    ctest --test-dir "$2" --parallel "$(nproc)" --output-on-failure --no-tests=error --progress
    echo "== $1: done in $((SECONDS - start)) s"
}

scripts/install_dependencies.sh
if [[ -n ${CI:-} ]]; then
    check_layout
    echo "== documentation"
    scripts/build_docs
fi
run_suite release build
if [[ -n ${CI:-} ]]; then
    run_suite asan build-asan
    run_suite tsan build-tsan
fi
