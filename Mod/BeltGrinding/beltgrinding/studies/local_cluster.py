"""Dask's LocalCluster in a process of its own: ``python -m beltgrinding.studies.local_cluster WORKERS FOLDER``.

So it needs nothing of the program that wants it: not its executable (FreeCAD's is no Python), nor that its script could be
imported again by the workers, nor its terminal, whose Ctrl-C would reach them all. It prints the scheduler's address, and ends
with all workers when its standard input ends, that is with whoever started it.
"""

import select
import sys

LOOK_S = 2.0  # between two looks for workers that are missing


def main(workers, folder):
    """Runs until standard input ends."""
    import dask.config
    from distributed import LocalCluster

    # All that is submitted, little at a time, goes to workers at once.
    dask.config.set({"distributed.scheduler.worker-saturation": "inf"})
    # Deaths of workers after which a run is given up; it is then tried alone (cluster.py).
    dask.config.set({"distributed.scheduler.allowed-failures": 1})
    with LocalCluster(
        n_workers=0,
        threads_per_worker=1,
        processes=True,
        memory_limit=0,
        dashboard_address=None,
        local_directory=folder,
    ) as cluster:
        print(
            cluster.scheduler_address, flush=True
        )  # before there are workers, which may take long or die
        while True:
            cluster.scale(
                workers
            )  # also for those whose nanny has given up, as of one that died as it started
            if select.select([sys.stdin], [], [], LOOK_S)[0]:
                return


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
