"""Margins once more from files alone: design.json, time series and the catalogues as they are.

Nothing of the program is used. A torque is held from each sample to the next.
"""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

CATALOGUE = Path(__file__).parents[1] / "ocs_design" / "catalogue"


def catalogue_row(file, name):
    """A row of a catalogue, as text."""
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

    def most(self, figure):
        """Largest of a figure of (torque, speed), each of shape (k, 2), over all flights."""
        return max(float(np.max(figure(*held(table)))) for table in self.tables)

    def power(self, torque, speed, idle):
        """Of both motors at the bus [W]."""
        motor, current = self.motor, np.abs(torque) / self.gain + idle
        shaft = torque * speed
        loss = motor["gear_efficiency"]
        given = np.where(shaft > 0.0, shaft / loss, shaft * loss)
        rubbed = motor["torque_constant"] * idle * motor["gear_ratio"] * np.abs(speed)
        return (motor["resistance"] * current**2 + given + rubbed).sum(axis=1)

    def demands(self):
        """Every demand that follows from speeds and torques, by the name of its margin."""
        ratio, volts = self.motor["gear_ratio"], self.motor["bus_voltage"]
        drawn = self.most(lambda torque, speed: self.power(torque, speed, self.idle))
        back = self.most(lambda torque, speed: -self.power(torque, speed, 0.0))
        moved = self.design["ocs"]["spin_inertia"] + self.motor["armature"]
        rubbed = self.gain * self.idle
        return {
            "wheel speed": self.most(lambda _, speed: np.abs(speed)),
            "motor speed": ratio * self.most(lambda _, speed: np.abs(speed)),
            "motor torque": self.most(lambda torque, _: np.abs(torque)) + rubbed,
            "bus current": drawn / volts,
            "bus power": drawn,
            "bus current, fed back": back / volts,
            "bus power, fed back": back,
            "voltage line": self.most(
                lambda torque, speed: np.abs(
                    speed / self.motor["no_load_speed"]
                    + (torque + rubbed * np.sign(speed)) / self.motor["stall_torque"]
                )
            ),
            "stored energy": self.most(lambda _, speed: 0.5 * moved * (speed**2).sum(axis=1)),
            "winding heat": max(map(self.heat, self.tables)),
            "bearing moment": max(map(self.bearing_moment, self.tables)),
        }

    def heat(self, table):
        """R times the integral of i^2, of the busier motor [J]."""
        torque, speed, time = table["torque"][:-1], table["speed"][:-1], table["time"]
        used = (torque != 0.0) | (speed != 0.0)
        current = np.abs(torque) / self.gain + self.idle * used
        return self.motor["resistance"] * float(np.max(np.diff(time) @ current**2))

    def bearing_moment(self, table):
        """Across the axis, of each wheel's momentum as the world sees it change [N m]."""
        ocs, rate = self.design["ocs"], table["rate"]
        acceleration = np.diff(rate, axis=0) / np.diff(table["time"])[:, None]
        across, along = ocs["flywheel"]["transverse_inertia"], ocs["flywheel"]["spin_inertia"]
        rotor = self.motor["rotor_inertia"] / self.motor["gear_ratio"]
        found = []
        # Some maneuvers are flown with the modules turned by hand.
        (own_angle,) = (
            each["incidence"]
            for each in self.design["requirement"]["maneuvers"]
            if table["file"].startswith(each["name"].replace(" ", "_"))
        )
        angle = ocs["incidence"] if own_angle is None else own_angle
        for side, speed in zip((1.0, -1.0), table["speed"].T, strict=True):
            axis = np.array([side * np.sin(angle), np.cos(angle), 0.0])
            for end in (slice(None, -1), slice(1, None)):
                turn, spun = rate[end], speed[end]
                own = np.outer(turn @ axis, axis)
                spin = (along + rotor) * (turn @ axis) + ocs["spin_inertia"] * spun
                momentum = across * (turn - own) + np.outer(spin, axis)
                change = across * acceleration + np.cross(turn, momentum)
                change -= np.outer(change @ axis, axis)
                found.append(np.linalg.norm(change, axis=1).max())
        return float(max(found))

    def hoop_stress(self):
        """rho w^2 / 4 ((3 + nu) R^2 + (1 - nu) r^2) at 1.2 times the drive's top speed [Pa]."""
        wheel, motor = self.design["ocs"]["flywheel"], self.motor
        steel = catalogue_row("materials.csv", wheel["material"])
        density, poisson = float(steel["density_kg_m3"]), float(steel["poisson_ratio"])
        top = 1.2 * min(motor["no_load_speed"], motor["speed_max"])
        outer, inner = wheel["outer_radius"], wheel["inner_radius"]
        squares = (3.0 + poisson) * outer**2 + (1.0 - poisson) * inner**2
        return density * top**2 / 4.0 * squares, float(steel["yield_strength_pa"])


def held(table):
    """Torques with the speeds at both ends of the time that each is held."""
    torque, speed = table["torque"][:-1], table["speed"]
    return np.concatenate([torque, torque]), np.concatenate([speed[:-1], speed[1:]])


def _table(path):
    with path.open(newline="", encoding="utf-8") as stream:
        heading, *rows = csv.reader(stream)
    values = dict(zip(heading, np.array(rows, dtype=float).T, strict=True))

    def stacked(form, names):
        return np.column_stack([values[form.format(name)] for name in names])

    return {
        "file": path.name,
        "time": values["time_s"],
        "torque": stacked("wheel_torque_{}_nm", ("left", "right")),
        "speed": stacked("wheel_speed_{}_rad_s", ("left", "right")),
        "rate": stacked("rate_{}_rad_s", "xyz"),
        "power": values.get("bus_power_w"),
        "current": values.get("bus_current_a"),
    }
