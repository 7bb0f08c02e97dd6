"""When a run counts as passed, in one place."""

from dataclasses import dataclass, replace
from enum import StrEnum
from math import remainder, tau

import numpy as np

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray
from ocs_design.common.wording import degrees_number
from ocs_design.export.physics import STEADY_LEGS
from ocs_design.requirement.boundary import End
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pivoted import Pivoted
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.simulation.run import UPRIGHT_TILT, Metrics
from ocs_design.simulation.wheel_law import tilt_error

REST_RATE = np.radians(5.0)
"""Largest turning rate of a robot that counts as at rest [rad/s]."""

MOMENTUM_GATE = 1e-6
"""Largest relative momentum error of a flight that is judged at all."""

NUTATION_LIMIT = 0.05
"""Largest nutation per step [rad]: Runge-Kutta turns a nutation of `x` by `x^5 / 120` too little
(the first term of `exp(i x)` that it omits), here 1e-3 rad in four hundred steps."""


class Fault(StrEnum):
    """Reasons why a run did not pass."""

    UNSOUND = "not judged"
    TURN = "turned too little or too far"
    LANDING = "not level at touchdown"
    STANDING = "fell after a level touchdown"
    BALANCE = "not upright and at rest in time"


@dataclass(frozen=True)
class Verdict:
    """Verdict on a run.

    Attributes:
        passed: see `judge`; None if it cannot be judged. reason: why, in one sentence.
        fault: what kept it from passing.
        level: whether it touches down level; None: not judged, or there is no touchdown.
        stands: whether it is upright at the end, even if its legs cannot bear a level landing;
            None: not judged, or there is nothing to stand on.
    """

    passed: bool | None
    reason: str
    fault: Fault | None = None
    level: bool | None = None
    stands: bool | None = None


def judge(
    metrics: Metrics | None,
    maneuver: Maneuver,
    *,
    can_stand: bool | None,
    objection: str = "",
    legs: int = STEADY_LEGS,
    gate: float = MOMENTUM_GATE,
) -> Verdict:
    """The pass rule: a sound flight, the turn done, a level touchdown, upright at the end.

    Args:
        metrics: of the run; None if it became unstable.
        can_stand: whether the robot stays up on its joint drives after a level landing from this
            flight; None for a robot without legs, and in orbit. If it does not, "upright at the
            end" says nothing about the device and is not judged.
        objection: reason not to judge the run whatever its figures, see `metrics`; empty if none.
        gate: largest relative momentum error that is judged.
    """
    unsound = objection or _unsound(metrics, maneuver, gate)
    if metrics is None or unsound:
        return Verdict(None, unsound, Fault.UNSOUND)
    if isinstance(maneuver, Pivoted):
        return _pivot_verdict(metrics, maneuver)
    verdict = (
        _shove_verdict(metrics, maneuver, can_stand)
        if maneuver.on_feet
        else _landing_verdict(metrics, maneuver, can_stand, legs)
    )
    if verdict.passed is None:
        return verdict
    return replace(
        verdict,
        level=None if maneuver.on_feet else not _landing_failure(metrics, maneuver),
        stands=None if can_stand is None else metrics.upright_at_end,
    )


def _landing_verdict(
    metrics: Metrics, maneuver: Maneuver, can_stand: bool | None, legs: int
) -> Verdict:
    """Verdict on a robot that lands from a flight; see `judge`."""
    failure = _flight_failure(metrics, maneuver)
    if failure is not None:
        return failure
    landing, final = f"{_end_verb(maneuver)} at {_tilt(metrics)}", _final_tilt(metrics)
    if maneuver.heading_matters:
        landing += f", heading turned by {degrees_number(metrics.heading_drift)} deg"
        if any(landing_attitude(maneuver)[:2]):
            error = degrees_number(attitude_error_at_touchdown(metrics, maneuver))
            landing += f", its vertical {error} deg off what is asked"
    if not maneuver.gravity:
        return Verdict(True, landing)
    if not lands_on_legs(maneuver):
        ending = f"; standing is not judged: legs cannot stand in this attitude; ends at {final}"
    elif can_stand is None:
        ending = "; the robot has no legs to stand on"
    elif not can_stand:
        why = (
            ", since a robot on fewer than three feet must step, which is not simulated"
            if legs < STEADY_LEGS
            else ""
        )
        ending = (
            f"; standing is not judged: the legs cannot take this landing even if level{why}; "
            f"ends at {final}"
        )
    elif metrics.upright_at_end:
        ending = f" and stands, ending at {final}"
    else:
        return Verdict(False, f"{landing} but does not stay up: ends at {final}", Fault.STANDING)
    return Verdict(True, f"{landing}{ending}")


