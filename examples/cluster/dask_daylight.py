#!/usr/bin/env python3
"""Evaluates the sensors of a daylight simulation by dask.distributed, one task per part, and merges the parts.

    python3 dask_daylight.py 8 -o year office.obj --epw city.epw --points desks.csv
    python3 dask_daylight.py 8 --scheduler HOST:8786 -o year ...     the workers of a cluster, with the same paths

The first part finds the light that all parts share. A task whose worker dies is run again by Dask."""

import argparse
import subprocess
import sys


def run_part(options, part, parts, threads):
    command = ["exitance", "daylight", *options, "--part", f"{part}/{parts}", "--threads", str(threads), "--progress", "none"]
    return subprocess.run(command, capture_output=True, text=True)


def main():
    from dask.distributed import Client, LocalCluster, as_completed

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", type=int)
    parser.add_argument("--scheduler", help="address of a running scheduler; default: workers on this machine")
    parser.add_argument("--workers", type=int, default=2, help="workers on this machine")
    parser.add_argument("--threads", type=int, default=1, help="threads of every part")
    arguments, options = parser.parse_known_args()
    cluster = None
    if not arguments.scheduler:
        cluster = LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None)
    failed = 0
    with Client(arguments.scheduler or cluster) as client:
        for parts in ([1], range(2, arguments.parts + 1)):
            tasks = [client.submit(run_part, options, k, arguments.parts, arguments.threads, pure=False) for k in parts]
            for task in as_completed(tasks):
                if task.result().returncode != 0:
                    print(task.result().stderr, file=sys.stderr, end="")
                    failed += 1
    if cluster:
        cluster.close()
    if failed:
        return 1
    return subprocess.run(["exitance", "daylight", *options, "--merge"]).returncode


if __name__ == "__main__":
    sys.exit(main())
