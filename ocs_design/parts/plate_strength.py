"""What a carrier plate, its mast and its posts bear, and at what they swing.

A shock of 20 g along any one axis counts, as it does for the printed parts. A plate has its screws,
or is on a mast; `mass` is that of one module [kg], `height` that of its middle above the plate [m].
"""

from math import hypot, inf, pi, sqrt
from typing import TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.parts.carrier_plate import (
    ALUMINIUM,
    SAFETY,
    SHEAR_MODULUS,
    CarrierPlate,
)
from ocs_design.parts.joints import TIGHTENING_FACTOR, pattern_use, screw_use
from ocs_design.parts.printed import SHOCK

_SECTIONS = 101
"""Sections between a screw and the middle of a foot whose stress is looked at."""

Lengths: TypeAlias = float | FloatArray


def bending_stress(mass: float, arm: Lengths, width: Lengths, thickness: Lengths) -> FloatArray:
    """Stress in a plate that carries a mass at the end of a cantilever, under `SHOCK` [Pa].

    M = m a L and sigma = 6 M / (w t^2): Roark's Formulas for Stress and Strain, 7th edition, table
    8.1, case 1a, with the section modulus of a rectangle.

    Args:
        mass: of what it carries [kg].
        arm: from its support to the mass [m].
        width, thickness: of the section, less its holes [m].
    """
    return np.asarray(6.0 * mass * SHOCK * arm / (width * thickness**2))


def twisting_stress(mass: float, arm: float, width: float, thickness: Lengths) -> FloatArray:
    """Shear stress in a plate that a mass above it twists, under `SHOCK` across its length [Pa].

    T = m a h, and tau = 3 T / (w t^2) (1 + 0.6095 q + 0.8865 q^2 - 1.8023 q^3 + 0.91 q^4), q = t/w:
    Roark's Formulas for Stress and Strain, 7th edition, table 10.1, case 4.

    Args:
        mass: of what it carries [kg].
        arm: of the mass above the plate [m].
        width, thickness: of the section, less its holes; the thickness is the lesser [m].
    """
    q = thickness / width
    series = 1.0 + 0.6095 * q + 0.8865 * q**2 - 1.8023 * q**3 + 0.91 * q**4
    return np.asarray(3.0 * mass * SHOCK * arm / (width * thickness**2) * series)


def plate_stresses(
    plate: CarrierPlate, thicknesses: FloatArray, mass: float, height: float
) -> FloatArray:
    """Largest stress of a plate under `SHOCK` along any one axis, of bending or twisting [Pa].

    Down, a module bends the plate between the trunk's outermost screws and itself; sideways it
    bends the neck by its height as an arm; forward it twists the neck. Shear counts sqrt(3)
    times (von Mises). The ring under a foot is bent by what is down alone: the foot's base
    spreads the rest.

    Args:
        plate: of any thickness. thicknesses: that it may have [m], shape (n,), as what is returned.
        mass, height: of a module.
    """
    if len(plate.rows) > 1:
        # On a mast they are alike.
        distinct = plate.each[:1] if plate.mast else plate.each
        each = [plate_stresses(one, thicknesses, mass, height) for one in distinct]
        found: FloatArray = np.max(each, axis=0)
        return found
    across = np.linspace(plate.support, plate.across, _SECTIONS)
    widths, arms = plate.net_width(across), plate.across - across
    down = bending_stress(mass, arms[:, None], widths[:, None], thicknesses).max(axis=0)
    narrow = float(widths[arms >= plate.window].min(initial=widths[0]))
    sideways = bending_stress(mass, height, narrow, thicknesses)
    forward = twisting_stress(mass, height, narrow, thicknesses)
    return np.asarray(np.maximum(np.maximum(down, sideways), sqrt(3.0) * forward))


def arm_stress(plate: CarrierPlate, mass: float, height: float) -> float:
    """Largest stress of a mast by its arms, wherever its screws are, under `SHOCK` [Pa].

    A pair bends its arm, and twists it where it is pushed sideways; all arms bend or twist the
    upright.
    """
    mast = plate.mast
    if mast is None:
        return 0.0
    force, up = 2.0 * mass * SHOCK, height + plate.thickness + mast.side / 2.0
    turned = force * len(plate.rows) * (mast.back + mast.side / 2.0)
    return max(
        mast.stress(force * max(mast.back, up), 0.0),
        mast.stress(force * mast.back, force * up),
        mast.stress(turned, 0.0),
    )


