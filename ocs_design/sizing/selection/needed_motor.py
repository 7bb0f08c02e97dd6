"""What motor would do where none of the catalogue does: torque, speed and mass."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.actuation.motor import DIRECT, Motor
from ocs_design.common.units import round_outwards
from ocs_design.requirement.bound import per_wheel, spin_demands
from ocs_design.sizing.selection.feasibility import Field, largest_wheel
from ocs_design.sizing.selection.problem import SelectionProblem

_PRECISION = 0.03
"""Precision of the torque, relative."""

_STRONGER = 1.2 ** np.arange(1, 10)
"""Peak torques that are tried, over that which turns the robot alone in time: up to fivefold."""

_FASTER = (1.2, 1.6, 2.2)
"""Speeds without load that are tried, over that of the largest wheel with the robot's momentum."""

_AS_WEAK = 1.1
"""A slower motor is named in place of one that may be weaker by this factor at most."""

_STALL = (2.0, 10.0)
"""Stall torque over peak torque that a winding is taken to have, least and most."""


@dataclass(frozen=True)
class NeededMotor:
    """Motor with which there would be a device, its wheel on its shaft.

    Attributes:
        peak_torque: [N m]. no_load_speed: at the supply's voltage [rad/s].
        mass: at most [kg].
        voltage: of the supply [V].
    """

    peak_torque: float
    no_load_speed: float
    mass: float
    voltage: float

    @property
    def text(self) -> str:
        """Sentence on what to look for."""
        torque, mass = (
            round_outwards(value, upwards=True, digits=2) for value in (self.peak_torque, self.mass)
        )
        rpm = round(self.no_load_speed * 30.0 / np.pi, -2)
        return (
            f"A motor of about {torque:.3g} N m peak torque and {rpm:,.0f} rpm without load at "
            f"{self.voltage:g} V, of at most {mass:.3g} kg, would do."
        )


def needed_motor(problem: SelectionProblem, model: Motor) -> NeededMotor | None:
    """The weakest motor that would do, built as `model` is.

    Torque and mass grow with the third power of a motor's lengths. Its speed is that with which the
    largest wheel has the momentum asked for, and somewhat more where that lets it be much weaker.

    Args:
        problem: that no motor solves, at a stated incidence.
        model: a motor whose figures are known.

    Returns:
        None: no such motor would do, or no time is set, or the wheels are no pairs.
    """
    incidence = problem.incidence
    if not problem.layout.pairs or incidence is None or not (model.mass and model.peak_torque):
        return None
    demands = spin_demands(problem.requirement, problem.robot.inertia, incidence)
    pairs = problem.layout.pairs
    momentum = max(per_wheel(demand.momentum, demand.incidence) for demand in demands) / pairs
    torque = max(demand.torque for demand in demands) / pairs
    largest = largest_wheel(problem, problem.envelope)
    if not (torque > 0.0 and np.isfinite(momentum) and largest > 0.0):
        return None
    found = []
    for faster in _FASTER:
        speed = faster * momentum / largest
        peak = _least_torque(problem, model, torque, speed)
        if peak is not None:
            mass = model.mass * peak / model.peak_torque
            found.append(NeededMotor(peak, speed, mass, problem.bus_voltage))
    weakest = min((need.peak_torque for need in found), default=0.0)
    return next((need for need in found if need.peak_torque <= _AS_WEAK * weakest), None)


def _least_torque(
    problem: SelectionProblem, model: Motor, torque: float, speed: float
) -> float | None:
    """Least peak torque that does with this speed without load [N m]; None: none that is tried.

    Args:
        torque: that turns the robot alone in time [N m].
        speed: [rad/s].
    """

    def does(peak: float) -> bool:
        motor = _scaled(model, peak, speed, problem.bus_voltage)
        return Field.of(replace(problem, motors=(motor,), gears=(DIRECT,))).possible

    high = next((peak for peak in (torque * _STRONGER).tolist() if does(peak)), None)
    if high is None:
        return None
    low = high / _STRONGER[0]
    while high > (1.0 + _PRECISION) * low:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if does(middle) else (middle, high)
    return float(high)


def _scaled(model: Motor, peak_torque: float, speed: float, voltage: float) -> Motor:
    """The model enlarged to a peak torque [N m], and wound for a speed [rad/s] at a voltage."""
    assert model.peak_torque is not None
    larger = peak_torque / model.peak_torque
    stall = _STALL[0]
    if model.torque_constant and model.resistance and model.rated_voltage:
        own = model.rated_voltage * model.torque_constant / model.resistance / model.peak_torque
        stall = float(np.clip(own, *_STALL))
    constant = voltage / speed

    def scaled(figure: float | None, power: float) -> float | None:
        return None if figure is None else figure * larger**power

    return replace(
        model,
        mass=scaled(model.mass, 1.0),
        diameter=scaled(model.diameter, 1.0 / 3.0),
        length=scaled(model.length, 1.0 / 3.0),
        rotor_inertia=scaled(model.rotor_inertia, 5.0 / 3.0),
        torque_constant=constant,
        resistance=voltage * constant / (stall * peak_torque),
        rated_voltage=voltage,
        no_load_speed=speed,
        speed_max=None,
        peak_torque=peak_torque,
        peak_current=None,
        continuous_torque=None,
        mounting=None,
    )
