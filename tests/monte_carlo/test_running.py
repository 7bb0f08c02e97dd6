"""Results do not depend on the order of blocks, on workers, or on interruptions."""

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


class MadeUpFlights:
    """Made-up outcomes; blocks arrive in steps of `order`, and after `most` comes an interrupt."""

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
    all_blocks = run_campaign(None, BLOCKS, fly=MadeUpFlights())
    assert_same(all_blocks, run_campaign(None, BLOCKS, fly=MadeUpFlights(-1)))
    assert all_blocks.index.tolist() == list(range(100))


def test_early_stopping_does_not_depend_on_the_order_of_arrival():
    forward, backward = MadeUpFlights(), MadeUpFlights(-1)
    outcomes = run_campaign(None, BLOCKS, fly=forward, stop_when=narrow(0.3))
    assert len(outcomes.index) == 8 * len(forward.flown) < 100
    assert_same(outcomes, run_campaign(None, BLOCKS, fly=backward, stop_when=narrow(0.3)))


@pytest.fixture
def stored(tmp_path):
    """A function that opens the folder of the campaign's samples."""
    return lambda: Storage(tmp_path / "mc", IDENTITY, force=False)


def test_an_interrupted_run_is_resumed(stored):
    with pytest.raises(KeyboardInterrupt):
        run_campaign(None, BLOCKS, fly=MadeUpFlights(most=5), storage=stored())
    progress, rest = [], MadeUpFlights()
    resumed = run_campaign(None, BLOCKS, fly=rest, storage=stored(), progress=progress.append)
    assert rest.flown == list(BLOCKS[5:])
    assert_same(resumed, run_campaign(None, BLOCKS, fly=MadeUpFlights()))
    assert progress == sorted(progress)
    assert progress[0] > 5 / len(BLOCKS)
    assert progress[-1] == pytest.approx(1.0)


def test_more_samples_of_a_campaign_fly_only_the_new_ones(stored):
    run_campaign(None, BLOCKS, fly=MadeUpFlights(), storage=stored())
    more = MadeUpFlights()
    run_campaign(None, blocks_of(120, 8), fly=more, storage=stored())
    # The last block was incomplete.
    assert [block.start for block in more.flown] == [96, 104, 112]


@pytest.mark.parametrize("corrupt", [lambda text: b"", lambda text: text[: len(text) // 2]])
def test_a_corrupt_block_is_flown_again(tmp_path, stored, corrupt):
    storage = stored()
    run_campaign(None, BLOCKS, fly=MadeUpFlights(), storage=storage)
    path = sorted((tmp_path / "mc" / "samples").iterdir())[2]
    path.write_bytes(corrupt(path.read_bytes()))
    repeated = MadeUpFlights()
    run_campaign(None, BLOCKS, fly=repeated, storage=storage)
    assert repeated.flown == [BLOCKS[2]]


def test_another_campaign_is_not_mixed_in(tmp_path, stored):
    stored().save_block(BLOCKS[0], synthetic_outcomes(range(8)))
    other = replace(IDENTITY, seed=1)
    with pytest.raises(OutputError, match="these differ: seed"):
        Storage(tmp_path / "mc", other, force=False)
    replaced = Storage(tmp_path / "mc", other, force=True)
    assert not replaced.load_blocks(BLOCKS)


def test_a_foreign_folder_is_left_alone(tmp_path):
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
    for csv_row, parquet_row in zip(rows, table, strict=True):
        assert int(csv_row["sample"]) == parquet_row["sample"]
        assert csv_row["verdict"] == parquet_row["verdict"]
        np.testing.assert_allclose(
            float(csv_row["com_error.x"]), parquet_row["com_error.x"], rtol=1e-5
        )
        assert parquet_row["mass_error"] == parquet_row["touchdown_pitch"]


def test_a_missing_scheduler_or_dask_is_an_error_with_a_hint(monkeypatch):
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
    """Kill a worker as soon as the first block has arrived."""
    while not flown:
        time.sleep(0.01)
    victim = next(iter(cluster.workers.values()))
    killed.append(victim.pid)
    os.kill(victim.pid, signal.SIGKILL)


@pytest.mark.slow
def test_a_lost_worker_does_not_change_the_results(solo12, two_workers):
    campaign = short_campaign(solo12, drop_only=True, until=0.45)
    blocks, flown, killed = blocks_of(24, 2), [], []
    killer = threading.Thread(target=kill_one, args=(two_workers, flown, killed))
    killer.start()
    with closing(Cluster(two_workers.scheduler_address)) as cluster:
        outcomes = run_campaign(campaign, blocks, fly=cluster.fly, progress=flown.append)
    killer.join()
    assert killed
    expected = fly_samples(campaign, range(24), threads=2)
    assert_same(outcomes, expected)
