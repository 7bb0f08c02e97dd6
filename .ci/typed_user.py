"""What a user's type checker must see: types as they are, and none that is anything."""

from pathlib import Path
from typing import assert_type

import ocs_design
from ocs_design import OcsDesign, Outcome, Specification, design_ocs, read_design


def masses(folder: Path) -> tuple[float, float]:
    """Of both modules, read and made anew [kg]."""
    design, outcome = read_design(folder / "design.json"), design_ocs(Specification())
    assert_type(design, OcsDesign)
    assert_type(outcome, Outcome)
    assert_type(design.ocs.mass_total, float)
    assert_type(ocs_design.__version__, str)
    return design.ocs.mass_total, outcome.device.mass
