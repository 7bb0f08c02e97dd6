"""Robots made of figures alone."""

from collections.abc import Callable

import numpy as np
import pytest

from ocs_design.robot.mass import MassProperties
from ocs_design.robot.robot import Format, Robot
from ocs_design.robot.tree import Body, Placement, Tree


@pytest.fixture
def make_robot() -> Callable[..., Robot]:
    """Makes a robot of one body from its mass, principal inertias and standing height."""

    def make(mass: float, inertia: tuple[float, float, float], standing_height: float | None):
        properties = MassProperties(mass, np.zeros(3), np.diag(inertia))
        place = Placement.identity()
        body = Body("trunk", -1, place, None, properties, {"trunk": place}, {"trunk": mass})
        return Robot(
            name="figures",
            source="by hand",
            sha256="",
            format=Format.MANUAL,
            content=b"",
            tree=Tree("figures", (body,)),
            trunk="trunk",
            floating_base="trunk",
            posture={},
            posture_name="zero",
            mass_properties=properties,
            legs=(),
            standing_height=standing_height,
            warnings=(),
        )

    return make


@pytest.fixture
def solo12(make_robot) -> Robot:
    """The reference itself."""
    from ocs_design.requirement.froude import SOLO12

    gyration = 2.5 * SOLO12.gyration_radius**2
    yaw = gyration - SOLO12.roll_inertia - SOLO12.pitch_inertia
    return make_robot(2.5, (SOLO12.roll_inertia, SOLO12.pitch_inertia, yaw), SOLO12.standing_height)