def _shove_verdict(metrics: Metrics, maneuver: Maneuver, can_stand: bool | None) -> Verdict:
    """Verdict on a robot that is shoved while it stands; see `judge`."""
    unjudged = ""
    if can_stand is None:
        unjudged = "the robot has no legs to stand on"
    elif not can_stand:
        unjudged = "the legs cannot keep the robot up even without the shove"
    # For a shove, touchdown is the instant at which it begins.
    elif attitude_error_at_touchdown(metrics, maneuver) > LANDING_TOLERANCE:
        unjudged = (
            f"the robot does not stand level by itself: it leans by {_tilt(metrics)} before the "
            "shove"
        )
    elif metrics.touchdown_rate > REST_RATE:
        unjudged = (
            "the robot does not stand still by itself: it turns at "
            f"{np.degrees(metrics.touchdown_rate):.0f} deg/s before the shove"
        )
    if unjudged:
        return Verdict(None, f"not judged: {unjudged}", Fault.UNSOUND)
    swing = f"swings by {_angles(metrics.pitch_swing, metrics.roll_swing)} peak to peak"
    if not metrics.upright_at_end:
        ends = f"{swing} and does not stay up: ends at {_final_tilt(metrics)}"
        return Verdict(False, ends, Fault.STANDING)
    return Verdict(True, f"{swing}, is at rest after {metrics.settling_time:.2f} s and stands")


def _pivot_verdict(metrics: Metrics, maneuver: Pivoted) -> Verdict:
    """Verdict on a robot on a pivot; see `judge`."""
    is_at = (
        f"is at {_tilt(metrics)} off balance after {maneuver.duration:.3g} s, turning at "
        f"{np.degrees(metrics.touchdown_rate):.1f} deg/s"
    )
    error = max(
        attitude_error_at_touchdown(metrics, maneuver),
        abs(metrics.final_roll),
        abs(metrics.final_pitch),
    )
    at_rest = metrics.touchdown_rate <= REST_RATE
    if error > LANDING_TOLERANCE or not at_rest or not metrics.upright_at_end:
        failure = f"{is_at}, and ends at {_final_tilt(metrics)} off balance"
        return Verdict(False, failure, Fault.BALANCE, stands=False)
    spin = f"{metrics.final_wheel_speed * 30.0 / np.pi:.0f} rpm"
    outcome = f"{is_at}, and stays up, with wheels at {spin} in the end"
    return Verdict(True, outcome, stands=True)


def lands_well(metrics: Metrics | None, maneuver: Maneuver) -> bool:
    """Whether a run passes in everything except standing."""
    if metrics is None or _unsound(metrics, maneuver):
        return False
    return _flight_failure(metrics, maneuver) is None


def stands(metrics: Metrics | None) -> bool:
    """Whether a run ends on the feet, within half the tilt allowed.

    A robot that is slowly toppling may pass 45 deg only after the run has ended.
    """
    if metrics is None or not metrics.upright_at_end:
        return False
    tilt = max(abs(metrics.final_roll), abs(metrics.final_pitch))
    return bool(tilt <= 0.5 * UPRIGHT_TILT)


def _unsound(metrics: Metrics | None, maneuver: Maneuver, gate: float = MOMENTUM_GATE) -> str:
    """Why a run cannot be judged; empty if it is sound."""
    if metrics is None:
        return "not judged: the simulation became unstable"
    if metrics.nutation > NUTATION_LIMIT:
        return (
            f"not judged: the wheels spin so fast that the trunk nutates by {metrics.nutation:.2g} "
            f"rad per physics step, more than {NUTATION_LIMIT}: lower `wheel_speed_max` for "
            "heavier, slower wheels"
        )
    if metrics.momentum_error > gate:
        return (
            f"not judged: angular momentum in flight is off by {metrics.momentum_error:.1e}, "
            f"more than {gate:.0e}: something moves too fast for the physics step; run "
            "`ocs-design inspect` and look for links with next to no inertia and for implausible "
            "values"
        )
    if metrics.lift_off_time is None:
        return "not judged: the legs cannot lift the robot off the ground"
    if metrics.touchdown_time is None and maneuver.gravity:
        return "not judged: no part of the robot touched the floor"
    return ""


def _flight_failure(metrics: Metrics, maneuver: Maneuver) -> Verdict | None:
    """What was wrong up to touchdown; None if nothing."""
    angle = maneuver.boundary().angle if maneuver.counts_turns else 0.0
    if maneuver.counts_turns and abs(metrics.turned_angle - angle) > LANDING_TOLERANCE:
        share = f"{degrees_number(metrics.turned_angle)} of {np.degrees(angle):.0f} deg"
        failure = f"turns {share} before touchdown"
        return Verdict(False, failure, Fault.TURN)
    _, _, heading = landing_attitude(maneuver)
    if heading is not None:
        turned = metrics.heading_drift
        if abs(remainder(turned - heading, tau)) > LANDING_TOLERANCE:
            turned_text = f"{degrees_number(turned)} of {degrees_number(heading)} deg"
            failure = f"{_end_verb(maneuver)} with its heading turned by {turned_text}"
            return Verdict(False, failure, Fault.TURN)
    if failure := _landing_failure(metrics, maneuver):
        if maneuver.counts_turns and abs(remainder(angle, tau)) > LANDING_TOLERANCE:
            specified = degrees_number(angle)
            failure += f": a turn of {specified} deg does not end level, one of 360 deg does"
        return Verdict(False, failure, Fault.LANDING)
    return None


