"""A data set on a cluster that loses a worker."""

from __future__ import annotations

import importlib.util
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path

import pytest
from test_datasets import digests, write_plan

from meshtone import datasets

distributed = pytest.importorskip("distributed")


def plan_of_50_files(folder: Path) -> Path:
    plan = write_plan(folder)
    text = plan.read_text(encoding="utf-8")
    text = text.replace("records = 24", "records = 100").replace("units = 6", "units = 20")
    text = text.replace("records_per_shard = 8", "records_per_shard = 2")
    plan.write_text(text, encoding="utf-8")
    return plan


def made_with_a_worker_lost(
    plan: Path, to: str | Path, folder: Path, finished: Callable[[], int], files: int
) -> datasets.Dataset:
    """What two workers make, of which one is killed as soon as so many files are finished, and more are not."""
    from meshtone import dask

    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=str(folder)
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        killed: list[int] = []

        def kill() -> None:
            while (there := finished()) < files:
                time.sleep(0.01)
            killed.append(there)
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        made = dask.generate(plan, to, client, parts=16)
        killer.join()
    assert files <= killed[0] < 50
    return made


def test_a_lost_worker_changes_nothing(tmp_path: Path) -> None:
    from meshtone import dask

    plan, path = plan_of_50_files(tmp_path), tmp_path / "cluster"
    local = datasets.generate_dataset(plan, tmp_path / "local")
    made = made_with_a_worker_lost(plan, path, tmp_path, lambda: len(list(path.glob("data/*.parquet"))), 1)
    assert len(made) == len(local)
    assert digests(made.path) == digests(local.path)
    with pytest.raises(ValueError, match="parts = 0"):
        dask.generate(plan, path, None, parts=0)  # type: ignore[arg-type]


class Bucket:
    """A bucket of an S3-compatible server, spoken to without the library that is tested."""

    def __init__(self, endpoint: str, name: str) -> None:
        import boto3

        self._bucket = boto3.resource("s3", endpoint_url=endpoint).create_bucket(Bucket=name)

    def names(self, prefix: str) -> list[str]:
        return [entry.key for entry in self._bucket.objects.filter(Prefix=prefix)]

    def digests(self, prefix: str) -> dict[str, str]:
        content = {entry.key: entry.get()["Body"].read() for entry in self._bucket.objects.filter(Prefix=prefix)}
        return {name.removeprefix(prefix): sha256(read).hexdigest() for name, read in content.items()}


@pytest.fixture
def bucket(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bucket]:
    """Of a server of its own, which the environment names."""
    with pytest.raises(ValueError) as refused:
        datasets.verify_dataset("s3://")
    if "this build has no object stores" in str(refused.value):
        pytest.skip("this build has no object stores: maturin develop --release --features cloud")
    if importlib.util.find_spec("moto") is None:
        pytest.skip("there is no server to write to: pip install 'moto[server]'")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    endpoint = f"http://127.0.0.1:{port}"
    settings = {
        "AWS_ENDPOINT": endpoint,
        "AWS_ALLOW_HTTP": "true",
        "AWS_REGION": "us-east-1",
        "AWS_ACCESS_KEY_ID": "tester",
        "AWS_SECRET_ACCESS_KEY": "tested",
        "NO_PROXY": "127.0.0.1",
    }
    for name, value in settings.items():
        monkeypatch.setenv(name, value)
    server = subprocess.Popen(
        [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        for _ in range(600):
            with socket.socket() as asked:
                if asked.connect_ex(("127.0.0.1", port)) == 0:
                    break
            assert server.poll() is None, "the server ended"
            time.sleep(0.1)
        yield Bucket(endpoint, "rig")
    finally:
        server.kill()
        server.wait()


def test_a_lost_worker_changes_nothing_in_an_object_store(bucket: Bucket, tmp_path: Path) -> None:
    plan, url = plan_of_50_files(tmp_path), "s3://rig/sets/gears"
    local = datasets.generate_dataset(plan, tmp_path / "local")
    made = made_with_a_worker_lost(plan, url, tmp_path, lambda: len(bucket.names("sets/gears/data/")), 25)
    assert datasets.verify_dataset(url) == {}
    assert bucket.digests("sets/gears/") == digests(local.path)
    # It is read where it is.
    assert made.is_complete and len(made) == len(local) and repr(made) == repr(local)
    assert made[99]["average_g"].tolist() == local[99]["average_g"].tolist()
    assert len(datasets.load_dataset(url, verify=True).split("test")) == len(local.split("test"))
    with pytest.raises(ValueError, match=f"{url} is no directory"):
        made.path.exists()
