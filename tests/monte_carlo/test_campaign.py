"""Samples give the same results alone or in a batch and on any number of threads."""

from dataclasses import replace

import numpy as np
import pytest
from campaigns import assert_same, short_campaign
from subsets import fast_subset
from wheels import layout_device

import ocs_design.monte_carlo.campaign
from ocs_design.common.errors import OcsError
from ocs_design.device.layout import Layout, LayoutName
from ocs_design.monte_carlo.campaign import (
    case_of,
    fly_samples,
    metrics_of,
    read_case,
    replayed,
    write_case,
)
from ocs_design.monte_carlo.certificate import SequentialTest, certificate
from ocs_design.monte_carlo.outcomes import FAULTS, Outcomes, blocks_of
from ocs_design.monte_carlo.running import fly_here
from ocs_design.monte_carlo.summary import REMEDIES, standing_advice, summarise
from ocs_design.simulation.verdict import MOMENTUM_GATE, Fault


@pytest.fixture(scope="module")
def campaign(solo12):
    return short_campaign(solo12)


@pytest.fixture(scope="module")
def outcomes(campaign):
    return fly_samples(campaign, range(6))


def test_results_do_not_depend_on_other_samples_or_threads(campaign, outcomes):
    assert_same(fly_samples(campaign, [4], threads=1), outcomes.take(slice(4, 5)))
    pair = fly_samples(campaign, [5, 2], threads=1)
    assert_same(pair.take(slice(1, 2)), outcomes.take(slice(2, 3)))


@pytest.mark.slow
def test_blocks_flown_in_parallel_give_the_same_results(campaign, outcomes):
    blocks = blocks_of(len(outcomes.index), 2)
    by_block = dict(fly_here(campaign, blocks, lambda _done: None, at_once=2))
    assert list(by_block) == list(blocks)
    assert_same(Outcomes.joined(list(by_block.values())), outcomes)


@pytest.mark.slow
def test_results_do_not_depend_on_the_memory_limit(campaign, outcomes, monkeypatch):
    monkeypatch.setattr(ocs_design.monte_carlo.campaign, "MEMORY", 1)
    progress = []
    assert_same(fly_samples(campaign, range(3), progress=progress.append), outcomes.take(slice(3)))
    assert progress == sorted(progress)
    assert progress[-1] == 1.0


@pytest.mark.slow
def test_a_sample_with_a_momentum_error_is_repeated_with_half_the_step(
    campaign, outcomes, monkeypatch
):
    """With the median error as limit half of the flights are repeated, with the same sample."""
    error = outcomes.metric("momentum_error")[:2]
    gate = float(np.median(error))
    monkeypatch.setattr("ocs_design.simulation.scenario.MOMENTUM_GATE", gate)
    repeated = fly_samples(campaign, range(2))
    inaccurate, finer = error > gate, repeated.metric("momentum_error")
    np.testing.assert_array_equal(repeated.metrics[~inaccurate], outcomes.metrics[:2][~inaccurate])
    assert np.all(finer[inaccurate] < 0.2 * error[inaccurate])
    for name in ("touchdown_pitch", "touchdown_roll"):
        change = repeated.metric(name) - outcomes.metric(name)[:2]
        assert 0.0 < np.abs(change[inaccurate]).max() < np.radians(0.05)
    for number, run in enumerate(replayed(campaign, campaign.sample(1))):
        assert run.metrics == metrics_of(repeated, 1, number)


@pytest.mark.parametrize("name", fast_subset(3, [name for name in LayoutName if name != "by-hand"]))
def test_every_wheel_has_errors_of_its_own(solo12, name, tmp_path):
    """For any layout: flights, stored blocks, cases and the certificate."""
    layout = Layout(name)
    campaign = short_campaign(solo12, device=layout_device(layout), drop_only=True)
    outcomes = fly_samples(campaign, range(2))
    assert len(outcomes.names) == 20 + 5 * len(layout)
    errors = [f"resistance_error.{wheel}" for wheel in layout.names]
    columns = [outcomes.names.index(error) for error in errors]
    assert np.unique(outcomes.values[:, columns]).size == 2 * len(layout)
    assert outcomes.metric("momentum_error").max() < MOMENTUM_GATE
    outcomes.save(tmp_path / "block.npz")
    assert_same(Outcomes.load(tmp_path / "block.npz"), outcomes)
    case = read_case(write_case(case_of(campaign, outcomes, 1, 0, "hash"), tmp_path))
    (run,) = replayed(campaign, case.to_sample(campaign.uncertainty))
    assert run.metrics == metrics_of(outcomes, 1, 0)
    outcome = certificate(SequentialTest(0.5), campaign, outcomes)
    assert outcome.whole == outcomes.all_passed[: outcome.samples].sum()


def test_samples_and_seeds_differ(campaign, outcomes):
    other = fly_samples(replace(campaign, seed=8), [0])
    for name in ("touchdown_pitch", "touchdown_roll", "peak_wheel_speed"):
        values = np.concatenate([either.metric(name).ravel() for either in (outcomes, other)])
        assert np.unique(values).size == values.size


def test_a_case_has_a_safe_file_name_and_belongs_to_its_layout(campaign, outcomes, tmp_path):
    case = replace(case_of(campaign, outcomes, 0, 0, "hash"), scenario="../up and away")
    with pytest.raises(OcsError, match=r"has no value of incidence_error\.1, "):
        case.to_sample(replace(campaign.uncertainty, layout=Layout(LayoutName.TRIAD)))
    assert write_case(case, tmp_path).parent == tmp_path
    assert [path.name for path in tmp_path.iterdir()] == ["up_and_away-0.json"]


def test_the_record_counts_the_flights(campaign, outcomes):
    record = summarise(campaign, outcomes, 10)
    assert (record.samples, record.asked, record.seed) == (6, 10, 7)
    for number, scenario in enumerate(record.scenarios):
        assert scenario.success.passed == outcomes.passed[:, number].sum()
        assert scenario.success.passed + sum(scenario.faults.values()) == 6
        speeds = outcomes.metric("peak_wheel_speed")[:, number]
        assert scenario.peak_wheel_speed.quantiles[2] == np.median(speeds)
        assert sum(scenario.peak_wheel_speed.counts) == 6
        assert len(set(scenario.worst)) == 3
        verdicts = [campaign.judged(metrics_of(outcomes, k, number), number) for k in range(6)]
        assert scenario.level == [verdict.level for verdict in verdicts].count(True)
        assert scenario.stands == [verdict.stands for verdict in verdicts].count(True)


def test_falls_after_level_landings_are_repeated_with_remedies(campaign, outcomes):
    """Two flights that stand are marked as falls: with the remedies they stand."""
    codes = np.zeros_like(outcomes.codes)
    codes[[2, 3], 1] = 1 + FAULTS.index(Fault.STANDING)
    advice = standing_advice(campaign, replace(outcomes, codes=codes), 1)
    assert advice.startswith("2 land level and then fall")
    assert all(f"2 with {words}" in advice for words in REMEDIES)
    assert standing_advice(campaign, replace(outcomes, codes=codes), 0) == ""
