"""How tight screws may be, and how deep their threads go."""

from dataclasses import dataclass
from math import pi, sqrt

from ocs_design.actuation.fasteners import IN_PLASTIC, Fastening
from ocs_design.parts.joints import preload as joint_preload
from ocs_design.parts.joints import tightening_torque
from ocs_design.parts.printed import STRENGTH

STRIP_SHARE = 1.0 / 3.0
"""Preload of a screw in a print over the one that strips its thread: prints shear along layers, and
creep."""

PRESSURE_SHARE = 0.5
"""Pressure under a head on a print over its yield strength: it creeps little then."""


ALUMINIUM_SHEAR = 207e6
"""Shear strength of 6061-T6 [Pa] (ASM), for motors' bells and trunks whose alloy is not known."""

THREAD_SHARE = 0.5
"""Preload of a screw in aluminium over the one that strips its thread."""


@dataclass(frozen=True)
class Tightened:
    """Screws with the torque to tighten them with.

    Attributes:
        fastening: what they are.
        torque: [N m].
        rule: what limits it.
        engagement: length of thread that holds, at least [m].
        on_print: whether their heads press on a print, and they go through it.
    """

    fastening: Fastening
    torque: float
    rule: str
    engagement: float
    on_print: bool = False


def tightened(fastening: Fastening, *, on_metal: bool, head_on_print: bool = True) -> Tightened:
    """Torque of screws.

    Those of the wheel as their joint is computed (`parts.joints`). Others, of class 8.8, with the
    least of: 90 % of the screw's yield strength (VDI 2230); half of the force that shears off a
    thread in aluminium, or a third of it in a print, on half of the thread's cylinder; under a head
    on a print, half the print's yield strength as pressure. A print's shear strength is its tensile
    one over sqrt(3).

    Args:
        fastening: what they are.
        on_metal: whether they hold the wheel, metal on metal.
        head_on_print: whether their heads press on a print, not on metal.
    """
    screw, engagement = fastening.screw, fastening.length - fastening.thickness
    sheared = pi * screw.diameter * engagement / 2.0
    if on_metal:
        strength = fastening.strength
        share = joint_preload(screw, strength) / (sheared * ALUMINIUM_SHEAR)
        rule = f"the joint, as computed; {share:.0%} of what strips a thread in 6061-T6"
        return Tightened(fastening, tightening_torque(screw, strength), rule, engagement)
    limits = [(screw.preload, "class 8.8 at 90 % of yield (VDI 2230, friction 0.12)")]
    if head_on_print:
        pressed = PRESSURE_SHARE * STRENGTH * screw.head_area
        limits.append((pressed, "head on PETG at half its yield strength"))
    if fastening.depth >= IN_PLASTIC:
        stripped = STRIP_SHARE * sheared * STRENGTH / sqrt(3.0)
        limits.append((stripped, "thread in PETG at a third of what strips it"))
    else:
        stripped = THREAD_SHARE * sheared * ALUMINIUM_SHEAR
        limits.append((stripped, "thread in aluminium at half of what strips it"))
    preload, rule = min(limits)
    return Tightened(fastening, screw.torque(preload), rule, engagement, head_on_print)
