"""Dask's LocalCluster in a process of its own: ``python -m beltgrinding.studies.local_cluster WORKERS FOLDER``.

So it needs nothing of the program that wants it: not its executable (FreeCAD's is no Python), nor that its script could be
imported again by the workers, nor its terminal, whose Ctrl-C would reach them all. It prints the scheduler's address, and ends
with all workers when its standard input ends, that is with whoever started it.
"""

import select
import sys

LOOK_S = 2.0  # between two looks for workers that are missing
SETTINGS = {
    # All that is submitted, little at a time, goes to workers at once.
    "distributed.scheduler.worker-saturation": "inf",
    # Deaths of workers after which a run is given up; it is then tried alone (cluster.py).
    "distributed.scheduler.allowed-failures": 1,
    # Nobody looks at Dask's own measurements, and they take 4 % of a core in each idle worker and 5 % in the scheduler.
    "distributed.worker.profile.enabled": False,
    "distributed.worker.profile.interval": "10s",
    "distributed.worker.profile.cycle": "100s",
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "10s",
}


def main(workers, folder):
    """Runs until standard input ends."""
    import dask.config
    from distributed import LocalCluster

    dask.config.set(SETTINGS)  # also of the workers, which their nannies hand it on to
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
