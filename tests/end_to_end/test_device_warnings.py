"""A device that is too heavy to be wanted is said to be, and refused where warnings are errors."""

import pytest
from commands import everything_in, run

from ocs_design.catalogue.motors import motors

BULKY = ("size", "--mass", "1.2", "--inertia", "0.1,0.15,0.18", "--no-validate")
"""As hard to turn as a robot of three times its mass."""
ONE_KIND = ("--gear", "direct", "--material", "stainless-304")


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
def test_a_heavy_device_is_refused_where_warnings_are_errors(folder):
    result = run(*BULKY, "--motor", "Antigravity MN5006 KV450", *ONE_KIND, "--strict", "--json")
    error = result.document["error"]
    assert (result.code, error["kind"]) == (3, "specification")
    assert "of the robot" in error["message"]
    assert everything_in(folder) == []


@pytest.mark.slow
@pytest.mark.usefixtures("no_alternatives", "no_files")
@pytest.mark.parametrize(
    ("voltage", "remarked"),
    [("24V", True), pytest.param("16.8V", False, marks=pytest.mark.exhaustive)],
)
def test_a_motor_fed_beyond_its_rating_is_remarked(folder, voltage, remarked):
    name = "AT2814 KV1050"
    assert motors()[name].rated_voltage == 16.8
    given = ("--motor", name, "--bus-voltage", voltage, *ONE_KIND, "--no-validate")
    asked = ("--layout", "pair", "--fall", "1m", "-o", "out")
    result = run("size", "--mass", "1.2", "--inertia", "0.02,0.03,0.035", *given, *asked)
    assert result.code == 0, result.said
    words = f"{name} is rated for 16.8 V and fed with 24 V: ask the makers"
    assert (words in result.said) is remarked
