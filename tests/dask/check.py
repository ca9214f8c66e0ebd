"""A study on Dask's local cluster gives the bytes of one thread: `.ci/dask` runs this."""

import filecmp
import os
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "studies"))

from dask.distributed import Client, LocalCluster  # noqa: E402
from on_dask import sweep  # noqa: E402


def main(gyro):
    study = str(root / "tests/mpi/study.toml")
    with tempfile.TemporaryDirectory() as out:
        one = f"{out}/one"
        subprocess.run([gyro, "sweep", study, "--threads", "1", "--out", one], check=True)
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            many = sweep(client, study, f"{out}/many", 5, gyro)
        names = [name for name in os.listdir(one) if not name.startswith(".")]
        same, differing, missing = filecmp.cmpfiles(one, many, names, shallow=False)
        if differing or missing or not same:
            sys.exit(f"dask: {differing} differ, {missing} are missing")
        print(f"dask: 5 parts on 2 workers wrote the bytes of one thread, in {len(same)} files")


if __name__ == "__main__":
    main(str(Path(sys.argv[1]).resolve()))
