"""The question that `solve_rim` answers: the lightest hollow cylinder of a given spin inertia."""

from dataclasses import dataclass

from ocs_design.arrays import FloatArray
from ocs_design.catalogue.materials import Material
from ocs_design.exceptions import UsageError
from ocs_design.requirement.envelope import Envelope
from ocs_design.sizing.rim_cuts import NO_CUTS, RimCuts


@dataclass(frozen=True, eq=False)
class RimLimits:
    """Everything that bounds a rim, as plain numbers: scalars, or arrays that broadcast.

    Attributes:
        density: [kg/m^3].
        outer_radius_max, inner_radius_min, height_max, height_min, wall_min: [m].
        mass_max: [kg].
        stretch_max: largest (3 + nu) R^2 + (1 - nu) r^2 that the allowed hoop stress admits, which
            is 4 sigma / (rho w^2) [m^2]; inf: not limited.
        poisson_ratio: nu; of no account where the hoop stress is not limited.
        web: thickness of a disc of the rim's material that weighs as much as the web, which fills
            the bore [m]; 0: massless spokes.
        outer_radius_min: that leaves room for a motor's mount [m]; 0: any.
        cuts: chamfers and holes, the same of all; the other limits leave room for them.
    """

    density: float | FloatArray
    outer_radius_max: float | FloatArray
    inner_radius_min: float | FloatArray
    height_max: float | FloatArray
    height_min: float | FloatArray
    wall_min: float | FloatArray
    mass_max: float | FloatArray
    stretch_max: float | FloatArray
    poisson_ratio: float | FloatArray
    web: float | FloatArray = 0.0
    outer_radius_min: float | FloatArray = 0.0
    cuts: RimCuts = NO_CUTS


@dataclass(frozen=True)
class RimProblem:
    """Find the lightest rim of this spin inertia, met with equality.

    Attributes:
        spin_inertia: of one wheel [kg m^2].
        envelope: the room that it may take.
        material: what it is made of.
        wheel_speed: highest, at which the hoop stress is limited [rad/s].
    """

    spin_inertia: float
    envelope: Envelope
    material: Material
    wheel_speed: float

    @property
    def hoop_stress_max(self) -> float:
        """Yield strength over the safety [Pa]; inf if the material's figures are not known."""
        strength, safety = self.material.yield_strength, self.envelope.stress_safety
        if strength is None or self.material.poisson_ratio is None or safety == 0.0:
            return float("inf")
        return strength / safety

    @property
    def stretch_max(self) -> float:
        """See `RimLimits` [m^2]."""
        return 4.0 * self.hoop_stress_max / (self.material.density * self.wheel_speed**2)

    @property
    def limits(self) -> RimLimits:
        """The same bounds as plain numbers."""
        room = self.envelope
        return RimLimits(
            density=self.material.density,
            outer_radius_max=room.outer_radius_max,
            inner_radius_min=room.inner_radius_min,
            height_max=room.height_max,
            height_min=room.height_min,
            wall_min=room.wall_min,
            mass_max=room.mass_max,
            stretch_max=self.stretch_max,
            poisson_ratio=self.material.poisson_ratio or 0.0,
        )


def build_rim_problem(
    spin_inertia: float, envelope: Envelope, material: Material, wheel_speed: float
) -> RimProblem:
    """The problem, checked to be a question at all; `solve_rim` finds out if it has an answer.

    Args:
        spin_inertia: of one wheel [kg m^2], positive.
        envelope: limits of the rim.
        material: density and, for the limit of hoop stress, yield strength and Poisson's ratio.
        wheel_speed: highest speed of the wheel relative to the trunk [rad/s], positive.

    Raises:
        UsageError: a number is not positive where it must be, or not finite.
    """
    _require_positive("the spin inertia", spin_inertia)
    check_limits(envelope, material, wheel_speed)
    return RimProblem(spin_inertia, envelope, material, wheel_speed)


def check_limits(envelope: Envelope, material: Material, wheel_speed: float) -> None:
    """Refuse limits that are no limits; see `build_rim_problem`.

    Raises:
        UsageError: a number is not positive where it must be, or not finite.
    """
    _require_positive("wheel_speed_max", wheel_speed)
    _require_positive("the density", material.density)
    for name in ("outer_radius_max", "height_max", "stress_safety"):
        _require_positive(name, getattr(envelope, name))
    for name in ("inner_radius_min", "height_min", "wall_min", "mass_max"):
        value = getattr(envelope, name)
        # An infinite mass is a mass without limit; NaN is neither.
        if not value >= 0.0:
            raise UsageError(f"{name} is {value:g}; it must not be negative")


def _require_positive(name: str, value: float) -> None:
    if not 0.0 < value < float("inf"):
        raise UsageError(f"{name} is {value:g}; it must be positive and finite")
