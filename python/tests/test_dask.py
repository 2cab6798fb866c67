"""A data set on a cluster that loses a worker."""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path

import pytest
from test_datasets import digests, write_plan

from meshtone import datasets

distributed = pytest.importorskip("distributed")


def test_a_lost_worker_changes_nothing(tmp_path: Path) -> None:
    from meshtone import dask

    plan = write_plan(tmp_path)
    text = plan.read_text(encoding="utf-8")
    text = text.replace("records = 24", "records = 400").replace("units = 6", "units = 40")
    plan.write_text(text, encoding="utf-8")
    local = datasets.generate_dataset(plan, tmp_path / "local")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=str(tmp_path)
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        path = tmp_path / "cluster"
        killed: list[int] = []

        def kill() -> None:
            # As soon as something is finished, and more is not.
            while not list(path.glob("data/*.parquet")):
                time.sleep(0.01)
            worker = next(iter(cluster.workers.values()))
            killed.append(worker.pid)
            os.kill(worker.pid, signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        made = dask.generate(plan, path, client, parts=16)
        killer.join()
    assert killed
    assert len(made) == len(local)
    assert digests(made.path) == digests(local.path)
    with pytest.raises(ValueError, match="parts = 0"):
        dask.generate(plan, path, None, parts=0)  # type: ignore[arg-type]
