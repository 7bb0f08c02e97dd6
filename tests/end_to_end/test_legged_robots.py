"""Legged robots with no option but their file: `size` gives a design or a full explanation."""

import re

import pytest
import trimesh
from commands import environment, run, run_measured
from robots import ROBOTS

from ocs_design.parts.carrier_plate import TUBES

SOLO12 = "solo_description/robots/solo12"
TALOS = "talos_data/robots/talos_full_v2"


@pytest.mark.exhaustive  # `benchmarks/legged_robots.py` has all 34, `test_product.py` a small one.
@pytest.mark.parametrize("name", [SOLO12, TALOS])
def test_size_gives_a_validated_design_or_the_motor_needed(name, tmp_path):
    """A light and a heavy robot, without messages on standard error and in bounded memory."""
    out = tmp_path / "out"
    # Planning jumps from the ground would take minutes and has its own tests.
    command = ("size", ROBOTS / f"{name}.urdf", "--ballistic", "-o", out, "--json")
    result, peak = run_measured(*command, env=environment())
    assert result.stderr == ""
    assert 2**16 < peak < 2**20, "KiB, hence 1 GiB"
    if result.code == 4:
        assert name != SOLO12, "the paper built one"
        check_refusal(result.document["error"])
        assert not out.exists()
    else:
        check_validation(name, out, result.code, result.document)


@pytest.mark.exhaustive  # A mast on a simple column: `test_footing.py`.
def test_a_humanoid_carries_the_device_on_its_back(tmp_path, no_alternatives):
    """There the trunk is flat enough for screws, and out of reach of the feet in a landing."""
    robot = ROBOTS / "g1_description" / "urdf" / "g1_29dof_rev_1_0.urdf"
    # The motor that is chosen from all.
    motor = ("--motor", "U15 II KV80", "--gear", "direct")
    options = (*motor, "--ballistic", "--no-validate", "-o", tmp_path / "out", "--json")
    result = run("size", robot, *options)
    code, document = result.code, result.document
    assert document["buildable"] == {"yes": True, "open": []}
    assert code == 0
    assert document["ocs"]["plate"]["mast"]["side"] in {side for side, _ in TUBES}
    meshes = {path.name: trimesh.load_mesh(path) for path in tmp_path.glob("out/cad/*.stl")}
    assert {"mast.stl", "plate.stl"} <= set(meshes)
    for name, mesh in meshes.items():
        assert mesh.is_watertight, name
        assert mesh.body_count == 1, name


def check_refusal(error):
    """The refusal says by how much the motors fail, and which one would suffice."""
    assert error["kind"] == "infeasible"
    assert re.search(r"None of \d+ motors can do it", error["message"])
    times = re.search(r" takes ([\d.]+) s at best, ([\d.]+) s given", error["message"])
    if times:
        assert float(times[1]) > float(times[2])
    else:
        # The robot with a mast alone can be turned in time, but not with the device.
        assert re.match(r"With a mount of [\d.]+ kg on the trunk: ", error["message"])
    needed = re.search(
        r"A motor with about ([\d.]+) N m peak torque and ([\d,]+) rpm no-load speed at (\d+) V, "
        r"weighing at most ([\d.]+) kg, would do\.",
        error["hint"],
    )
    assert needed or error["relaxations"]["time"] > 1.0


def check_validation(name, out, code, document):
    """A design whose flights pass, or fail for a physical reason with exit code 1."""
    assert code in {0, 1}, document
    assert sum(path.stat().st_size for path in out.rglob("*") if path.is_file()) < 32 * 2**20
    check_design(document)
    failing = check_flights(document)
    assert code == (1 if failing or document["buildable"]["yes"] is False else 0)
    check_reasons(name.rpartition("/")[2], failing)


def check_design(document):
    robot, ocs = document["robot"], document["ocs"]
    # The limit holds for the rims alone; motors and housings come on top.
    assert 2.0 * ocs["flywheel"]["mass"] / robot["mass"] < 0.15
    assert ocs["mass_total"] / robot["mass"] > 0.02
    assert document["sizing"]["residual"] < 1e-9
    assert len(document["requirement"]["maneuvers"]) == 3


def check_flights(document):
    """Flights that fail with the device; without it all fail, and each has a reason."""
    assert len(document["validation"]) == 6
    for flight in document["validation"]:
        assert flight["reason"]
        assert flight["ocs"] or flight["passed"] is False, flight["reason"]
        assert flight["metrics"]["momentum_error"] < 1e-6
    return {
        flight["scenario"]: flight
        for flight in document["validation"]
        if flight["ocs"] and not flight["passed"]
    }


def check_reasons(name, failing):
    """Only a biped without balance fails: it lands level and topples."""
    assert name == TALOS.rpartition("/")[2] or not failing
    for flight in failing.values():
        assert flight["passed"] is False, flight["reason"]
        assert flight["metrics"]["touchdown_pitch"] < 0.09
        assert "does not stay up" in flight["reason"]
