"""The one artefact: a designed orientation control system as a frozen value."""

from dataclasses import dataclass, replace

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.sizing.incidence import module_axes


@dataclass(frozen=True)
class Flywheel:
    """A hollow cylinder that spins about its z axis.

    Attributes:
        inner_radius, outer_radius, height: [m].
        material: name in the catalogue. density: [kg/m^3].
        mass: [kg].
        spin_inertia: about the spin axis, motor rotor included [kg m^2].
        transverse_inertia: about any axis across it through its centre of mass [kg m^2].
        hoop_stress: largest, at the bore, at the highest wheel speed [Pa].
        stress_margin: yield strength over hoop stress; None if the strength is not known.
        stored_energy: at the highest wheel speed [J].
    """

    inner_radius: float
    outer_radius: float
    height: float
    material: str
    density: float
    mass: float
    spin_inertia: float
    transverse_inertia: float
    hoop_stress: float | None
    stress_margin: float | None
    stored_energy: float


@dataclass(frozen=True, eq=False)
class Module:
    """One flywheel on the trunk.

    Attributes:
        name: "left" or "right".
        axis: unit spin axis in B, shape (3,).
        position: of the wheel's centre of mass in B [m], shape (3,).
    """

    name: str
    axis: FloatArray
    position: FloatArray


@dataclass(frozen=True)
class Motor:
    """What drives a wheel: the voltage line and the current limit, at the wheel.

    Attributes:
        name: in the catalogue, or "assumed".
        mass: [kg].
        stall_torque: torque of the voltage line at rest [N m]; None: not limited.
        no_load_speed: [rad/s].
        torque_limit: at the current limit [N m]; None: not limited.
        rotor_inertia: [kg m^2].
        source: where the figures come from.
    """

    name: str
    mass: float
    stall_torque: float | None
    no_load_speed: float
    torque_limit: float | None
    rotor_inertia: float
    source: str


@dataclass(frozen=True, eq=False)
class Device:
    """The orientation control system: two equal modules and what drives them.

    Attributes:
        incidence: angle between each wheel axis and the lateral direction y [rad].
        modules: left and right.
        flywheel: of each module.
        motor: of each module.
    """

    incidence: float
    modules: tuple[Module, Module]
    flywheel: Flywheel
    motor: Motor

    @property
    def axes(self) -> FloatArray:
        """Spin axes as columns, the matrix C of the paper, shape (3, 2)."""
        return np.column_stack([module.axis for module in self.modules])

    def at_incidence(self, incidence: float) -> "Device":
        """The same device with its modules turned by hand, as the paper does for its back-flip."""
        axes = module_axes(incidence)
        turned = [
            replace(module, axis=axis) for module, axis in zip(self.modules, axes.T, strict=True)
        ]
        return replace(self, incidence=incidence, modules=(turned[0], turned[1]))
