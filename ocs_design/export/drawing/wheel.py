"""Content of a wheel's drawing, SI: mass, inertia, balance, and sizes with their tolerances.

Tolerances of sizes are those of ISO 286-1, table 1; balance is that of rigid rotors, ISO 21940-11.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isinf, pi

from ocs_design.parts.joints import Grade, tolerance_width
from ocs_design.parts.rim import NO_CUTS, HoleRing, RimCuts
from ocs_design.parts.solids import total
from ocs_design.parts.wheel import Wheel, wheel_parts
from ocs_design.robot.mass import MassProperties

BROKEN_EDGE = 0.2e-3
"""Width of edges without indication, broken at 45 degrees [m]."""

INSIDE_CORNER = 0.4e-3
"""Maximum radius of a wheel's inside corners [m]: nose of the usual turning insert (ISO 1832, 04).
"""


@dataclass(frozen=True)
class WheelDrawing:
    """A wheel with the entries of its title block.

    Attributes:
        wheel: the wheel as made.
        robot: name of the robot that it is made for.
        identity: identifier of the design, such as the beginning of its hash.
        speed: highest speed in service [rad/s]; None: not limited.
        interference: smallest and largest interference of a shrunk-on rim on the diameter [m];
            None: there is none, or it is not known.
        bonded: whether it is a ring around the bell of its motor.
        on_shaft: whether the motor's shaft, which the hub's bore fits, is known.
        yield_strength: yield strength of the rim's material used in sizing [Pa]; None: not known.
        order: designation, condition and standard of that material; empty: not known.
        refused: that the device cannot be built, and why; empty if nothing known prevents it.
        count: number of equal wheels.
    """

    wheel: Wheel
    robot: str
    identity: str
    speed: float | None
    interference: tuple[float, float] | None = None
    bonded: bool = False
    on_shaft: bool = False
    yield_strength: float | None = None
    order: str = ""
    refused: str = ""
    count: int = 1

    @cached_property
    def masses(self) -> tuple[float, ...]:
        """Mass of each piece, the rim first [kg]."""
        return tuple(part.mass_properties().mass for part in wheel_parts(self.wheel))

    @cached_property
    def mass_properties(self) -> MassProperties:
        """Mass properties of the whole wheel, without the motor's rotor."""
        return total(wheel_parts(self.wheel))


