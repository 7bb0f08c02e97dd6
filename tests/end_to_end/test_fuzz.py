"""Random options, robots by hand and specifications."""

import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest
from commands import all_paths_in, run
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from scripts import script_at

from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.specification import all_keys

FUZZ = settings(
    max_examples=15,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)

UNITS = [
    *("", "mm", " m", "kg", "g", "deg", "rad", "rpm", "rad/s", "N m", "kg m2", "kg cm2", "%", "x"),
]
MAGNITUDES = st.one_of(
    st.floats(1e-3, 1e3).map(lambda value: f"{value:.4g}"),
    st.floats().map(repr),
    st.sampled_from(["0", "-1", "1e308", "1e-308", "5e-324", "1e999", "nan", "inf", "0x10", "1_0"]),
)
QUANTITIES = st.one_of(
    st.builds(lambda number, unit: number + unit, MAGNITUDES, st.sampled_from(UNITS)),
    st.text(max_size=12),
)
INERTIAS = st.one_of(
    st.lists(st.floats(1e-6, 1e4), min_size=3, max_size=3).map(
        lambda moments: ",".join(f"{moment:.6g}" for moment in moments)
    ),
    st.lists(MAGNITUDES, max_size=7).map(",".join),
    st.text(max_size=12),
)
OPTIONS = [
    *("--rate-change", "--wheel-speed-max", "--torque-max", "--alpha", "--r-max", "--r-min"),
    *("--h-max", "--h-min", "--wall-min", "--wheel-mass-max", "--position", "--material"),
    *("--motor", "--gear", "--bus-voltage", "--joint", "--posture", "--trunk"),
]
# A single drive, because the search over all of them would take minutes.
DRIVES = st.sampled_from(
    [
        ("--motor=none",),
        ("--motor=EC 90 flat 90 W 323772", "--gear=direct", "--material=brass-c360"),
    ]
)
VALUES = st.one_of(
    QUANTITIES,
    st.floats(),
    st.integers(-(10**20), 10**20),
    st.booleans(),
    st.lists(st.one_of(QUANTITIES, st.floats(-10.0, 10.0)), max_size=4),
    st.dictionaries(st.text(max_size=5), st.floats(-1.0, 1.0), max_size=2),
    st.sampled_from(["none", "paper", "stand", "zero", "equal-rate", "weighted", "stainless-304"]),
)


@pytest.fixture
def folder(monkeypatch):
    """An empty working folder."""
    with tempfile.TemporaryDirectory() as name:
        monkeypatch.chdir(name)
        yield Path(name)


def check_exit(folder, *arguments):
    """The exit code is a known one, and only a successful command writes a folder."""
    before = all_paths_in(folder)
    result = run(*arguments)
    assert result.code in {0, 1, 2, 3, 4}
    assert bool(result.stderr) == (result.code > 1)
    if result.code in {0, 1}:
        shutil.rmtree(folder / "out")
    assert all_paths_in(folder) == before


def with_extreme_limits(test):
    """Examples of a robot like Solo12 with one extreme limit."""
    for name in ("--r-max", "--wheel-speed-max", "--rate-change", "--wheel-mass-max"):
        for value in ("1e-300", "1e300"):
            given = {"mass": "2.5", "inertia": "0.03,0.05,0.07", "drive": ("--motor=none",)}
            test = example(options={name: value}, **given)(test)
    return test


@pytest.mark.slow
@FUZZ
@given(
    mass=QUANTITIES,
    inertia=INERTIAS,
    options=st.dictionaries(st.sampled_from(OPTIONS), QUANTITIES, max_size=3),
    drive=DRIVES,
)
@example(mass="1e-300", inertia="1e-300,1e-300,1e-300", options={}, drive=("--motor=none",))
@example(mass="1e300", inertia="1e300,1e300,1e300", options={}, drive=("--motor=none",))
@with_extreme_limits
def test_robots_by_hand(folder, mass, inertia, options, drive):
    arguments = [f"{name}={value}" for name, value in options.items()]
    by_hand = (f"--mass={mass}", f"--inertia={inertia}")
    check_exit(folder, "size", *by_hand, *drive, *arguments, "--no-validate", "-q", "-o", "out")


