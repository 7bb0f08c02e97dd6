"""The other construction of a wheel: a ring around the bell of an outrunner, bonded on.

No web, no hub, no joint on a shaft, and a flat module, as Mini Wheelbot has it with brass around an
MN4006 (github.com/wheelbot/Mini-Wheelbot, hardware/how-to-assemble-motors.md). A ring as tall as
the straight part of the bell stands nearer to the axis than a rim on a web, and is heavier:

    R^4 = r^4 + 2 I / (pi rho h),    m = 2 I / (R^2 + r^2).
"""

from dataclasses import dataclass
from math import pi

from ocs_design.actuation.motor import DIRECT, Face
from ocs_design.catalogue.materials import materials
from ocs_design.device.device import Device
from ocs_design.device.joints import top_speed
from ocs_design.parts.joints import OVERSPEED, SERVICE, Joint, Ring, TurningRings

GLUE_GAP = 0.1e-3
"""Gap between bell and ring [m]: what epoxy fills and a printed fixture keeps even."""

BELL_SHARE = 0.45
"""Straight part of a bell over its motor's length: 11 of the 25 mm of an MN5006."""

EPOXY_STRENGTH = 15e6
"""Shear strength of a bond of epoxy [Pa]: an assumption, half of the 30 MPa or so of overlap shear
that toughened epoxies such as 3M DP460 are sold with."""

BELL_DENSITY, BELL_MODULUS = 7850.0, 207e9
"""Density and modulus of bells, which are of steel [kg/m^3, Pa]."""


@dataclass(frozen=True)
class BellRing:
    """A ring around a bell, with the spin inertia of a wheel.

    Attributes:
        material: name in the catalogue.
        inner_radius, outer_radius, height: [m].
        mass: [kg].
        beyond: mass more than that of the wheel that it stands for [kg].
        shear: stress in the bond under the peak torque times `SERVICE` [Pa].
        opening: that ring and bell grow apart by at `OVERSPEED` times top speed [m]; None: elastic
            figures of the material are not known.
        stress: largest in the ring at that speed [Pa]; None likewise.
    """

    material: str
    inner_radius: float
    outer_radius: float
    height: float
    mass: float
    beyond: float
    shear: float
    opening: float | None
    stress: float | None

    @property
    def joint(self) -> Joint:
        """Bond of the ring on the bell."""
        note = f"epoxy under {SERVICE:g} x peak torque"
        if self.opening is not None:
            apart = f"{1e6 * self.opening:.2g} um"
            note += f"; ring and bell grow {apart} apart in {1e3 * GLUE_GAP:g} mm of it"
        return Joint("ring on the bell", self.shear, EPOXY_STRENGTH, "Pa", note)


def ring_size(
    spin_inertia: float, density: float, inner_radius: float, height: float
) -> tuple[float, float]:
    """Outer radius [m] and mass [kg] of a ring of that spin inertia [kg m^2]."""
    fourth = inner_radius**4 + 2.0 * spin_inertia / (pi * density * height)
    outer: float = fourth**0.25
    return outer, 2.0 * spin_inertia / (outer**2 + inner_radius**2)


def ring_on_bell(device: Device) -> BellRing | None:
    """Ring in place of each wheel; None: no bell turns outside, or its size is not known.

    Of the same material and spin inertia; housing and foot are not designed for it.
    """
    wheel, drive = device.flywheel, device.motor
    mounting, across, long = drive.mounting, drive.diameter, drive.length
    outside = mounting is not None and mounting.stator_face is Face.BACK
    if drive.gear != DIRECT.name or not outside or across is None or long is None:
        return None
    inner, height = across / 2.0 + GLUE_GAP, BELL_SHARE * long
    outer, mass = ring_size(wheel.spin_inertia - drive.rotor_inertia, wheel.density, inner, height)
    found, opening, stress = materials().get(wheel.material), None, None
    if found is not None and found.elastic_modulus is not None and found.poisson_ratio is not None:
        figures = (wheel.density, found.elastic_modulus, found.poisson_ratio)
        speed = OVERSPEED * top_speed(device)
        turning = TurningRings.of([Ring(inner, outer, height, *figures)], speed)
        # A thin ring grows by rho w^2 r^3 / E.
        bell = BELL_DENSITY * speed**2 * (across / 2.0) ** 3 / BELL_MODULUS
        opening, stress = turning.displacement(0, inner) - bell, turning.peak(0)
    return BellRing(
        material=wheel.material,
        inner_radius=inner,
        outer_radius=outer,
        height=height,
        mass=mass,
        beyond=mass - wheel.mass,
        shear=SERVICE * (drive.torque_limit or 0.0) / (2.0 * pi * inner**2 * height),
        opening=opening,
        stress=stress,
    )
