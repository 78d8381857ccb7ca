#!/bin/bash
# Runs a sweep by GNU parallel, N variants at a time, and collects the table. With --sshlogin the same line runs them on
# other machines, which need the same paths.
#
#   parallel.sh plan.toml 4
set -e
plan=${1:?usage: parallel.sh plan.toml N}
jobs=${2:-2}
exitance sweep "$plan" --list --json |
    python3 -c 'import json, sys; [print(v["variant"]) for v in json.load(sys.stdin)["variants"] if v["state"] != "done"]' |
    parallel --will-cite --jobs "$jobs" exitance sweep "$plan" --run {} --threads 1 --progress none || true
exitance sweep "$plan" --collect