def landing_attitude(maneuver: Maneuver) -> tuple[float, float, float | None]:
    """Roll, pitch and heading specified for touchdown [rad]; None: any heading."""
    if maneuver.on_pivot or maneuver.end != End.ATTITUDE:
        return 0.0, 0.0, None
    attitude = maneuver.boundary().final_attitude
    roll, pitch = quaternions.tilt(attitude)
    return float(roll), float(pitch), float(quaternions.heading(attitude))


def lands_on_legs(maneuver: Maneuver) -> bool:
    """Whether a robot can stand in the attitude specified for touchdown."""
    roll, pitch, _ = landing_attitude(maneuver)
    return bool(np.cos(roll) * np.cos(pitch) >= np.cos(UPRIGHT_TILT))


def ends_at_any_attitude(maneuver: Maneuver) -> bool:
    """Whether a maneuver may end at any attitude, such as a turn that only has to stop."""
    return maneuver.end == End.AT_REST


def _landing_failure(metrics: Metrics, maneuver: Maneuver) -> str:
    """What is wrong with the attitude at touchdown; empty if it is level, or as specified."""
    if ends_at_any_attitude(maneuver):
        if metrics.touchdown_rate <= REST_RATE:
            return ""
        rate = np.degrees(metrics.touchdown_rate)
        return f"{_end_verb(maneuver)} at {_tilt(metrics)}, turning at {rate:.0f} deg/s"
    if attitude_error_at_touchdown(metrics, maneuver) <= LANDING_TOLERANCE:
        return ""
    roll, pitch, _ = landing_attitude(maneuver)
    if roll == pitch == 0.0:
        allowed = np.degrees(LANDING_TOLERANCE)
        return f"touches down at {_tilt(metrics)}, more than {allowed:.0f} deg off level"
    return f"{_end_verb(maneuver)} at {_tilt(metrics)}, not at {_angles(pitch, roll)}"


def _vertical(roll: FloatArray, pitch: FloatArray) -> FloatArray:
    """World's upward direction in B for angles as `quaternions.tilt` gives, shape (3, ...)."""
    return np.array([-np.sin(pitch) * np.cos(roll), np.sin(roll), np.cos(pitch) * np.cos(roll)])


def attitude_error_at_touchdown(metrics: Metrics, maneuver: Maneuver) -> float:
    """Attitude error at touchdown [rad]: larger of roll and pitch, or angle between the verticals.

    The verticals count unless a level landing is specified: a trunk on its side has no definite
    pitch.
    """
    ended = np.array([metrics.touchdown_roll]), np.array([metrics.touchdown_pitch])
    return float(attitude_errors(*ended, maneuver)[0])


def attitude_errors(roll: FloatArray, pitch: FloatArray, maneuver: Maneuver) -> FloatArray:
    """Attitude errors at n touchdowns with this roll and pitch [rad], shape (n,)."""
    specified_roll, specified_pitch, _ = landing_attitude(maneuver)
    if specified_roll == specified_pitch == 0.0:
        return np.maximum(np.abs(roll), np.abs(pitch))
    cosine = _vertical(np.array(specified_roll), np.array(specified_pitch)) @ _vertical(roll, pitch)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def tilt_errors(roll: FloatArray, pitch: FloatArray, maneuver: Maneuver) -> FloatArray:
    """Errors of roll and pitch at n touchdowns [rad], shape (2, n).

    They are about the trunk's own axes unless a level landing is specified: a pitch of -179 deg is
    1 deg off 180, and a trunk on its side has no definite pitch.
    """
    specified_roll, specified_pitch, _ = landing_attitude(maneuver)
    if specified_roll == specified_pitch == 0.0:
        return np.array([roll, pitch])
    specified = _vertical(
        np.full(roll.shape, specified_roll), np.full(pitch.shape, specified_pitch)
    )
    return -tilt_error(_vertical(roll, pitch).T, specified.T).T


def _end_verb(maneuver: Maneuver) -> str:
    return "touches down" if maneuver.gravity else "ends"


def _tilt(metrics: Metrics) -> str:
    return _angles(metrics.touchdown_pitch, metrics.touchdown_roll)


def _final_tilt(metrics: Metrics) -> str:
    return _angles(metrics.final_pitch, metrics.final_roll)


def _angles(pitch: float, roll: float) -> str:
    return f"pitch {degrees_number(pitch)}, roll {degrees_number(roll)} deg"
