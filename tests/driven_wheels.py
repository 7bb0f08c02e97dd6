"""Motors, gears and wheels for tests; only the EC 45 is a real product."""

from math import inf

from ocs_design.actuation.drive import DriveLine, drive_line
from ocs_design.actuation.motor import DIRECT, Gear, Motor
from ocs_design.actuation.supply import Supply
from ocs_design.catalogue.materials import Material
from ocs_design.sizing.driven_wheel import DrivenWheel

STEEL = Material(
    name="steel", density=8000.0, yield_strength=215e6, ultimate_strength=505e6,
    poisson_ratio=0.29, source="test",
)  # fmt: skip

EC45 = Motor(
    name="EC 45 flat 70 W",
    maker="maxon",
    mass=0.141,
    diameter=0.0428,
    length=0.0268,
    torque_constant=0.0369,
    resistance=0.608,
    rated_voltage=24.0,
    no_load_speed=639.8,
    speed_max=1047.2,
    peak_torque=1.0,
    peak_current=27.1,
    continuous_torque=0.128,
    rotor_inertia=1.81e-5,
    source="docs/theory.md",
    confidence="good",
)

EC45_LINE = DriveLine(stall_torque=1.4566, no_load_speed=650.4, torque_limit=1.0, speed_max=inf)
"""Torque-speed line of the EC 45 at 24 V, its drive limited to 1.0 N m (docs/theory.md)."""

BELT = Gear(
    name="belt 2:1",
    ratio=2.0,
    efficiency=0.9,
    mass=0.02,
    inertia=1e-6,
    motor_speed_max=900.0,
    wheel_speed_max=500.0,
    torque_max=2.0,
    reverses=False,
    source="test",
)


def driven_wheel(motor=EC45, gear=DIRECT, *, bus_voltage=24.0, material=STEEL):
    """The paper's rim with a motor and gear."""
    return DrivenWheel(
        inner_radius=0.022,
        outer_radius=0.030,
        height=0.010,
        material=material,
        motor=motor,
        gear=gear,
        line=drive_line(motor, gear, bus_voltage),
        supply=Supply(bus_voltage),
    )