def mast_stress(plate: CarrierPlate, mass: float, height: float) -> float:
    """Largest stress of the mast under `SHOCK` along any one axis [Pa].

    Besides `arm_stress`, what is above or below the screws bends the upright, forward alone or
    sideways while the arms twist it.
    """
    mast = plate.mast
    if mast is None:
        return 0.0
    wheels = [level + plate.thickness + height for level in plate.heights]
    top, bottom = max(z for _, z in plate.trunk), min(z for _, z in plate.trunk)
    force = 2.0 * mass * SHOCK
    beyond = force * sum(max(z - top, bottom - z, 0.0) for z in wheels)
    turned = force * len(wheels) * (mast.back + mast.side / 2.0)
    return max(arm_stress(plate, mass, height), mast.stress(beyond, turned))


def mast_screws_use(plate: CarrierPlate, mass: float, height: float) -> float:
    """Largest share of strength that `SHOCK` along any one axis takes of a mast's screws.

    See `pattern_use`; a push sideways bends sleeves between trunk and block by half of their
    length as well. On a slope the preload pushes a formed block downhill. It is one piece: what the
    slopes under its screws leave of each other shears all alike, and friction is not counted.
    """
    if plate.mast is None:
        return 0.0
    force = 2.0 * mass * SHOCK * len(plate.rows)
    q, p = plate.half_pattern
    middle = float(np.mean(plate.trunk, axis=0)[1])
    up = abs(float(np.mean(plate.heights)) + plate.thickness + height - middle)
    gap, (_, section, _) = max(plate.sleeves), plate.sleeve_section
    off = plate.mast.face + plate.mast.spacer + max(plate.gaps)
    bent = force / 4.0 * (1.0 + up / hypot(p, q)) * gap / 2.0 / section
    downhill = plate.screw.preload * float(np.linalg.norm(plate.slopes.mean(axis=0)))
    arms, half = (off, np.asarray(up)), (np.asarray(p), np.asarray(q))
    used = float(pattern_use(plate.screw, force, arms, half, downhill))
    return max(used, bent / (ALUMINIUM.strength / SAFETY))


def plate_screws_use(plate: CarrierPlate, mass: float, height: float) -> float:
    """Largest share of strength that `SHOCK` along any one axis takes of a plate's screws.

    A push at the wheels' height shears all of them alike and pulls at each as far as it is off
    their middle, M r / sum r^2; see `screw_use`. It bends their sleeves, whose ends cannot turn, by
    half of the longest one's length, and presses on those of the other side.
    """
    if plate.mast is not None:
        return mast_screws_use(plate, mass, height)
    if len(plate.rows) > 1:
        return max(plate_screws_use(each, mass, height) for each in plate.each)
    if plate.on_posts:
        return posts_use(plate, mass, height)
    places = np.array(plate.trunk) - np.mean(plate.trunk, axis=0)
    share = plate.arms * mass * SHOCK / len(places)
    arm, off = max(plate.sleeves) + plate.thickness + height, np.abs(places).max(axis=0)
    pulled = share * len(places) * arm * off / (places**2).sum(axis=0)
    pushed = screw_use(plate.screw, pulled, np.full(2, share)).max()
    lifted = screw_use(plate.screw, np.asarray(share), np.asarray(0.0))
    gap, (area, section, _), bent = max(plate.sleeves), plate.sleeve_section, 0.0
    if gap > 0.0:
        bent = share * gap / 2.0 / section + float(pulled.max()) / area
    return max(float(pushed), float(lifted), bent / (ALUMINIUM.strength / SAFETY))


