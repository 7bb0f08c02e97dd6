"""Samples follow from seed and index alone."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from wheels import driven_device, paper_device

from ocs_design.device.layout import PAIR
from ocs_design.monte_carlo.uncertainty import KEYS, Sample, Uncertainty, quantities
from ocs_design.report.device import distribution_facts
from ocs_design.requirement.uncertainty import Normal, UncertaintySection

NAMES = quantities(PAIR)


def uncertainty(robot, **specified):
    return Uncertainty.of(UncertaintySection(**specified), robot, driven_device())


def test_every_key_has_a_default_and_its_own_values(solo12):
    sample = Sample.draw(uncertainty(solo12), 0, 0)
    placed = np.concatenate([sample.of(key) for key in KEYS])
    np.testing.assert_array_equal(placed, sample.values)
    assert len(NAMES) == len(sample.values) == 30


def test_a_changed_distribution_does_not_affect_other_quantities(solo12):
    usual = Sample.draw(uncertainty(solo12), 3, 5)
    changed = Sample.draw(uncertainty(solo12, com_error=Normal(0.0, 1.0)), 3, 5)
    unaffected = [not name.startswith("com_error") for name in NAMES]
    np.testing.assert_array_equal(usual.values[unaffected], changed.values[unaffected])
    assert not np.any(usual.of("com_error") == changed.of("com_error"))


def test_samples_and_seeds_are_independent(solo12):
    """Kolmogorov-Smirnov test of a quantity; no value is shared by two samples."""
    spread = uncertainty(solo12, mass_error=Normal(0.0, 0.02))
    drawn = np.array([Sample.draw(spread, 0, index).values for index in range(400)])
    masses = drawn[:, NAMES.index("mass_error")]
    truncated = stats.truncnorm(-3.0, 3.0, scale=0.02)
    assert stats.kstest(masses, truncated.cdf).pvalue > 0.01
    other = Sample.draw(spread, 1, 0).values
    varied = np.ptp(drawn, axis=0) > 0.0
    assert not np.any(drawn[0][varied] == other[varied])


def test_noise_differs_from_flight_to_flight(solo12):
    sample = Sample.draw(uncertainty(solo12), 0, 9)
    first, second = (sample.noise(flight).generate_state(4) for flight in range(2))
    assert not np.any(first == second)
    np.testing.assert_array_equal(first, sample.noise(0).generate_state(4))


def test_friction_follows_from_the_no_load_current_if_known(solo12):
    """Half of k_t I_0 is Coulomb friction, the other half viscous at the no-load speed."""
    device = driven_device()
    motor = replace(device.motor, torque_constant=0.037, no_load_current=0.2, rated_voltage=24.0)
    spread = Uncertainty.of(UncertaintySection(), solo12, replace(device, motor=motor))
    median = {key: spread.spreads[key].at(0.5) for key in ("coulomb_friction", "viscous_friction")}
    total = median["coulomb_friction"] + median["viscous_friction"] * motor.no_load_speed
    np.testing.assert_allclose(total, 0.037 * 0.2, rtol=1e-12)
    # The paper's wheels have no known motor.
    spread = Uncertainty.of(UncertaintySection(), solo12, paper_device())
    assert spread.spreads["coulomb_friction"].at(1.0) == 0.0
    assert spread.spreads["viscous_friction"].at(1.0) == 0.0


def test_samples_of_a_pair_are_those_of_earlier_versions(solo12):
    """Certificates and stored cases rely on them."""
    sample = Sample.draw(uncertainty(solo12), 3, 5)
    recorded = {
        "mass_error": 0.026138377142428792,
        "incidence_error.left": 0.009448818117993881,
        "incidence_error.right": -0.0026044601405445992,
        "resistance_error.right": 0.009561096090763282,
        "viscous_friction.left": 1.0586681173765773e-05,
        "attitude_bias.roll": 0.0027535033339801027,
        "takeoff_rate.pitch": -0.04620930361671459,
    }
    drawn = sample.by_name
    assert {name: drawn[name] for name in recorded} == pytest.approx(recorded, rel=1e-14)
    assert list(drawn)[::29] == ["mass_error", "takeoff_rate.pitch"]


def test_a_stopped_drive_is_drawn_last_and_does_not_affect_the_rest(solo12):
    spread = uncertainty(solo12)
    stops = replace(spread, detection=0.02)
    drawn = [Sample.draw(stops, 0, index) for index in range(64)]
    for index, sample in enumerate(drawn):
        np.testing.assert_array_equal(sample.values[:-2], Sample.draw(spread, 0, index).values)
    module, instant = np.array([sample.values[-2:] for sample in drawn]).T
    assert set(module) == {1.0, 2.0}
    assert stats.kstest(instant, "uniform").pvalue > 0.01
    assert spread.written() != stops.written()
    facts = dict(distribution_facts(stops.written()))
    assert facts.pop("stopped drive") == "any one, at any instant, known after 0.02"
    assert facts == dict(distribution_facts(spread.written()))
