"""Distributions against SciPy, and their text."""

import math
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from wheels import EC45

from ocs_design.common.errors import OcsError
from ocs_design.common.units import Dimension
from ocs_design.requirement.uncertainty import (
    TRUNCATION,
    Constant,
    Normal,
    Spread,
    Uniform,
    default_uncertainty,
    entries,
    spreads,
)

ANGLE = Spread(Dimension.ANGLE, "deg")
finite = st.floats(-1e6, 1e6)


def test_a_normal_distribution_is_truncated_at_three_deviations():
    parts = np.linspace(0.0, 1.0, 101)
    ours = [Normal(2.0, 0.5).at(part) for part in parts]
    theirs = stats.truncnorm(-TRUNCATION, TRUNCATION, loc=2.0, scale=0.5).ppf(parts)
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-9)


def test_quantiles_of_uniform_and_constant():
    assert [Uniform(-1.0, 3.0).at(part) for part in (0.0, 0.25, 1.0)] == [-1.0, 0.0, 3.0]
    assert [Constant(4.0).at(part) for part in (0.0, 1.0)] == [4.0, 4.0]


@given(finite, st.floats(0.0, 1e6))
def test_text_is_read_back_exactly(mean, width):
    for spread in (Normal(mean, width), Uniform(mean, mean + width), Constant(mean)):
        assert ANGLE.read(spread.written(), "x") == spread


def test_parameters_may_have_units():
    assert ANGLE.read("normal(0, 180deg)", "x") == Normal(0.0, math.pi)
    assert Spread(Dimension.TIME, "ms").read(" uniform( 1ms ,3 ms ) ", "x") == Uniform(0.001, 0.003)
    assert ANGLE.read(0.5, "x") == Constant(0.5)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("normal(0, 40%)", "reaches -120%, beyond -90%"),
        ("normal(0, -1%)", "deviation"),
        ("uniform(1%, 0%)", "lower end"),
        ("uniform(0)", "not a distribution"),
        ("gamma(1, 2)", "not a distribution"),
        ("normal(0, 1deg)", "angle"),
        ("2", "reaches 200%, beyond 90%"),
    ],
)
def test_invalid_distributions_are_refused(text, word):
    with pytest.raises(OcsError, match=word):
        Spread(Dimension.RATIO, "%", -0.9, 0.9).read(text, "reality.mass_error")


def test_every_default_has_a_source():
    assert entries().keys() == spreads().keys()
    for name, entry in entries().items():
        assert entry.source, name


def test_defaults_scale_with_the_robot():
    """2.7 mm and 0.048 rad/s on Solo12, 0.272 m high; without a motor friction is unknown."""
    default = default_uncertainty(0.272)
    assert default.com_error == Normal(0.0, 0.00272)
    assert default.takeoff_rate.deviation == pytest.approx(0.008 * math.sqrt(9.81 / 0.272))
    assert default.coulomb_friction is None


def test_default_friction_follows_from_the_motors_no_load_current():
    """25 % to 75 % of k_t I_0 is Coulomb friction, and as much is viscous at no-load speed."""
    motor = replace(EC45, torque_constant=0.03, no_load_current=0.2, rated_voltage=12.0)
    default, torque = default_uncertainty(0.272, motor), 0.03 * 0.2
    assert default.coulomb_friction == Uniform(0.25 * torque, 0.75 * torque)
    slope = torque / (EC45.no_load_speed / 2.0)
    assert default.viscous_friction.low == pytest.approx(0.25 * slope, rel=1e-6)
    assert default.viscous_friction.high == pytest.approx(0.75 * slope, rel=1e-6)


def test_a_file_replaces_the_defaults(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(
        '[reality]\nmass_error = "normal(0, 1%)"\n'
        '[reality.com_error]\nvalue = "uniform(-2%, 2%)"\nof = "standing height"\n'
        'source = "weighed on three scales"\n'
    )
    uncertainty = default_uncertainty(0.5, file=str(file))
    assert uncertainty.mass_error == Normal(0.0, 0.01)
    assert uncertainty.com_error == Uniform(-0.01, 0.01)
    assert uncertainty.air_drag == default_uncertainty(0.5).air_drag
    assert entries(file)["com_error"].source == "weighed on three scales"


def test_a_file_that_was_edited_is_read_again(tmp_path):
    file = tmp_path / "own.toml"
    for error in (0.01, 0.02):
        file.write_text(f'[reality]\nmass_error = "normal(0, {error})"\n')
        assert default_uncertainty(0.5, file=str(file)).mass_error == Normal(0.0, error)


@pytest.mark.skipif(not Path("/dev/fd").is_dir(), reason="pipes have no path here")
def test_a_pipe_is_read_once():
    read, write = os.pipe()
    os.write(write, b'[reality]\nmass_error = "normal(0, 3%)"\n')
    os.close(write)
    for _ in range(2):
        uncertainty = default_uncertainty(0.5, file=f"/dev/fd/{read}")
        assert uncertainty.mass_error == Normal(0.0, 0.03)
    os.close(read)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ('mas_error = "1%"', "Did you mean 'mass_error'"),
        ("mass_error = { valu = 1 }", "valu"),
        ('mass_error = { source = "scales" }', "reality.mass_error.value: is missing"),
        ('com_error = { value = "1%", of = "height" }', "standing height"),
        ('takeoff_rate = { value = "1deg", of = "pendulum rate" }', "takeoff_rate"),
        ('[reality.contact_friction]\nvalue = "-50%"\nof = "standing height"', "beyond 1%"),
    ],
)
def test_faults_of_a_file_are_told(tmp_path, text, word):
    file = tmp_path / "own.toml"
    file.write_text(f"[reality]\n{text}\n")
    with pytest.raises(OcsError) as error:
        default_uncertainty(1.0, file=str(file))
    assert word in str(error.value)
