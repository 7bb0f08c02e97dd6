"""What is to be minded about the figures of the chosen motor, and about what drives it."""

from collections.abc import Iterator

from ocs_design.design import Motor
from ocs_design.design_file import OcsDesign
from ocs_design.drive.gear import DIRECT
from ocs_design.export.bill_of_materials import controller_rating


def motor_notes(design: OcsDesign) -> Iterator[str]:
    """One sentence each; none where no motor was chosen."""
    motor = design.ocs.motor
    if motor.bus_voltage is None:
        return
    yield from _saturation(motor, _peak_torque(design))
    if motor.rotor_inertia == 0.0 and motor.gear == DIRECT.name:
        yield "rotor inertia is not known, taken for 0: wheels turn slower, never faster"
    rating = controller_rating(motor)
    if rating:
        yield f"not in the mass: cables, and two motor controllers, each for {rating}"


def _peak_torque(design: OcsDesign) -> float:
    """That the maneuvers ask of a wheel [N m]."""
    return max(
        (each.demand for each in design.margins if each.name.startswith("torque")), default=0
    )


def _saturation(motor: Motor, asked: float) -> Iterator[str]:
    starts = motor.saturation_torque
    if starts is not None and asked > starts:
        yield (
            f"{motor.name} saturates from {starts:.3g} N m at the wheel and is asked for "
            f"{asked:.3g}: it takes more current and voltage than its k_t says, and the margins of "
            "both are too good"
        )
