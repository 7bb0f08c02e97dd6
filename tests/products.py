"""Products of `size` for Solo12 with and without a motor, and their inertia in numpy alone."""

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from commands import Result

from ocs_design.parts.carrier_plate import CarrierPlate

MANEUVER_CHARTS = ("tilt", "rates", "wheel_speed", "wheel_torque")
FIGURES = [
    "bound_pitch",
    "bound_roll",
    "incidence_criterion",
    "incidence_posture",
    "inertia_ellipsoid",
    "momentum",
    "torque_speed",
    *(
        f"{kind}_{name}"
        for kind in MANEUVER_CHARTS
        for name in ("disturbance", "drop", "back-flip")
    ),
]

FILES = [
    *(f"figures/{name}.svg" for name in FIGURES),
    "cad/bill_of_materials.csv",
    "cad/flywheel.stl",
    "cad/wheel.svg",
    "cad/wheel.pdf",
    "cad/assembly.pdf",
    "cad/housing.3mf",
    *(f"cad/housing_{part}.stl" for part in ("drum", "lid", "foot")),
    "robot/README.md",
    "robot/scene.xml",
    "robot/solo12_ocs.glb",
    "robot/solo12_ocs.png",
    "robot/solo12_ocs.urdf",
    "robot/solo12_ocs.xml",
    "robot/meshes/ocs_flywheel.stl",
    "snippets/ocs.urdf.xacro",
    "snippets/ocs.urdf",
    "snippets/ocs_ros2_control.urdf",
    "snippets/ocs.xml",
    "snippets/ocs.sdf",
    "validation/disturbance_with_ocs.csv",
    "validation/disturbance_without_ocs.csv",
    "validation/drop_with_ocs.csv",
    "validation/drop_without_ocs.csv",
    "validation/back-flip_with_ocs.csv",
    "validation/back-flip_without_ocs.csv",
]


WITH_A_MOTOR = [
    "cad/drilling.pdf",
    "cad/housing_cage.stl",
    "cad/plate.pdf",
    "cad/plate.stl",
    "figures/reliability.svg",
    *(f"robot/meshes/ocs_{part}.stl" for part in ("housing", "foot", "cage", "plate")),
]
"""Further files for a real motor: the device is buildable and has a reliability."""


@dataclass(frozen=True)
class Case:
    """A command, and properties of its products.

    Attributes:
        options: of the command.
        headings: number of headings in its report.
        words: some words of its report.
        slack: relative tolerance of demands at a capacity.
        files: written beside the design and its report.
    """

    options: tuple[str, ...]
    headings: int
    words: tuple[str, ...]
    slack: float
    files: list[str]


CASES = {
    "motor": Case(("--ballistic",), 5, ("24 V", "housing"), 1e-5, [*FILES, *WITH_A_MOTOR]),
    "no motor": Case(
        ("--motor", "none", "--ballistic"), 4, ("7,200 rpm", "stainless"), 1e-9, FILES
    ),
}


@dataclass(frozen=True)
class Product:
    """Result of a command, its folder, and the peak memory of a new process [KiB]."""

    case: Case
    result: Result
    folder: Path
    peak: int | None = None


def device_of(document):
    """Wheel, carrier, motor, modules and plate as numbers, directly from the file."""
    ocs = document["ocs"]
    modules = [
        SimpleNamespace(name=m["name"], axis=np.array(m["axis"]), position=np.array(m["position"]))
        for m in ocs["modules"]
    ]
    parts = {name: SimpleNamespace(**ocs[name]) for name in ("flywheel", "carrier", "motor")}
    plate = None if ocs["plate"] is None else CarrierPlate(**ocs["plate"])
    return SimpleNamespace(modules=modules, plate=plate, **parts)


def parallel_axis(mass, offset):
    """Inertia added by the parallel axis theorem."""
    return mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))


def with_modules(document, device, incidence):
    """Robot, plate and both braked modules about their common centre of mass, in numpy alone."""
    robot, wheel = document["robot"], device.flywheel
    parts = [(robot["mass"], np.array(robot["com"]), np.array(robot["inertia"]))]
    for module, side in zip(device.modules, (1.0, -1.0), strict=True):
        axis = np.array([side * np.sin(incidence), np.cos(incidence), 0.0])
        across, along = np.eye(3) - np.outer(axis, axis), np.outer(axis, axis)
        # The rotor is already part of the motor's mass, and at rest with it.
        rim = wheel.spin_inertia - device.motor.rotor_inertia
        parts.append((wheel.mass, module.position, wheel.transverse_inertia * across + rim * along))
        carrier = device.carrier
        outward, up = side * axis, np.array([0.0, 0.0, 1.0])
        upright = carrier.vertical_inertia or carrier.transverse_inertia
        forward = np.cross(outward, up)
        own = (
            carrier.transverse_inertia * np.outer(forward, forward)
            + carrier.axial_inertia * along
            + upright * np.outer(up, up)
            + carrier.product_of_inertia * (np.outer(outward, up) + np.outer(up, outward))
        )
        place = module.position + carrier.along * outward + carrier.up * up
        parts.append((carrier.mass, place, own))
    if device.plate is not None:
        own = device.plate.own_mass_properties()
        parts.append((own.mass, own.com + np.array(device.plate.position), own.inertia))
    mass = sum(part[0] for part in parts)
    com = sum(part[0] * part[1] for part in parts) / mass
    return mass, com, sum(own + parallel_axis(m, c - com) for m, c, own in parts)


def coupling(inertia):
    """Magnitude of the pitch momentum per roll rate without momentum about yaw [kg m^2]."""
    return abs(inertia[0, 1] - inertia[0, 2] * inertia[1, 2] / inertia[2, 2])


def equal_rate(inertia):
    """The incidence at which one wheel speed changes roll and pitch by the same rate [rad]."""
    coupled = coupling(inertia)
    return np.arctan2(inertia[0, 0] - coupled, inertia[1, 1] - coupled)
