"""A Dask cluster of two workers, one of which dies in the middle of it."""

import os
import signal
import sys
import threading
import time
from contextlib import closing
from dataclasses import fields

import numpy as np
import pytest
from campaigns import short_campaign

from ocs_design.common.errors import MissingToolError, OcsError
from ocs_design.monte_carlo.campaign import fly_samples
from ocs_design.monte_carlo.outcomes import Outcomes, blocks_of
from ocs_design.monte_carlo.running import Cluster, run_campaign


def test_nobody_at_the_address_is_an_error_with_its_cure(monkeypatch):
    monkeypatch.setattr("ocs_design.monte_carlo.running.PATIENCE", 0.2)
    with pytest.raises(OcsError, match="no Dask scheduler answers") as error:
        Cluster("tcp://127.0.0.1:1")
    assert "dask scheduler" in error.value.hint


def test_without_dask_the_command_that_installs_it_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingToolError) as error:
        Cluster("tcp://127.0.0.1:1")
    assert "ocs-design[cluster]" in error.value.hint


@pytest.fixture
def two_workers():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as cluster:
        yield cluster


def kill_one(cluster, flown, killed):
    """As soon as the first block has arrived."""
    while not flown:
        time.sleep(0.01)
    victim = next(iter(cluster.workers.values()))
    killed.append(victim.pid)
    os.kill(victim.pid, signal.SIGKILL)


@pytest.mark.slow
def test_a_lost_worker_loses_nothing(solo12, two_workers):
    campaign = short_campaign(solo12, drop_only=True, until=0.45)
    blocks, flown, killed = blocks_of(24, 2), [], []
    killer = threading.Thread(target=kill_one, args=(two_workers, flown, killed))
    killer.start()
    with closing(Cluster(two_workers.scheduler_address)) as cluster:
        found = run_campaign(campaign, blocks, workers=cluster, progress=flown.append)
    killer.join()
    assert killed
    alone = fly_samples(campaign, range(24), threads=2)
    for field in fields(Outcomes):
        np.testing.assert_array_equal(getattr(found, field.name), getattr(alone, field.name))
