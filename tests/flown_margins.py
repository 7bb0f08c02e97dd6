"""Margins computed from files alone: design.json, time series and the catalogues.

No code of the package is used. Torques are constant from each sample to the next.
"""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

CATALOGUE = Path(__file__).parents[1] / "ocs_design" / "catalogue"


def catalogue_row(file, name):
    """Row of a catalogue by its name, as text."""
    with (CATALOGUE / file).open(newline="", encoding="utf-8") as stream:
        return next(row for row in csv.DictReader(stream) if row["name"] == name)


@dataclass
class FlownMargins:
    """Largest values over the time series of all flights with the device."""

    folder: Path

    def __post_init__(self):
        self.design = json.loads((self.folder / "design.json").read_text())
        self.motor = self.design["ocs"]["motor"]
        self.tables = [
            _table(path) for path in sorted(self.folder.glob("validation/*_with_ocs.csv"))
        ]

    @property
    def gain(self):
        """Torque at the wheel per ampere [N m/A]."""
        motor = self.motor
        return motor["gear_ratio"] * motor["gear_efficiency"] * motor["torque_constant"]

    @property
    def idle(self):
        """No-load current [A]."""
        return self.motor["no_load_current"] or 0.0

    def peak(self, quantity):
        """Largest value over all flights of a function of (torque, speed), each of shape (k, 2)."""
        return max(float(np.max(quantity(*piecewise(table)))) for table in self.tables)

    def power(self, torque, speed, idle):
        """Power of both motors at the bus [W]."""
        motor, current = self.motor, np.abs(torque) / self.gain + idle
        shaft = torque * speed
        efficiency = motor["gear_efficiency"]
        mechanical = np.where(shaft > 0.0, shaft / efficiency, shaft * efficiency)
        friction = motor["torque_constant"] * idle * motor["gear_ratio"] * np.abs(speed)
        return (motor["resistance"] * current**2 + mechanical + friction).sum(axis=1)

    def demands(self):
        """Demands that follow from speeds and torques, by the name of the margin."""
        ratio, volts = self.motor["gear_ratio"], self.motor["bus_voltage"]
        drawn_power = self.peak(lambda torque, speed: self.power(torque, speed, self.idle))
        fed_back_power = self.peak(lambda torque, speed: -self.power(torque, speed, 0.0))
        inertia = self.design["ocs"]["spin_inertia"] + self.motor["armature"]
        friction = self.gain * self.idle
        return {
            "wheel speed": self.peak(lambda _, speed: np.abs(speed)),
            "motor speed": ratio * self.peak(lambda _, speed: np.abs(speed)),
            "motor torque": self.peak(lambda torque, _: np.abs(torque)) + friction,
            "bus current": drawn_power / volts,
            "bus power": drawn_power,
            "bus current, fed back": fed_back_power / volts,
            "bus power, fed back": fed_back_power,
            "voltage line": self.peak(
                lambda torque, speed: np.abs(
                    speed / self.motor["no_load_speed"]
                    + (torque + friction * np.sign(speed)) / self.motor["stall_torque"]
                )
            ),
            "stored energy": self.peak(lambda _, speed: 0.5 * inertia * (speed**2).sum(axis=1)),
            "winding heat": max(map(self.heat, self.tables)),
            "bearing moment": max(map(self.bearing_moment, self.tables)),
        }

    def heat(self, table):
        """R times the integral of i^2 for the motor with the higher load [J]."""
        torque, speed, time = table["torque"][:-1], table["speed"][:-1], table["time"]
        runs = (torque != 0.0) | (speed != 0.0)
        current = np.abs(torque) / self.gain + self.idle * runs
        return self.motor["resistance"] * float(np.max(np.diff(time) @ current**2))

    def bearing_moment(self, table):
        """Largest component across the axis of dH/dt of a wheel in the inertial frame [N m]."""
        ocs, rate = self.design["ocs"], table["rate"]
        acceleration = np.diff(rate, axis=0) / np.diff(table["time"])[:, None]
        across, along = ocs["flywheel"]["transverse_inertia"], ocs["flywheel"]["spin_inertia"]
        rotor = self.motor["rotor_inertia"] / self.motor["gear_ratio"]
        moments = []
        # In some maneuvers the modules have an incidence of their own.
        (maneuver_angle,) = (
            each["incidence"]
            for each in self.design["requirement"]["maneuvers"]
            if table["file"].startswith(each["name"].replace(" ", "_"))
        )
        angle = ocs["incidence"] if maneuver_angle is None else maneuver_angle
        for side, speed in zip((1.0, -1.0), table["speed"].T, strict=True):
            axis = np.array([side * np.sin(angle), np.cos(angle), 0.0])
            for end in (slice(None, -1), slice(1, None)):
                omega = rate[end]
                axial_rate = np.outer(omega @ axis, axis)
                spin = (along + rotor) * (omega @ axis) + ocs["spin_inertia"] * speed[end]
                momentum = across * (omega - axial_rate) + np.outer(spin, axis)
                change = across * acceleration + np.cross(omega, momentum)
                change -= np.outer(change @ axis, axis)
                moments.append(np.linalg.norm(change, axis=1).max())
        return float(max(moments))

    def hoop_stress(self):
        """rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2) at 1.2 times top speed, yield strength [Pa]."""
        wheel, motor = self.design["ocs"]["flywheel"], self.motor
        material = catalogue_row("materials.csv", wheel["material"])
        density, poisson = float(material["density_kg_m3"]), float(material["poisson_ratio"])
        top = 1.2 * min(motor["no_load_speed"], motor["speed_max"])
        outer, inner = wheel["outer_radius"], wheel["inner_radius"]
        squares = (3.0 + poisson) * outer**2 + (1.0 - poisson) * inner**2
        return density * top**2 / 4.0 * squares, float(material["yield_strength_pa"])


def piecewise(table):
    """Torques, each with the speeds at both ends of its interval."""
    torque, speed = table["torque"][:-1], table["speed"]
    return np.concatenate([torque, torque]), np.concatenate([speed[:-1], speed[1:]])


def _table(path):
    with path.open(newline="", encoding="utf-8") as stream:
        heading, *rows = csv.reader(stream)
    values = dict(zip(heading, np.array(rows, dtype=float).T, strict=True))

    def stacked(template, names):
        return np.column_stack([values[template.format(name)] for name in names])

    return {
        "file": path.name,
        "time": values["time_s"],
        "torque": stacked("wheel_torque_{}_nm", ("left", "right")),
        "speed": stacked("wheel_speed_{}_rad_s", ("left", "right")),
        "rate": stacked("rate_{}_rad_s", "xyz"),
        "power": values.get("bus_power_w"),
        "current": values.get("bus_current_a"),
    }
