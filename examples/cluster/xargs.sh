#!/bin/bash
# Runs a sweep by xargs, N variants at a time, and collects the table: parallel.sh for machines without GNU parallel.
#
#   xargs.sh plan.toml 4
set -e
plan=${1:?usage: xargs.sh plan.toml N}
jobs=${2:-2}
exitance sweep "$plan" --list --json |
    python3 -c 'import json, sys; [print(v["variant"]) for v in json.load(sys.stdin)["variants"] if v["state"] != "done"]' |
    xargs --no-run-if-empty --max-procs "$jobs" --replace={} exitance sweep "$plan" --run {} --threads 1 --progress none || true
exitance sweep "$plan" --collect
