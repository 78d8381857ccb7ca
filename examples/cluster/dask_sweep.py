#!/usr/bin/env python3
"""Runs a sweep by dask.distributed, one task per variant, and collects the table.

    python3 dask_sweep.py plan.toml                        two workers on this machine
    python3 dask_sweep.py plan.toml --scheduler HOST:8786  the workers of a cluster, with the same paths

A task whose worker dies is run again by Dask, and continues from the finished steps."""

import argparse
import json
import subprocess
import sys


def run_variant(plan, number, threads):
    command = ["exitance", "sweep", plan, "--run", str(number), "--threads", str(threads), "--progress", "none"]
    return subprocess.run(command, capture_output=True, text=True)


def main():
    from dask.distributed import Client, LocalCluster, as_completed

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plan")
    parser.add_argument("--scheduler", help="address of a running scheduler; default: workers on this machine")
    parser.add_argument("--workers", type=int, default=2, help="workers on this machine")
    parser.add_argument("--threads", type=int, default=1, help="threads of every step")
    arguments = parser.parse_args()
    listed = subprocess.run(["exitance", "sweep", arguments.plan, "--list", "--json"], check=True, stdout=subprocess.PIPE)
    to_do = [v["variant"] for v in json.loads(listed.stdout)["variants"] if v["state"] != "done"]
    cluster = None
    if not arguments.scheduler:
        cluster = LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None)
    with Client(arguments.scheduler or cluster) as client:
        tasks = [client.submit(run_variant, arguments.plan, k, arguments.threads, pure=False) for k in to_do]
        for task in as_completed(tasks):
            if task.result().returncode != 0:
                print(task.result().stderr, file=sys.stderr, end="")
    if cluster:
        cluster.close()
    return subprocess.run(["exitance", "sweep", arguments.plan, "--collect"]).returncode


if __name__ == "__main__":
    sys.exit(main())