@pytest.mark.slow
@settings(FUZZ, max_examples=6)
@given(
    moments=st.lists(st.floats(0.5, 1.0), min_size=3, max_size=3),
    size=st.floats(-5.0, 5.0),
    density=st.floats(-2.0, 4.0),
    options=st.dictionaries(
        st.sampled_from(OPTIONS[:10]),
        st.floats(-12.0, 12.0).map(lambda n: f"{10.0**n:.6g}"),
        max_size=2,
    ),
    drive=DRIVES,
)
# A robot as light as foam: the largest wheel would have more inertia than the robot.
@example(
    moments=[1.0, 1.0, 1.0],
    size=-1.0,
    density=0.0,
    options={},
    drive=("--motor=EC 90 flat 90 W 323772", "--gear=direct", "--material=brass-c360"),
)
def test_physical_robots_of_any_size(folder, moments, size, density, options, drive):
    """From a grain of dust to a mountain, with limits of 1e-12 to 1e12."""
    mass = 10.0 ** (density + 3.0 * size)
    inertia = ",".join(f"{mass * 10.0 ** (2.0 * size) * moment:.6g}" for moment in moments)
    arguments = [f"{name}={value}" for name, value in options.items()]
    by_hand = (f"--mass={mass:.6g}", f"--inertia={inertia}")
    check_exit(folder, "size", *by_hand, *drive, *arguments, "--no-validate", "-q", "-o", "out")


def toml(value):
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(key)} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        escaped = "".join(f"\\U{ord(char):08x}" if ord(char) < 0xD800 else "?" for char in value)
        return f'"{escaped}"'
    return repr(value)


@FUZZ
@given(
    specified=st.dictionaries(st.sampled_from([*all_keys(), "ocs.beta"]), VALUES, max_size=4),
    maneuver=st.dictionaries(
        st.sampled_from(sorted({name for kind in MANEUVER_KINDS.values() for name in kind.values})),
        VALUES,
        max_size=5,
    ),
    kind=st.sampled_from([*MANEUVER_KINDS, "salto", None]),
    drive=DRIVES,
)
def test_specifications(folder, specified, maneuver, kind, drive):
    lines = [f"{path} = {toml(value)}" for path, value in specified.items()]
    if kind is not None:
        lines += ["[[maneuver]]", f"kind = {toml(kind)}"]
        lines += [f"{name} = {toml(value)}" for name, value in maneuver.items()]
    (folder / "s.toml").write_text("\n".join(lines))
    by_hand = ("--mass", "2.5", "--inertia", "0.03,0.05,0.07")
    arguments = ("--spec", "s.toml", *by_hand, *drive)
    check_exit(folder, "size", *arguments, "--no-validate", "-q", "-o", "out")


@pytest.mark.slow
@settings(FUZZ, max_examples=5)
@given(
    moments=st.lists(st.floats(0.55, 1.0), min_size=3, max_size=3),
    scale=st.floats(-3.0, 3.0),
    speed=st.floats(2.0, 4.0),
    torque=st.floats(-2.0, 2.0),
)
def test_flights_of_robots_by_hand(folder, moments, scale, speed, torque):
    """From a toy to an elephant, with motors from too weak to far too strong."""
    mass, size = 10.0**scale, 10.0 ** (scale * 5.0 / 3.0)
    arguments = (
        f"--mass={mass:.6g}",
        f"--inertia={','.join(f'{0.05 * size * moment:.6g}' for moment in moments)}",
        f"--wheel-speed-max={10.0**speed:.6g}",
        f"--torque-max={10.0**torque * size:.6g}",
        "--motor=none",
    )
    check_exit(folder, "size", *arguments, "-q", "-o", "out")


SCRIPT = Path(__file__).parents[2] / "examples" / "level_in_mujoco.py"


def test_what_falls_tilted_lands_level(product, capsys):
    module = script_at(SCRIPT)
    assert abs(module.main(product.folder)) < 0.2 * module.PITCH
    assert "touches down after 0.3" in capsys.readouterr().out
    module.KP = module.KD = 0.0
    np.testing.assert_allclose(module.main(product.folder), module.PITCH, rtol=0.1)
