"""Balance of rigid rotors by quality grades (ISO 21940-11)."""

FLYWHEEL_GRADE = 6.3
"""G 6.3 [mm/s], what the standard's table gives for flywheels."""


def permissible_eccentricity(grade: float, speed: float) -> float:
    """Of the centre of mass from the axis, e_per = G / w [m].

    Args:
        grade: G, the speed of the centre of mass [mm/s], by which grades are named.
        speed: highest in service [rad/s].
    """
    return 1e-3 * grade / speed


def permissible_unbalance(mass: float, grade: float, speed: float) -> float:
    """U_per = e_per m [kg m], of a rotor of that mass [kg]."""
    return mass * permissible_eccentricity(grade, speed)
