"""How sizes are written: millimetres without a unit, tolerances behind them."""

from collections.abc import Iterator
from math import isinf

from ocs_design.drawing.tolerances import Grade, plus_minus
from ocs_design.drawing.wheel import Seat, seat
from ocs_design.parts.wheel import HoleRing, Wheel


def plain(length: float) -> str:
    """A length [m] in mm with at most two decimals; the general tolerance holds."""
    return f"{1e3 * length:.2f}".rstrip("0").rstrip(".")


def toleranced(length: float, grade: Grade) -> str:
    """With half the width of a grade on both sides, as `82.60 ±0.04`."""
    return f"{1e3 * length:.2f} ±{1e3 * plus_minus(length, grade):.2f}"


def diameter(radius: float) -> str:
    """Of a radius [m]."""
    return f"Ø{plain(2.0 * radius)}"


def rim_diameter(wheel: Wheel) -> str:
    """Of the outside."""
    return f"Ø{toleranced(2.0 * wheel.rim.outer_radius, Grade.IT9)}"


def bore_diameter(wheel: Wheel) -> str:
    """Of the rim's inside; where it sits on a web, the fit of both."""
    if seat(wheel) is Seat.FITTED:
        return f"Ø{2e3 * wheel.rim.inner_radius:.2f} {Seat.FITTED.value}"
    return f"Ø{toleranced(2.0 * wheel.rim.inner_radius, Grade.IT9)}"


def diameters(wheel: Wheel) -> Iterator[tuple[str, float, float]]:
    """What is written of each turned diameter but the bore's, from the inside out.

    The label, the radius [m], and how wide the wheel is there along its axis [m].
    """
    if wheel.hub is not None:
        yield diameter(wheel.hub.radius), wheel.hub.radius, wheel.hub.height
    if wheel.rim.inner_radius > 0.0:
        yield bore_diameter(wheel), wheel.rim.inner_radius, wheel.rim.height
    yield rim_diameter(wheel), wheel.rim.outer_radius, wheel.rim.height


def holes(ring: HoleRing) -> tuple[str, ...]:
    """What is written of a ring of holes, line by line."""
    number = "" if ring.count == 1 else f"{ring.count} × "
    size, place = f"{number}{diameter(ring.hole_radius)}", f"on {diameter(ring.radius)} ±0.1"
    if isinf(ring.depth):
        return f"{size} through", place
    return size, place, f"{plain(ring.depth)} deep, both faces"
