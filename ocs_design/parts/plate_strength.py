"""Strength and natural frequencies of a carrier plate, its mast and its posts.

The load is a shock of 20 g along any one axis, as for the printed parts. A plate has its own
screws, or is on a mast; `mass` is that of one module [kg], `height` that of its middle above the
plate [m].
"""

from math import hypot, inf, pi, sqrt
from typing import TypeAlias

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.parts.carrier_plate import ALUMINIUM, SAFETY, SHEAR_MODULUS, CarrierPlate
from ocs_design.parts.joints import TIGHTENING_FACTOR, pattern_use, screw_use
from ocs_design.parts.printed import SHOCK

_SECTIONS = 101
"""Number of sections between a screw and the middle of a foot at which stress is evaluated."""

Lengths: TypeAlias = float | FloatArray


def bending_stress(mass: float, arm: Lengths, width: Lengths, thickness: Lengths) -> FloatArray:
    """Stress in a plate that carries a mass as a cantilever, under `SHOCK` [Pa].

    M = m a L and sigma = 6 M / (w t^2): Roark's Formulas for Stress and Strain, 7th edition, table
    8.1, case 1a, with the section modulus of a rectangle.

    Args:
        mass: carried by it [kg].
        arm: from its support to the mass [m].
        width, thickness: of the section, minus its holes [m].
    """
    return np.asarray(6.0 * mass * SHOCK * arm / (width * thickness**2))


def twisting_stress(mass: float, arm: float, width: float, thickness: Lengths) -> FloatArray:
    """Shear stress in a plate that a mass above it twists, under `SHOCK` across its length [Pa].

    T = m a h, and tau = 3 T / (w t^2) (1 + 0.6095 q + 0.8865 q^2 - 1.8023 q^3 + 0.91 q^4), q = t/w:
    Roark's Formulas for Stress and Strain, 7th edition, table 10.1, case 4.

    Args:
        mass: carried by it [kg].
        arm: height of the mass above the plate [m].
        width, thickness: of the section, minus its holes; thickness is the smaller one [m].
    """
    q = thickness / width
    series = 1.0 + 0.6095 * q + 0.8865 * q**2 - 1.8023 * q**3 + 0.91 * q**4
    return np.asarray(3.0 * mass * SHOCK * arm / (width * thickness**2) * series)


def plate_stresses(
    plate: CarrierPlate, thicknesses: FloatArray, mass: float, height: float
) -> FloatArray:
    """Largest bending or twisting stress of a plate under `SHOCK` along any one axis [Pa].

    Loaded downwards, a module bends the plate between the trunk's outermost screws and itself;
    sideways it bends the neck, with its height as the arm; forward it twists the neck. Shear counts
    sqrt(3) times (von Mises). The ring under a foot is bent by the downward load only: the foot's
    base spreads the others.

    Args:
        plate: of any thickness. thicknesses: to evaluate [m], shape (n,), also that of the result.
        mass, height: of a module.
    """
    if len(plate.rows) > 1:
        # On a mast all plates are alike.
        distinct = plate.single_plates[:1] if plate.mast else plate.single_plates
        stresses = [plate_stresses(one, thicknesses, mass, height) for one in distinct]
        return np.asarray(np.max(stresses, axis=0))
    across = np.linspace(plate.support, plate.across, _SECTIONS)
    widths, arms = plate.net_width(across), plate.across - across
    down = bending_stress(mass, arms[:, None], widths[:, None], thicknesses).max(axis=0)
    narrow = float(widths[arms >= plate.window].min(initial=widths[0]))
    sideways = bending_stress(mass, height, narrow, thicknesses)
    forward = twisting_stress(mass, height, narrow, thicknesses)
    return np.asarray(np.maximum(np.maximum(down, sideways), sqrt(3.0) * forward))


def arm_stress(plate: CarrierPlate, mass: float, height: float) -> float:
    """Largest stress of a mast from its arms under `SHOCK`, wherever its screws are [Pa].

    A pair bends its arm, and twists it if pushed sideways; all arms bend or twist the upright.
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

    Besides `arm_stress`, masses above or below the screws bend the upright: forward, or sideways
    while the arms twist it.
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
    """Largest share of strength that `SHOCK` along any one axis uses in a mast's screws.

    See `pattern_use`. A push sideways also bends the sleeves between trunk and block, with half of
    their length as the arm. On a slope the preload pushes a formed block downhill. The block is one
    piece: the resultant of the slopes under its screws shears them all equally, and friction is not
    counted.
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
    """Largest share of strength that `SHOCK` along any one axis uses in a plate's screws.

    A push at the wheels' height shears all of them equally and pulls at each in proportion to its
    distance from their middle, M r / sum r^2; see `screw_use`. It bends their sleeves, whose ends
    cannot turn, with half the length of the longest as the arm, and compresses those on the other
    side.
    """
    if plate.mast is not None:
        return mast_screws_use(plate, mass, height)
    if len(plate.rows) > 1:
        return max(plate_screws_use(single, mass, height) for single in plate.single_plates)
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
    """Largest share of strength that `SHOCK` along any one axis uses in one pair's posts.

    The ends of four posts under a plate cannot turn: a push F sideways bends each by F / 4
    times half its length. Its moment about the middle of their length pulls at two and presses
    on two; see `pattern_use` for their screws. No joint may open: pull and bending must be less
    than the pressure of the screw's least preload, which is the full one over `TIGHTENING_FACTOR`.
    The full preload adds to the compression of a post.
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
    """First sideways mode of a pair on its sleeves, whose ends cannot turn [Hz].

    Four sleeves of length l bend, by l^3 / (48 E I), and let the plate turn about the middle of
    their length, as those on one side stretch and those on the other shorten: by the arm to there
    squared times l / (4 E (I + p^2 A)). The pair is a point mass.
    """
    if len(plate.rows) > 1:
        return min(plate_sway(single, mass, height) for single in plate.single_plates)
    gap, (area, _, second) = max(plate.sleeves), plate.sleeve_section
    arm, near = gap / 2.0 + plate.thickness + height, min(plate.half_pattern)
    turns = arm**2 * gap / (4.0 * (second + near**2 * area))
    compliance = (gap**3 / (48.0 * second) + turns) / ALUMINIUM.modulus
    return float(1.0 / np.sqrt(2.0 * mass * compliance) / (2.0 * pi)) if gap else inf


def plate_frequency(plate: CarrierPlate, mass: float) -> float:
    """First vertical mode of a module on its plate, with the trunk's screws fixed [Hz].

    Mohr's integral of the cantilever from the outermost screws to the middle of the foot, with
    sections by `net_width`; the module is a point mass, the plate is massless.
    """
    if len(plate.rows) > 1:
        return min(plate_frequency(single, mass) for single in plate.single_plates)
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
    """Rotation of the middle of a foot per moment, with the trunk's screws fixed [rad/(N m)].

    First about the horizontal across its arm, which bends the arm: the integral of 1 / (E I), as
    under a moment at the end of a cantilever (Roark's Formulas for Stress and Strain, 7th edition,
    table 8.1, case 3a). Then about the arm, which twists it: the integral of 1 / (G K), with K =
    w t^3 (1/3 - 0.21 t/w (1 - t^4 / 12 w^4)) of a rectangle (table 10.1, case 4). Both are over the
    sections of `net_width` from the outermost screws, or the arm of a mast, to the middle of the
    foot; the compliance of a mast is left out.
    """
    if len(plate.rows) > 1:
        bent, twisted = map(max, zip(*map(plate_tilt, plate.single_plates), strict=True))
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