def posts_use(plate: CarrierPlate, mass: float, height: float) -> float:
    """Largest share of strength that `SHOCK` along any one axis takes of one pair's posts.

    The ends of four posts under a plate cannot turn: a push F sideways bends each by F / 4
    times half its length. Its moment about the middle of their length pulls at two and presses
    on two; see `pattern_use` for their screws. No joint opens: pull and bending are less than
    what the screw's least preload presses, which is less than the full one by
    `TIGHTENING_FACTOR`. The full one adds to what crushes a post.
    """
    force, gap, (p, q) = 2.0 * mass * SHOCK, max(plate.sleeves), plate.half_pattern
    arm, (area, section, _) = gap / 2.0 + plate.thickness + height, plate.sleeve_section
    arms, half = (arm, np.asarray(0.0)), (np.asarray(p), np.asarray(q))
    bent = force / 4.0 * (arm / min(p, q) / area + gap / 2.0 / section)
    most = plate.screw.preload / area
    least = most / TIGHTENING_FACTOR
    return max(
        float(pattern_use(plate.screw, force, arms, half)),
        bent / min(least, ALUMINIUM.strength / SAFETY),
        (bent + most) / ALUMINIUM.strength,
    )


def plate_sway(plate: CarrierPlate, mass: float, height: float) -> float:
    """First mode of a pair sideways on its sleeves, whose ends cannot turn [Hz].

    Four of length l bend, by l^3 / (48 E I), and turn the plate about the middle of their
    length, as those of one side become longer and those of the other shorter: by the arm to
    there squared times l / (4 E (I + p^2 A)). The pair is a point.
    """
    if len(plate.rows) > 1:
        return min(plate_sway(each, mass, height) for each in plate.each)
    gap, (area, _, second) = max(plate.sleeves), plate.sleeve_section
    arm, near = gap / 2.0 + plate.thickness + height, min(plate.half_pattern)
    turns = arm**2 * gap / (4.0 * (second + near**2 * area))
    compliance = (gap**3 / (48.0 * second) + turns) / ALUMINIUM.modulus
    return float(1.0 / np.sqrt(2.0 * mass * compliance) / (2.0 * pi)) if gap else inf


def plate_frequency(plate: CarrierPlate, mass: float) -> float:
    """First mode of a module up and down on its plate, the trunk's screws held [Hz].

    Mohr's integral of the cantilever from the outermost screws to the middle of the foot, whose
    sections are those of `net_width`; the module is a point, the plate weighs nothing.
    """
    if len(plate.rows) > 1:
        return min(plate_frequency(each, mass) for each in plate.each)
    start = plate.support
    across = np.linspace(start, plate.across, _SECTIONS)
    second = plate.net_width(across) * plate.thickness**3 / 12.0
    arms = plate.across - across
    compliance = float(np.trapezoid(arms**2 / (ALUMINIUM.modulus * second), across))
    if plate.mast is not None:
        # The arm carries both: it bends, and turns the upright above or below its screws.
        arm, above = plate.mast.back, plate.mast.overhang
        bends = arm**3 / 3.0 + (arm + plate.mast.side / 2.0) ** 2 * above
        compliance += 2.0 * bends / (ALUMINIUM.modulus * plate.mast.second_moment)
    return float(1.0 / np.sqrt(compliance * mass) / (2.0 * pi))


def plate_tilt(plate: CarrierPlate) -> tuple[float, float]:
    """Turn of the middle of a foot under a moment, the trunk's screws held [rad/(N m)].

    First about the horizontal across its arm, which bends the arm: the integral of 1 / (E I), as
    under a moment at the end of a cantilever (Roark's Formulas for Stress and Strain, 7th edition,
    table 8.1, case 3a). Then about the arm, which twists it: that of 1 / (G K), K = w t^3 (1/3 -
    0.21 t/w (1 - t^4 / 12 w^4)) of a rectangle (table 10.1, case 4). Both over the sections of
    `net_width` from the outermost screws, or the arm of a mast, to the middle of the foot; what a
    mast gives is left out.
    """
    if len(plate.rows) > 1:
        bent, twisted = map(max, zip(*map(plate_tilt, plate.each), strict=True))
        return bent, twisted
    across = np.linspace(plate.support, plate.across, _SECTIONS)
    widths = plate.net_width(across)
    least, most = np.minimum(widths, plate.thickness), np.maximum(widths, plate.thickness)
    q = least / most
    torsion = most * least**3 * (1.0 / 3.0 - 0.21 * q * (1.0 - q**4 / 12.0))
    bending = widths * plate.thickness**3 / 12.0
    return (
        float(np.trapezoid(1.0 / (ALUMINIUM.modulus * bending), across)),
        float(np.trapezoid(1.0 / (SHEAR_MODULUS * torsion), across)),
    )
