"""An independent controller and the exported one give the flights of the simulation elsewhere."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from commands import run
from firmware import bound
from scripts import script_at

pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).parents[2] / "examples"
SCRIPT = script_at(EXAMPLES / "independent_controller.py")


@pytest.mark.parametrize(
    ("product", "kinds"),
    [
        ("no motor", {"disturbance", "drop", "flip"}),
        # With limits the other maneuvers follow plans of ocs-design.
        ("motor", {"disturbance"}),
    ],
    indirect=["product"],
)
def test_an_independent_controller_touches_down_at_the_same_attitude(product, kinds, document):
    for maneuver in document["requirement"]["maneuvers"]:
        if maneuver["kind"] not in kinds:
            continue
        metrics = {
            run["ocs"]: run["metrics"]
            for run in document["validation"]
            if run["scenario"] == maneuver["name"]
        }
        roll, pitch = SCRIPT.touchdown(product.folder, document, maneuver)
        assert roll == pytest.approx(metrics[True]["touchdown_roll"], abs=1e-9)
        assert pitch == pytest.approx(metrics[True]["touchdown_pitch"], abs=1e-9)
        if maneuver["kind"] != "flip":  # which ends level with and without the device
            assert abs(pitch - metrics[False]["touchdown_pitch"]) > 0.1


@pytest.fixture(scope="module")
def controller(product, tmp_path_factory):
    folder = tmp_path_factory.mktemp("controller") / "fly"
    assert run("export", product.folder, "-o", folder, "-q", "--formats", "controller").code == 0
    bound(folder / "controller")
    return folder / "controller"


def test_the_exported_controller_flies_all_maneuvers(product, controller, document):
    """With a motor it follows plans, and keeps the limits of motors and supply."""
    for index, maneuver in enumerate(document["requirement"]["maneuvers"]):
        (flown,) = (
            flight["metrics"]
            for flight in document["validation"]
            if flight["scenario"] == maneuver["name"] and flight["ocs"]
        )
        law = SCRIPT.Compiled(controller, index)
        roll, pitch = SCRIPT.touchdown(product.folder, document, maneuver, law)
        assert roll == pytest.approx(flown["touchdown_roll"], abs=1e-9)
        assert pitch == pytest.approx(flown["touchdown_pitch"], abs=1e-9)


@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_the_exported_controller_flies_all_maneuvers_in_basilisk(product, controller):
    """Rigid legs and another integrator cost 0.1 deg; without control 15 to 360 deg remain.

    Basilisk needs an older Matplotlib than the tests: BASILISK_PYTHON names the interpreter of an
    environment that has it.
    """
    python = os.environ.get("BASILISK_PYTHON", sys.executable)
    if subprocess.run(
        [python, "-c", "import Basilisk"], check=False, capture_output=True
    ).returncode:
        pytest.skip("no Basilisk (pip install bsk) in this environment or in BASILISK_PYTHON")
    command = [python, EXAMPLES / "controller_in_basilisk.py", product.folder, controller]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    pairs = re.findall(r"(\S+) deg, recorded +(\S+) deg", output)
    assert len(pairs) == 9
    for simulated, recorded in pairs:
        assert float(simulated) == pytest.approx(float(recorded), abs=0.1)


@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_without_maneuvers_there_is_no_controller(product, document, tmp_path):
    document = {**document, "requirement": {**document["requirement"], "maneuvers": []}}
    (tmp_path / "design.json").write_text(json.dumps(document))
    result = run("export", tmp_path, "-o", tmp_path / "fly", "--formats", "controller")
    assert result.code != 0
    assert "without a maneuver" in result.output
    assert not (tmp_path / "fly").exists()
