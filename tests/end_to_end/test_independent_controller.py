"""A controller written anew, and the exported one, fly elsewhere as in the batch engine."""

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
        # With limits the others follow what ocs-design has planned.
        ("motor", {"disturbance"}),
    ],
    indirect=["product"],
)
def test_one_written_anew_touches_down_alike(product, kinds, document):
    for maneuver in document["requirement"]["maneuvers"]:
        if maneuver["kind"] not in kinds:
            continue
        flown = {
            run["ocs"]: run["metrics"]
            for run in document["validation"]
            if run["scenario"] == maneuver["name"]
        }
        roll, pitch = SCRIPT.touchdown(product.folder, document, maneuver)
        assert roll == pytest.approx(flown[True]["touchdown_roll"], abs=1e-9)
        assert pitch == pytest.approx(flown[True]["touchdown_pitch"], abs=1e-9)
        if maneuver["kind"] != "flip":  # which ends as level as one that does not turn
            assert abs(pitch - flown[False]["touchdown_pitch"]) > 0.1


@pytest.fixture(scope="module")
def controller(product, tmp_path_factory):
    folder = tmp_path_factory.mktemp("controller") / "fly"
    assert run("export", product.folder, "-o", folder, "-q", "--formats", "controller").code == 0
    bound(folder / "controller")
    return folder / "controller"


def test_the_controller_one_flies_all_maneuvers(product, controller, document):
    """With a motor it follows plans, and keeps the limits of motors and supply."""
    for index, maneuver in enumerate(document["requirement"]["maneuvers"]):
        (flown,) = (
            each["metrics"]
            for each in document["validation"]
            if each["scenario"] == maneuver["name"] and each["ocs"]
        )
        law = SCRIPT.Compiled(controller, index)
        roll, pitch = SCRIPT.touchdown(product.folder, document, maneuver, law)
        assert roll == pytest.approx(flown["touchdown_roll"], abs=1e-9)
        assert pitch == pytest.approx(flown["touchdown_pitch"], abs=1e-9)


@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_it_flies_them_in_basilisk(product, controller):
    """Rigid legs and another integrator: a tenth of a degree. Without the law 15 to 360 are left.

    Basilisk asks for an older Matplotlib than the tests: BASILISK_PYTHON names the interpreter of
    an environment that has it.
    """
    python = os.environ.get("BASILISK_PYTHON", sys.executable)
    sought = [python, "-c", "import Basilisk"]
    if subprocess.run(sought, check=False, capture_output=True).returncode:
        pytest.skip("no Basilisk (pip install bsk) in this environment or in BASILISK_PYTHON")
    command = [python, EXAMPLES / "controller_in_basilisk.py", product.folder, controller]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = re.findall(r"(\S+) deg, recorded +(\S+) deg", said)
    assert len(found) == 9
    for here, there in found:
        assert float(here) == pytest.approx(float(there), abs=0.1)


@pytest.mark.parametrize("product", ["motor"], indirect=True)
def test_without_maneuvers_there_is_no_controller(product, document, tmp_path):
    document = {**document, "requirement": {**document["requirement"], "maneuvers": []}}
    (tmp_path / "design.json").write_text(json.dumps(document))
    asked = run("export", tmp_path, "-o", tmp_path / "fly", "--formats", "controller")
    assert asked.code != 0
    assert "without a maneuver" in asked.output
    assert not (tmp_path / "fly").exists()