def plus_minus(size: float, grade: Grade) -> float:
    """Half the tolerance width [m], rounded down to 0.01 mm, but at least 0.01 mm."""
    return 1e-5 * max(1.0, (1e5 * tolerance_width(size, grade) / 2.0 + 1e-9) // 1.0)


def broken_edge_losses(wheel: Wheel) -> tuple[float, float]:
    """Mass that is removed by breaking the rim's sharp edges [kg], and its share of the inertia."""
    sharp, broken = (
        total(wheel_parts(Wheel(replace(wheel.rim, cuts=cuts))))
        for cuts in (NO_CUTS, RimCuts(BROKEN_EDGE))
    )
    wheel_inertia = total(wheel_parts(wheel)).inertia[2, 2]
    return sharp.mass - broken.mass, float((sharp.inertia - broken.inertia)[2, 2] / wheel_inertia)


def inside_corners(wheel: Wheel) -> tuple[float, float]:
    """Largest radius of the web's inside corners at rim and hub [m], and their inertia's share.

    The fillet that a radius R leaves in a corner at r from the axis has a cross-section of
    (1 - pi / 4) R^2, with its centroid at 0.223 R from both sides, (10 - 3 pi) / (12 - 3 pi). Its
    inertia is that of a thin ring. Both are 0 if rim and hub are no taller than the web.
    """
    web, rim = wheel.web, wheel.rim
    if web is None:
        return 0.0, 0.0
    # Inward from the rim's bore, outward from the hub.
    sides = [(web.hub.height, web.hub.radius, 1.0)]
    if not wheel.shrunk_on:
        sides.append((rim.height, rim.inner_radius, -1.0))
    steps = [(height - web.thickness) / 2.0 for height, _, _ in sides]
    radius = min([INSIDE_CORNER, *(step for step in steps if step > 0.0)])
    area, centroid = (1.0 - pi / 4.0) * radius**2, (10.0 - 3.0 * pi) / (12.0 - 3.0 * pi) * radius
    cornered = (side for side, step in zip(sides, steps, strict=True) if step > 0.0)
    rings = [at + outward * centroid for _, at, outward in cornered]
    added = sum(2.0 * web.density * area * 2.0 * pi * ring**3 for ring in rings)
    return (radius if rings else 0.0), added / float(total(wheel_parts(wheel)).inertia[2, 2])


WORKSHOP_STEP = 0.5e-3
"""Step of the diameters that a workshop drills or mills without being asked twice [m]."""


def workshop_holes(wheel: Wheel) -> tuple[float, float]:
    """Diameter of the lightening holes in whole steps [m], and its change of the inertia's share.

    Each hole takes pi rho t a^2 (c^2 + a^2 / 2) from the inertia. Both are 0 without holes.
    """
    web = wheel.web
    if web is None or web.holes is None:
        return 0.0, 0.0
    drawn, circle = web.holes.hole_radius, web.holes.circle_radius
    diameter = WORKSHOP_STEP * round(2.0 * drawn / WORKSHOP_STEP)
    before, after = (a**2 * (circle**2 + a**2 / 2.0) for a in (drawn, diameter / 2.0))
    less = web.holes.count * pi * web.density * web.thickness * (after - before)
    return diameter, -less / float(total(wheel_parts(wheel)).inertia[2, 2])


GENERAL_TOLERANCES = {6e-3: 0.1e-3, 30e-3: 0.2e-3, 120e-3: 0.3e-3, 400e-3: 0.5e-3, inf: 0.8e-3}
"""Upper limits of size and their permissible deviations, class m of ISO 2768-1 [m]; sizes above 1 m
have the last one."""

WEB_GRADE = Grade.IT12
"""Grade of the web's thickness: the web yields under the tool, and has a quarter of the inertia."""


def general_tolerance(size: float) -> float:
    """Permissible deviation of a size without tolerance, ISO 2768-m [m]."""
    return next(error for largest, error in GENERAL_TOLERANCES.items() if size <= largest)


def inertia_error(wheel: Wheel) -> float:
    """Largest relative error of the wheel's spin inertia within the tolerances of its sizes.

    To first order in I = pi rho h (R^4 - r^4) / 2 of rim, web and hub, with all deviations in the
    same direction, and with the lightening holes, each of which removes pi rho t a^2
    (c^2 + a^2 / 2).
    """
    r, R, h = wheel.rim.inner_radius, wheel.rim.outer_radius, wheel.rim.height
    rho, web = wheel.rim.density, wheel.web
    outer, inner = (plus_minus(2.0 * radius, Grade.IT9) / 2.0 for radius in (R, r))
    if wheel.shrunk_on:
        inner = tolerance_width(2.0 * r, Grade.IT7) / 2.0
    # A larger bore removes material from the rim and adds some to the web.
    at_bore = rho * h - (0.0 if web is None else web.density * web.thickness)
    error = 2.0 * pi * (rho * h * R**3 * outer + abs(at_bore) * r**3 * inner)
    error += pi * rho * (R**4 - r**4) / 2.0 * plus_minus(h, Grade.IT11)
    if web is not None:
        hub, holes, thickness = web.hub, web.holes, web.thickness
        disc_moment = pi * (r**4 - hub.radius**4) / 2.0
        if holes is not None:
            a, c = holes.hole_radius, holes.circle_radius
            disc_moment -= holes.count * pi * a**2 * (c**2 + a**2 / 2.0)
            deviation = general_tolerance(2.0 * a) / 2.0
            error += (
                web.density * thickness * holes.count * 2.0 * pi * a * (c**2 + a**2) * deviation
            )
        error += web.density * disc_moment * plus_minus(thickness, WEB_GRADE)
        deviation = general_tolerance(2.0 * hub.radius) / 2.0
        error += web.density * (hub.height - thickness) * 2.0 * pi * hub.radius**3 * deviation
        hub_moment = pi * (hub.radius**4 - hub.bore_radius**4) / 2.0
        error += web.density * hub_moment * general_tolerance(hub.height)
    return error / float(total(wheel_parts(wheel)).inertia[2, 2])


def in_mm(length: float) -> str:
    """Label of a length [m] in mm with at most two decimals; the general tolerance applies."""
    return f"{1e3 * length:.2f}".rstrip("0").rstrip(".")


def toleranced(length: float, grade: Grade) -> str:
    """Label of a length [m] with half the width of a grade on both sides, as `82.60 ±0.04`."""
    return f"{1e3 * length:.2f} ±{1e3 * plus_minus(length, grade):.2f}"


def diameter_label(radius: float) -> str:
    """Label of the diameter of a radius [m]."""
    return f"Ø{in_mm(2.0 * radius)}"


def fitted_bore_label(radius: float) -> str:
    """Label of the hub's bore with the upper and lower deviation of H7 [mm]."""
    return f"{diameter_label(radius)} H7 (0/+{1e3 * tolerance_width(2.0 * radius, Grade.IT7):.3f})"


def rim_diameter_label(wheel: Wheel) -> str:
    """Label of the rim's outer diameter."""
    return f"Ø{toleranced(2.0 * wheel.rim.outer_radius, Grade.IT9)}"


def bore_diameter_label(wheel: Wheel) -> str:
    """Label of the rim's inner diameter; if the rim is on a separate web, with the fit."""
    if wheel.shrunk_on:
        return f"Ø{2e3 * wheel.rim.inner_radius:.2f} shrink fit"
    return f"Ø{toleranced(2.0 * wheel.rim.inner_radius, Grade.IT9)}"


def seat_limits(drawing: WheelDrawing) -> tuple[str, str]:
    """Limits of the rim's bore and of the web, each after a comma [mm]; empty if not known.

    The bore's lower limit is the nominal size, the web is larger by the interference, and both have
    the same grade.
    """
    if drawing.interference is None:
        return "", ""
    least, most = drawing.interference
    # Rounded like the label of the size.
    bore, width = round(2.0 * drawing.wheel.rim.inner_radius, 5), (most - least) / 2.0
    limits = (bore, bore + width), (bore + most - width, bore + most)
    (r, R), (w, W) = ((f"{1e3 * low:.3f}", f"{1e3 * high:.3f}") for low, high in limits)
    return f", bore Ø{r} to {R}", f", Ø{w} to {W}"


def diameters(wheel: Wheel) -> Iterator[tuple[str, float, float]]:
    """Turned diameters except the hub's bore, from the inside out.

    Yields the label, the radius [m], and the extent along the axis there [m].
    """
    rim = wheel.rim
    if wheel.web is not None:
        hub = wheel.web.hub
        yield diameter_label(hub.radius), hub.radius, hub.height
    if rim.inner_radius > 0.0:
        yield bore_diameter_label(wheel), rim.inner_radius, rim.height
    yield rim_diameter_label(wheel), rim.outer_radius, rim.height


def hole_label(ring: HoleRing, depth: float) -> tuple[str, ...]:
    """Label of a ring of holes of this depth [m], line by line; inf: through."""
    count = "" if ring.count == 1 else f"{ring.count} × "
    size = f"{count}{diameter_label(ring.hole_radius)}"
    evenly = "evenly on" if ring.count > 1 else "on"
    place = f"{evenly} {diameter_label(ring.circle_radius)} ±0.1"
    if isinf(depth):
        return f"{size} through", place
    return size, place, f"{in_mm(depth)} deep, both faces"
