"""Every legged robot at hand, with no option beyond its file: a design or a full explanation."""

import re

import pytest
import trimesh
from anatomy import ANATOMY
from anatomy import LEGGED as WALKING
from commands import environment, run, run_measured
from robots import ROBOTS

from ocs_design.parts.carrier_plate import TUBES

# Upper bodies of a humanoid: its legs are not in their files.
LEGGED = [*WALKING, *(name for name in ANATOMY if name.startswith("alex_description"))]

SOLO12 = "solo_description/robots/solo12"
TALOS = "talos_data/robots/talos_full_v2"


def test_they_are_34():
    assert len(LEGGED) == 34
    assert set(LEGGED) >= {SOLO12, TALOS}


@pytest.mark.exhaustive  # `benchmarks/legged_robots.py` has all 34, `test_product.py` a small one.
@pytest.mark.parametrize("name", [SOLO12, TALOS])
def test_size_ends_with_a_design_and_its_proof_or_with_the_motor_that_would_do(name, tmp_path):
    """A light one and a heavy one, whichever it is, with no complaint and in bounded memory."""
    out = tmp_path / "out"
    # Their jumps have their own tests; planning them for all would take minutes.
    asked = ("size", ROBOTS / f"{name}.urdf", "--ballistic", "-o", out, "--json")
    said, peak = run_measured(*asked, env=environment())
    assert said.stderr == ""
    assert 2**16 < peak < 2**20, "KiB, hence 1 GiB"
    if said.code == 4:
        assert name != SOLO12, "the paper built one"
        check_refusal(said.document["error"])
        assert not out.exists()
    else:
        check_proof(name, out, said.code, said.document)


@pytest.mark.exhaustive  # A mast on a simple column: `test_footing.py`.
def test_a_humanoid_carries_them_on_its_back(tmp_path, no_alternatives):
    """Where its back is flat enough for screws, and out of reach of its feet in a landing."""
    robot = ROBOTS / "g1_description" / "urdf" / "g1_29dof_rev_1_0.urdf"
    # The one that is chosen from all.
    motor = ("--motor", "U15 II KV80", "--gear", "direct")
    asked = (*motor, "--ballistic", "--no-validate", "-o", tmp_path / "out", "--json")
    said = run("size", robot, *asked)
    code, document = said.code, said.document
    assert document["buildable"] == {"yes": True, "open": []}
    assert code == 0
    assert document["ocs"]["plate"]["mast"]["side"] in {side for side, _ in TUBES}
    written = {each.name: trimesh.load_mesh(each) for each in tmp_path.glob("out/cad/*.stl")}
    assert {"mast.stl", "plate.stl"} <= set(written)
    for name, mesh in written.items():
        assert mesh.is_watertight, name
        assert mesh.body_count == 1, name


def check_refusal(error):
    """What is missing, with figures, and what would do."""
    assert error["kind"] == "infeasible"
    assert re.search(r"None of \d+ motors can do it", error["message"])
    told = re.search(r" takes ([\d.]+) s at best, ([\d.]+) s given", error["message"])
    if told:
        assert float(told[1]) > float(told[2])
    else:
        # The robot with a mast is turned in time, but not with the device as well.
        assert re.match(r"With a mount of [\d.]+ kg on the trunk: ", error["message"])
    needed = re.search(
        r"A motor with about ([\d.]+) N m peak torque and ([\d,]+) rpm no-load speed at (\d+) V, "
        r"weighing at most ([\d.]+) kg, would do\.",
        error["hint"],
    )
    assert needed or error["relaxations"]["time"] > 1.0


def check_proof(name, out, code, document):
    """A design whose flights pass, or fail for a reason that is physics; exit code 1 says so."""
    assert code in {0, 1}, document
    assert sum(path.stat().st_size for path in out.rglob("*") if path.is_file()) < 32 * 2**20
    check_design(document)
    failing = check_flights(document)
    assert code == (1 if failing or document["buildable"]["yes"] is False else 0)
    check_reasons(name.rpartition("/")[2], failing)


def check_design(document):
    robot, ocs = document["robot"], document["ocs"]
    # Of the rims alone, as without motors: motors and housings come on top.
    assert 2.0 * ocs["flywheel"]["mass"] / robot["mass"] < 0.15
    assert ocs["mass_total"] / robot["mass"] > 0.02
    assert document["sizing"]["residual"] < 1e-9
    assert len(document["requirement"]["maneuvers"]) == 3


def check_flights(document):
    """What does not pass with the device; without it nothing does, and each has its reason."""
    assert len(document["validation"]) == 6
    for flown in document["validation"]:
        assert flown["reason"]
        assert flown["ocs"] or flown["passed"] is False, flown["reason"]
        assert flown["metrics"]["momentum_error"] < 1e-6
    return {
        flown["scenario"]: flown
        for flown in document["validation"]
        if flown["ocs"] and not flown["passed"]
    }


def check_reasons(name, failing):
    """Whatever fails is physics: a biped without balance, which stands level and topples."""
    assert name == TALOS.rpartition("/")[2] or not failing
    for flown in failing.values():
        assert flown["passed"] is False, flown["reason"]
        assert flown["metrics"]["touchdown_pitch"] < 0.09
        assert "does not stay up" in flown["reason"]
