"""Blocks come in any order, from anybody, in several goes: what is counted stays the same."""

import csv
import os
import signal
import sys
import threading
import time
from contextlib import closing
from dataclasses import replace

import numpy as np
import pyarrow.parquet
import pytest
from campaigns import assert_same, short_campaign, synthetic_outcomes

from ocs_design.common.errors import MissingToolError, OcsError, OutputError
from ocs_design.monte_carlo.campaign import fly_samples
from ocs_design.monte_carlo.outcomes import Identity, Storage, blocks_of, write_tables
from ocs_design.monte_carlo.running import Cluster, narrow, run_campaign

BLOCKS = blocks_of(100, 8)
IDENTITY = Identity(
    schema_version=1,
    tool="1",
    simulator="4",
    design="d",
    robot="r",
    reality={"mass_error": "normal(0.0, 0.02)"},
    seed=0,
    hold=5,
    desaturate=False,
)


class Made:
    """Fly nothing; `order` is that in which blocks arrive, `most` after which all is cut short."""

    def __init__(self, order=1, most=1000):
        self.flown, self._order, self._most = [], order, most

    def __call__(self, campaign, blocks, progress):
        for done, block in enumerate(blocks[:: self._order]):
            if done == self._most:
                raise KeyboardInterrupt
            self.flown.append(block)
            progress((done + 1) / len(blocks))
            yield block, synthetic_outcomes(block, 2, fail_from=1.5)


def test_the_order_of_arrival_does_not_matter():
    whole = run_campaign(None, BLOCKS, fly=Made())
    assert_same(whole, run_campaign(None, BLOCKS, fly=Made(-1)))
    assert whole.index.tolist() == list(range(100))


def test_it_stops_when_enough_is_known_at_the_same_sample_whoever_was_faster():
    forward, backward = Made(), Made(-1)
    found = run_campaign(None, BLOCKS, fly=forward, enough=narrow(0.3))
    assert len(found.index) == 8 * len(forward.flown) < 100
    assert_same(found, run_campaign(None, BLOCKS, fly=backward, enough=narrow(0.3)))


@pytest.fixture
def stored(tmp_path):
    """Opens the folder of the campaign's samples."""
    return lambda: Storage(tmp_path / "mc", IDENTITY, force=False)


def test_a_run_that_was_cut_short_goes_on(stored):
    with pytest.raises(KeyboardInterrupt):
        run_campaign(None, BLOCKS, fly=Made(most=5), storage=stored())
    told, rest = [], Made()
    again = run_campaign(None, BLOCKS, fly=rest, storage=stored(), progress=told.append)
    assert rest.flown == list(BLOCKS[5:])
    assert_same(again, run_campaign(None, BLOCKS, fly=Made()))
    assert told == sorted(told)
    assert told[0] > 5 / len(BLOCKS)
    assert told[-1] == pytest.approx(1.0)


def test_more_samples_of_the_same_campaign_need_only_those(stored):
    run_campaign(None, BLOCKS, fly=Made(), storage=stored())
    more = Made()
    run_campaign(None, blocks_of(120, 8), fly=more, storage=stored())
    # The last block was not full.
    assert [block.start for block in more.flown] == [96, 104, 112]


@pytest.mark.parametrize("spoil", [lambda text: b"", lambda text: text[: len(text) // 2]])
def test_a_spoilt_block_is_flown_again(tmp_path, stored, spoil):
    storage = stored()
    run_campaign(None, BLOCKS, fly=Made(), storage=storage)
    path = sorted((tmp_path / "mc" / "samples").iterdir())[2]
    path.write_bytes(spoil(path.read_bytes()))
    again = Made()
    run_campaign(None, BLOCKS, fly=again, storage=storage)
    assert again.flown == [BLOCKS[2]]


def test_another_campaign_is_not_mixed_in(tmp_path, stored):
    stored().keep(BLOCKS[0], synthetic_outcomes(range(8)))
    other = replace(IDENTITY, seed=1)
    with pytest.raises(OutputError, match="these differ: seed"):
        Storage(tmp_path / "mc", other, force=False)
    anew = Storage(tmp_path / "mc", other, force=True)
    assert not anew.found(BLOCKS)


def test_a_folder_of_something_else_is_left_alone(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(OutputError, match="holds no samples"):
        Storage(tmp_path, IDENTITY, force=True)
    with pytest.raises(OutputError, match="not a folder"):
        Storage(tmp_path / "thesis.tex", IDENTITY, force=True)
    assert (tmp_path / "thesis.tex").read_text() == "years of work"


def test_csv_and_parquet_hold_the_same_rows(tmp_path):
    outcomes = synthetic_outcomes(range(20), 2)
    outcomes.metrics[0, 0, 0] = np.nan
    text, parquet = write_tables(outcomes, ["a drop, tilted", "flip"], tmp_path)
    with text.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    table = pyarrow.parquet.read_table(parquet).to_pylist()
    assert len(rows) == len(table) == 40
    assert [row["scenario"] for row in rows[:2]] == ["a drop, tilted", "flip"]
    assert rows[0]["touchdown_time"] == ""
    for one, other in zip(rows, table, strict=True):
        assert int(one["sample"]) == other["sample"]
        assert one["verdict"] == other["verdict"]
        np.testing.assert_allclose(float(one["com_error.x"]), other["com_error.x"], rtol=1e-5)
        assert other["mass_error"] == other["touchdown_pitch"]


def test_without_a_scheduler_or_dask_the_cure_is_named(monkeypatch):
    monkeypatch.setattr("ocs_design.monte_carlo.running.PATIENCE", 0.2)
    with pytest.raises(OcsError, match="no Dask scheduler answers") as error:
        Cluster("tcp://127.0.0.1:1")
    assert "dask scheduler" in error.value.hint
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
        found = run_campaign(campaign, blocks, fly=cluster.fly, progress=flown.append)
    killer.join()
    assert killed
    alone = fly_samples(campaign, range(24), threads=2)
    assert_same(found, alone)
