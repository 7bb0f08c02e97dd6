"""Fallbacks tried in turn where nothing meets the specification, and how they are reported.

Only unspecified values change, and only as far as the specified ones allow.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ocs_design.device.device import Device
from ocs_design.requirement.checks import contradictions
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.vocabulary import AUTO, LIGHTEST, MORE_PAIRS, RELIABILITY, WHEELS
from ocs_design.sizing.advice import advice_on
from ocs_design.sizing.limits import Progress
from ocs_design.sizing.on_robot import NoMountHolds
from ocs_design.sizing.selection.rejections import NO_ROOM, Refused

LOWER_RELIABILITIES = (0.9, 0.8)
"""Reliabilities that are tried in turn where no device has the default one."""


HEAVY_MOTORS = 0.2
"""Fraction of the robot's mass above which the motors' mass makes more wheels worth trying: four
motors of 1.7 kg may do what two of 7 kg do."""


@dataclass(frozen=True)
class Attempt:
    """A specification that was tried, and whose device, if any, was not taken.

    Attributes:
        specification: that was tried.
        reason: message of its refusal, or the mass of its device.
        error: the refusal; None: a lighter device was taken.
    """

    specification: Specification
    reason: str
    error: Refused | NoMountHolds | None = None


def attempts(specification: Specification) -> Iterator[Specification]:
    """The specification itself, then the fallbacks to try in turn where it is refused.

    Where neither layout nor incidence is specified, the lightest incidence and more pairs.
    """
    yield specification
    specified = specification.ocs
    if specified.layout is not None or specified.axes is not None:
        return
    free = specified.alpha is None and specified.alpha_criterion is None
    for layout in (None, *MORE_PAIRS):
        for criterion in (specified.alpha_criterion, LIGHTEST)[: 1 + free]:
            ocs = replace(specified, layout=layout, alpha_criterion=criterion)
            variant = replace(specification, ocs=ocs)
            if ocs != specified and not any(contradictions(variant)):
                yield variant


def with_lower_reliability(
    specification: Specification, tried: Sequence[Attempt]
) -> Iterator[Specification]:
    """Attempts that failed only because of their reserve, with a lower reliability.

    None where a reliability is specified.
    """
    if specification.requirement.reliability is not None:
        return
    lacking_reserve = [
        attempt.specification
        for attempt in tried
        if isinstance(attempt.error, Refused) and attempt.error.for_reserve
    ]
    for level in LOWER_RELIABILITIES:
        for variant in lacking_reserve:
            yield replace(variant, requirement=replace(variant.requirement, reliability=level))


def more_wheels_may_do(device: Device, robot_mass: float) -> bool:
    """Whether the motors are so heavy for the robot that more, smaller ones may be lighter."""
    return len(device.modules) * (device.motor.mass or 0.0) > HEAVY_MOTORS * robot_mass


def attempt_text(specification: Specification, variant: Specification) -> str:
    """What an attempt sizes, such as `a device of 4 wheels at its lightest incidence`."""
    layout, reliability = variant.ocs.layout, variant.requirement.reliability
    text = "the device"
    if layout is not None and layout != specification.ocs.layout:
        text = f"a device of {WHEELS[layout]} wheels"
    if variant.ocs.alpha_criterion != specification.ocs.alpha_criterion:
        text += " at its lightest incidence"
    if reliability is not None and reliability != specification.requirement.reliability:
        text += f" for {reliability:.0%} of robots"
    return text


def substitutions(
    specification: Specification, variant: Specification, tried: Sequence[Attempt]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Substitutes for unspecified values, and why: as assumptions, and as warnings."""
    assumptions: list[str] = []
    warnings: list[str] = []
    specified, layout, reliability = (
        specification.ocs.layout,
        variant.ocs.layout,
        variant.requirement.reliability,
    )
    if layout is not None and layout != specified:
        reason = next(
            attempt.reason for attempt in tried if attempt.specification.ocs.layout == specified
        )
        assumptions.append(f"Layout: {layout}, {WHEELS[layout]} wheels. With two: {reason}")
        if specification.motor.name not in {None, AUTO}:
            warnings.append(
                f"{WHEELS[layout]} wheels are used; the assumptions say why two are not"
            )
    criterion = specification.ocs.alpha_criterion
    if variant.ocs.alpha_criterion != criterion:
        at_alpha = replace(variant.ocs, alpha_criterion=criterion)
        refused = (attempt.reason for attempt in tried if attempt.specification.ocs == at_alpha)
        assumptions.append(f"Incidence: the lightest. At alpha*: {next(refused, tried[-1].reason)}")
    if reliability is not None and reliability != specification.requirement.reliability:
        reason = next(
            attempt.reason for attempt in tried if attempt.specification.ocs == variant.ocs
        )
        assumptions.append(
            f"Reliability: {reliability:.0%} of robots. For {RELIABILITY:.0%}: {reason}"
        )
        warnings.append(
            f"sized for {reliability:.0%} of robots: no device is feasible for {RELIABILITY:.0%}"
        )
    return tuple(assumptions), tuple(warnings)


def closest_refusal(tried: Sequence[Attempt], robot_mass: float) -> Refused:
    """The refusal on which advice is based.

    Where a wheel lacks room, it is that of the specification itself; where the motors are too weak,
    that of the attempt that came closest. An attempt that got as far as its mount, so that its
    robot is heavier than `robot_mass` [kg], came closer than one that no motor can drive even
    without a mount.

    Raises:
        NoMountHolds: the first refusal, where every attempt failed for want of a mount.
    """
    refused = [attempt.error for attempt in tried if isinstance(attempt.error, Refused)]
    if not refused:
        raise next(attempt.error for attempt in tried if attempt.error is not None)
    if refused[0].nearest.reason in NO_ROOM:
        return refused[0]
    mounted = [refusal for refusal in refused if refusal.problem.robot.mass > robot_mass]
    at_incidence = [refusal for refusal in refused if refusal.problem.incidence is not None]
    return min(
        mounted or at_incidence, key=lambda refusal: refusal.nearest.shortfall, default=refused[0]
    )


def advised(
    refusal: Refused, specification: Specification, tried: Sequence[Attempt], progress: Progress
) -> Refused:
    """The refusal, with the single changes that would help, where every attempt was refused."""
    refused = [attempt.error for attempt in tried if isinstance(attempt.error, Refused)]
    return advice_on(
        refusal,
        progress,
        default=specification.maneuvers_are_defaults,
        lightest=all(error.problem.incidence is not None for error in refused),
    )
