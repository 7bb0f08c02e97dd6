"""Warnings about a design: what a reader could miss or misread, one sentence each."""

from collections.abc import Iterator

import numpy as np

from ocs_design.actuation.motor import BY_CONVENTION, DIRECT
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.common.wording import counted, degrees, inertia
from ocs_design.device.layout import PAIR
from ocs_design.device.records.design import OcsDesign
from ocs_design.device.records.device import OcsRecord
from ocs_design.export.electrics import controller_rating
from ocs_design.report.device import has_motor
from ocs_design.report.flights import flight_remarks, hand_turn_remark, jump_remark
from ocs_design.requirement.bound import AXES, authority
from ocs_design.requirement.vocabulary import SAMPLES_DRAWN
from ocs_design.sizing.margins import MOTOR_TORQUE

COUPLING_NOTED = 0.02
"""Coupling is reported only above this share of the momentum that the turn alone needs.

30 of 31 public legged robots couple both axes by less than 0.9 % of their inertia, which amounts to
this share only at small incidences.
"""

_SHOWN_LINKS = 2
"""Number of links for which the joint values of a collision with a module are listed."""

_MUST_BE_DESIGNED = "not designed"
"""Phrase that marks notes about a part that the builder must design."""


def all_warnings(design: OcsDesign) -> Iterator[str]:
    """All warnings, the most important first: the device, its flights, the robot's file."""
    ocs = design.ocs
    yield from shortfalls(design)
    # A robot entered by hand has no geometry, so nobody expects a check.
    if ocs.clearance is None and design.robot.sha256:
        yield (
            "clearance NOT checked: the robot's geometry could not be read, so the device may "
            "intersect it; make sure that its meshes are found (--package-path NAME=DIR)"
        )
    # An oddity in the robot's file may invalidate everything else, but must not hide it.
    yield from design.robot.warnings[:1]
    if ocs.flywheel.stress_margin is None:
        yield f"stress NOT checked: the strength of {ocs.flywheel.material} is unknown"
    yield from flight_remarks(design)
    reserve = None if design.selection is None else design.selection.kept
    # Maneuvers that end off level about an axis that their incidence cannot control.
    for maneuver in () if reserve is None else reserve.maneuvers:
        if reserve is not None and maneuver.lost > 1.0 - reserve.reliability:
            yield (
                f"{maneuver.maneuver}: {maneuver.lost:.0%} of sampled robots drift off level about "
                "an axis that the wheels cannot control at its incidence: specify a larger one or "
                "none"
            )
    if reserve is not None and reserve.reliability > 1.0 - 1.0 / SAMPLES_DRAWN:
        yield (
            f"the reserve for {100.0 * reserve.reliability:.8g} % of robots is set by the worst of "
            f"{SAMPLES_DRAWN:,} samples, which cannot show more: fly more of them with --certify"
        )
    # An open point is reported with the verdict.
    reported = tuple(point.what for point in design.buildable.open)
    yield from (warning for warning in ocs.warnings if not warning.startswith(reported))
    if ocs.motor.overvoltage:
        yield ocs.motor.overvoltage
    yield from design.robot.warnings[1:]
    reachable = () if ocs.mounting is None else ocs.mounting.reachable
    if reachable:
        first, *others = dict.fromkeys(reach.part for reach in reachable)
        links = f"{first} and {counted(len(others), 'more link')}" if others else first
        yield f"{links} can hit a module within the joints' limits: restrict their joints"
    yield from _motor_notes(design)
    yield from filter(None, [jump_remark(design)])
    # Parts that the builder must design come before work done by hand.
    yield from sorted(ocs.fitting, key=lambda note: _MUST_BE_DESIGNED not in note)


def reach_notes(ocs: OcsRecord) -> Iterator[str]:
    """Joint values at which the first few links of the robot hit a module."""
    reachable = () if ocs.mounting is None else ocs.mounting.reachable
    named = [
        f"{reach.part} ({', '.join(f'{name} {value:.2f}' for name, value in reach.joints.items())})"
        for reach in reachable[:_SHOWN_LINKS]
    ]
    if len(reachable) > _SHOWN_LINKS:
        named.append(f"and {len(reachable) - _SHOWN_LINKS} more, see design.json")
    if named:
        yield f"joint values [rad or m] at which links hit a module: {'; '.join(named)}"


