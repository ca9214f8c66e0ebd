"""Studies on a cluster of Dask."""

import subprocess


def sweep(client, study, out, parts, gyro="gyro"):
    """Runs a study in so many parts on the workers of a Dask `client`, and returns the folder of the results in `out`.

    Workers have to see the study and the folder under the same paths. A part that was interrupted, as by a worker that
    was lost, goes on where it was when it is tried again. The results are the bytes of one run of `gyro sweep`.
    """

    def part(k):
        folder = f"{out}/part-{k}"
        options = ["--shard", f"{k}/{parts}", "--threads", "1", "--resume", "--out", folder]
        subprocess.run([gyro, "sweep", study, *options], check=True)
        return folder

    folders = client.gather(client.map(part, range(1, parts + 1), pure=False, retries=3))
    subprocess.run([gyro, "sweep", "merge", *folders, "--out", f"{out}/all"], check=True)
    return f"{out}/all"
