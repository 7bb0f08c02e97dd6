"""Pareto fronts of made-up devices, for tests of how they are printed and written."""

from ocs_design.common.errors import Infeasible
from ocs_design.device.answers import FrontDevice
from ocs_design.requirement.froude import SOLO12_PITCH_INERTIA, SOLO12_ROLL_INERTIA
from ocs_design.requirement.sections import RobotSection
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.sweep import sweep_of
from ocs_design.sizing.comparison import draw_front
from ocs_design.workflows.pareto import read_task


def task_by_hand():
    """Task with Solo12's mass and inertia, without its file."""
    inertia = (SOLO12_ROLL_INERTIA, SOLO12_PITCH_INERTIA, 0.07)
    return read_task(Specification(robot=RobotSection(mass=2.5, inertia=inertia)))


def infeasible(reason="the wheels would have to be larger"):
    """The error that the selection raises."""
    return Infeasible(
        reason,
        binding=("r_max",),
        required_spin_inertia=2.0,
        largest_spin_inertia=1.0,
        relaxations={},
    )


def made_up_device(task):
    """A device that is lighter with more time; infeasible below 0.33 s."""
    time = sweep_of("time").present_value(task)
    if time < 0.33:
        raise infeasible()
    mass = 0.03 / time**2
    return FrontDevice(
        mass=mass,
        share=mass / task.robot.mass,
        motor="Fast [28]" if time < 0.5 else "Slow 40",
        gear="direct",
        material="stainless-304",
        incidence=0.5,
        outer_radius=0.05,
        inner_radius=0.045,
        height=0.01,
        rim_mass=0.3 * mass,
        spin_inertia=2.4e-4,
    )


def make_front(task, against="time", choose=made_up_device, **values):
    """A front over nine points, or over those that `values` specifies."""
    sweep = sweep_of(against)
    spacing = {"low": None, "high": None, "points": 9, **values}
    return draw_front(task, sweep, sweep.values(task, **spacing), choose)
