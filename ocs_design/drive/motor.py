"""An electric motor as its data sheet gives it, in one convention."""

from dataclasses import dataclass

from ocs_design.drive.mounting import Mounting


@dataclass(frozen=True)
class Motor:
    """A brushless motor, as one equivalent DC motor: `V = R i + k_t w` (docs/theory.md, The motor).

    None is what its source does not give.

    Attributes:
        name: in the catalogue, unique. maker: of the motor.
        mass: [kg]. diameter, length: of its body [m].
        torque_constant: k_t, torque per current and voltage per speed between two lines (six-step
            commutation) [N m/A].
        resistance: between two lines [ohm].
        rated_voltage: at which the figures hold, or the highest of the maker's range [V].
        no_load_speed: stated, at the rated voltage [rad/s].
        speed_max: highest that bearings and rotor stand, if stated [rad/s].
        peak_torque: at the highest short-term current [N m].
        peak_current: of the supply line, in the same convention [A].
        continuous_torque: that the winding stands for good [N m].
        rotor_inertia: [kg m^2].
        source: where the figures come from. confidence: good, second-hand, ...
        peak_basis: what `peak_torque` rests on: the maker's peak torque, k_t times its peak
            current, or the stall torque of its data sheet.
        remark: what a reader of the figures must know.
        mounting: shaft and threads, if any of them is known.
        no_load_current: that it draws turning freely, at the rated voltage [A].
        saturation_torque: above which k_t falls off [N m]; no bound on the torque, for the maker's
            peak torque is measured with it.
    """

    name: str
    maker: str
    mass: float | None
    diameter: float | None
    length: float | None
    torque_constant: float | None
    resistance: float | None
    rated_voltage: float | None
    no_load_speed: float | None
    speed_max: float | None
    peak_torque: float | None
    peak_current: float | None
    continuous_torque: float | None
    rotor_inertia: float | None
    source: str
    confidence: str
    peak_basis: str = ""
    remark: str = ""
    mounting: Mounting | None = None
    no_load_current: float | None = None
    saturation_torque: float | None = None
