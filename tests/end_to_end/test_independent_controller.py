"""A controller written anew, in a plain loop on the exported robot, flies as the batch engine."""

import importlib.util
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "examples" / "independent_controller.py"


def example():
    specification = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("product", "kinds"),
    [
        ("no motor", {"disturbance", "drop", "flip"}),
        # With limits the others follow what ocs-design has planned.
        ("motor", {"disturbance"}),
    ],
    indirect=["product"],
)
def test_it_touches_down_alike(product, kinds, document):
    for maneuver in document["requirement"]["maneuvers"]:
        if maneuver["kind"] not in kinds:
            continue
        flown = {
            run["ocs"]: run["metrics"]
            for run in document["validation"]
            if run["scenario"] == maneuver["name"]
        }
        roll, pitch = example().touchdown(product.folder, document, maneuver)
        assert roll == pytest.approx(flown[True]["touchdown_roll"], abs=1e-9)
        assert pitch == pytest.approx(flown[True]["touchdown_pitch"], abs=1e-9)
        if maneuver["kind"] != "flip":  # which ends as level as one that does not turn
            assert abs(pitch - flown[False]["touchdown_pitch"]) > 0.1
