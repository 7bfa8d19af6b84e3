#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""One folder of takes on all workers of a Dask cluster: batch_dask.py [SCHEDULER] FOLDER OUTFOLDER [fapenc options].

Every worker runs the same fapenc --batch on the shared folders; its claims share out the takes, so nobody here has to. SCHEDULER
is the cluster's address, tcp://HOST:8786; without one, workers are started on this machine. FAPENC names the program.
"""
import os
import subprocess
import sys

from dask.distributed import Client


def encode(fapenc, folder, out, options):
    """In a worker: its share of the takes."""
    done = subprocess.run([fapenc, "--batch", folder, "-o", out, "-j", "1", *options], capture_output=True, text=True)
    return done.returncode, done.stderr.strip().splitlines()[-1:]


def main():
    args = sys.argv[1:]
    address = args.pop(0) if args and args[0].startswith("tcp://") else None
    folder, out, options = os.path.abspath(args[0]), os.path.abspath(args[1]), args[2:]
    fapenc = os.environ.get("FAPENC", "fapenc")
    with Client(address) if address else Client(n_workers=4, threads_per_worker=1) as client:
        workers = list(client.scheduler_info(n_workers=-1)["workers"])
        # As many tasks as workers, each bound to one; a worker that is lost is no loss: its claims grow stale.
        tasks = [client.submit(encode, fapenc, folder, out, options, workers=[w], pure=False, allow_other_workers=True)
                 for w in workers]
        results = client.gather(tasks, errors="skip")
    for status, words in results:
        print(status, *words)
    return max((status for status, _ in results), default=1)


if __name__ == "__main__":
    sys.exit(main())