def _motor_notes(design: OcsDesign) -> Iterator[str]:
    """Notes on the motor's figures and its controllers; none without a motor."""
    motor = design.ocs.motor
    if not has_motor(design):
        return
    torques = (margin.demand for margin in design.margins if margin.name == MOTOR_TORQUE)
    torque, saturation = max(torques, default=0.0), motor.saturation_torque
    if saturation is not None and torque > saturation:
        yield (
            f"{motor.name} saturates above {saturation:.3g} N m at the wheel, and {torque:.3g} is "
            "needed: it takes more current and voltage than its k_t implies, so the margins of "
            "both are optimistic"
        )
    if BY_CONVENTION in motor.confidence:
        yield (
            f"the bolt threads of {motor.name} are assumed from other motors of its size: check "
            "its drawing before you order screws"
        )
    if motor.rotor_inertia_source:
        yield f"rotor inertia is an {motor.rotor_inertia_source}"
    elif motor.rotor_inertia == 0.0 and motor.gear == DIRECT.name:
        yield "rotor inertia is unknown and taken as 0: real wheels turn slower, never faster"
    rating = controller_rating(motor)
    if rating:
        count = counted(len(design.ocs.modules), "motor controller")
        if motor.controller_mass > 0.0:
            yield f"the mass includes {count}, each for {rating}, but no cables"
        else:
            yield f"the mass does not include cables and {count}, each for {rating}"


def shortfalls(design: OcsDesign) -> Iterator[str]:
    """Maneuvers that the design cannot do, or only after its modules are turned by hand."""
    limit, specified = design.ocs.motor.torque_limit, design.requirement.spin_inertia_by_hand
    for demand in design.requirement.demands:
        if limit is not None and demand.torque > limit:
            yield (
                f"{demand.source}: needs at least {demand.torque:.3g} N m per wheel, more than the "
                f"{limit:.3g} N m allowed: no wheel, however large, makes this turn in time"
            )
        if specified is not None and demand.spin_inertia > specified:
            yield f"{demand.source}: needs more than the {inertia(specified)} specified"
        yield from filter(None, [hand_turn_remark(demand, design)])


def coupling_notes(design: OcsDesign) -> Iterator[str]:
    """Cost of the coupling of pitch and roll in a robot that is not symmetric."""
    maneuvers = {maneuver.name: maneuver for maneuver in design.requirement.maneuvers}
    tilt_inertia = TiltInertia.of(design.ocs.total_inertia)
    for demand in design.requirement.demands:
        maneuver = maneuvers.get(demand.source)
        if maneuver is None or design.ocs.axes != PAIR:
            continue
        roll, pitch = maneuver.maneuver().angles != 0.0
        # It turns about both axes, or about neither.
        if roll == pitch:
            continue
        axis = int(pitch)
        shares, axis_name, other_name = authority(demand.incidence), AXES[axis], AXES[1 - axis]
        if shares[1 - axis] <= OUT_OF_REACH:
            drift = float(tilt_inertia.drift[1 - axis])
            if drift > COUPLING_NOTED:
                yield (
                    f"{demand.source}: at {degrees(demand.incidence)} the wheels cannot turn the "
                    f"robot in {other_name}. Robot and device are not symmetric, and drift by "
                    f"{drift:.2f} deg of {other_name} per degree of {axis_name}, out and back in a "
                    "full turn"
                )
            continue
        wheel_momenta = np.array([demand.roll_momentum, demand.pitch_momentum]) / shares
        increase = wheel_momenta[1 - axis] / wheel_momenta[axis]
        if increase > COUPLING_NOTED:
            yield (
                f"{demand.source}: robot and device are not symmetric: to {axis_name} alone also "
                f"takes momentum about {other_name}, {increase:.0%} more from the busier wheel at "
                f"{degrees(demand.incidence)}; the device is sized for it"
            )
