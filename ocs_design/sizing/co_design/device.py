"""Mass and inertia of robot and device, as numbers.

The same device as symbols is in `free_device`.
"""

from ocs_design.arrays import FloatArray
from ocs_design.robot.mass_properties import MassProperties
from ocs_design.sizing.carrier import Carrier
from ocs_design.sizing.co_design.problem import CoDesignProblem, DeviceShape
from ocs_design.sizing.gyrostat import Gyrostat
from ocs_design.sizing.incidence import module_axes
from ocs_design.sizing.placement import motor_size
from ocs_design.sizing.selection.candidate import braked
from ocs_design.sizing.standing import standing
from ocs_design.sizing.web import wheel_body


def device_mass(problem: CoDesignProblem, shape: DeviceShape) -> float:
    """Of both modules: wheels, motors, gears, housings and feet [kg]."""
    return float(2.0 * (wheel_of(problem, shape).mass + carrier_of(problem, shape).mass))


def gyrostat(problem: CoDesignProblem, shape: DeviceShape) -> Gyrostat:
    """Robot and device, the wheels at the incidence of `shape`."""
    return Gyrostat(
        inertia=braked_total(problem, shape).inertia,
        axes=module_axes(shape.incidence),
        spin_inertia=spin_inertia(problem, shape),
        armature=problem.selected.armature,
    )


def spin_inertia(problem: CoDesignProblem, shape: DeviceShape) -> float:
    """h of one wheel, rotor included [kg m^2]."""
    return wheel_of(problem, shape).axial_inertia + problem.selected.rotor_share


def braked_total(problem: CoDesignProblem, shape: DeviceShape) -> MassProperties:
    """Robot and both modules as one rigid body in B."""
    bodies = (wheel_of(problem, shape), carrier_of(problem, shape))
    return braked(problem.selection.robot, bodies, centers_of(problem, shape), shape.incidence)


def centers_of(problem: CoDesignProblem, shape: DeviceShape) -> FloatArray:
    """Of the left and the right wheel in B [m], shape (2, 3)."""
    chosen = problem.selected
    size = motor_size(chosen.motor, chosen.gear.room, shape.outer_radius, shape.height)
    return problem.selection.place.centers(size)


def wheel_of(problem: CoDesignProblem, shape: DeviceShape) -> Carrier:
    """One wheel as a body of revolution, like a carrier."""
    chosen, sizes = problem.selected, (shape.inner_radius, shape.outer_radius, shape.height)
    return wheel_body(*sizes, chosen.material.density, chosen.hub, cuts=chosen.cuts)


def carrier_of(problem: CoDesignProblem, shape: DeviceShape) -> Carrier:
    """What of one module stands still: motor, gear, housing and foot."""
    chosen = problem.selected
    return standing(chosen.motor, chosen.gear, shape.outer_radius, shape.height)
