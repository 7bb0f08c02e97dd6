"""What it costs that the robot lands though any one drive stops, and which layouts can do it."""

from contextlib import suppress
from dataclasses import replace

from ocs_design.common.errors import Infeasible
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.resolving import Resolved, resolve
from ocs_design.requirement.specification import MORE_PAIRS, PYRAMID, Specification
from ocs_design.robot.links import listed
from ocs_design.robot.meshes import size
from ocs_design.robot.robot import Robot
from ocs_design.sizing.changes import Progress
from ocs_design.sizing.design import design_device

SURVIVORS = ("triad", *MORE_PAIRS[:1], PYRAMID)
"""Layouts that reach roll and pitch with any one wheel left out, the fewest wheels first."""


def survivors(specification: Specification, robot: Robot, progress: Progress) -> str:
    """Layouts that would survive a stopped drive and their masses, for one that cannot.

    Args:
        specification: what was stated. robot: that carries the device.
        progress: is told the share that is done.
    """
    masses: dict[str, float] = {}
    for done, layout in enumerate(SURVIVORS):
        progress(done / len(SURVIVORS))
        ocs = replace(
            specification.ocs, layout=layout, axes=None, position=None, alpha=None,
            alpha_criterion=None,
        )  # fmt: skip
        asked = replace(specification, ocs=ocs)
        if any(contradictions(asked)):
            continue
        resolved = resolve(asked, robot, size(robot.tree, robot.posture, robot.trunk))
        with suppress(Infeasible):
            designed = design_device(asked, robot, resolved, advise=False, ranked=False)
            masses[layout] = designed.device.mass
    if not masses:
        return "No layout that survives it has a device either."
    told = listed([f"`--layout {name}` {1e3 * mass:.0f} g" for name, mass in masses.items()])
    return (
        f"What survives it weighs: {told}. At which instants a device that need not survive lands "
        "all the same, `validate DESIGN --survives one` tells."
    )


def mass_without_survival(
    specification: Specification, robot: Robot, resolved: Resolved
) -> float | None:
    """Mass of the lightest device that need not survive a stopped drive [kg]; None: there is none.

    Args:
        specification: what was stated. robot: that carries the device. resolved: what was meant.
    """
    free = replace(resolved, requirement=replace(resolved.requirement, detection=None))
    with suppress(Infeasible):
        return design_device(specification, robot, free, advise=False, ranked=False).device.mass
    return None
