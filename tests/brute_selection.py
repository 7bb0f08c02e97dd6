"""Every device on a grid, tried one by one: motor, gear, material, incidence, R, r and h.

Its own physics in plain numpy: rim and housing by integration of hollow cylinders, the inertia of
the whole by parallel axes, and the time of a turn from the motor equation integrated over the
wheel's speed on a table. Shares no formula with the package but the meaning of its inputs.
"""

from dataclasses import dataclass, replace
from itertools import product
from math import inf, pi

import numpy as np

from ocs_design.sizing import housing

RESERVE = 0.95
OVERSPEED = 1.2
BLOCK = 20_000


def cylinder(inner, outer, height, density):
    """Mass, inertia about the axis and across it."""
    mass = pi * density * height * (outer**2 - inner**2)
    square = outer**2 + inner**2
    return mass, mass * square / 2.0, mass * (square / 4.0 + height**2 / 12.0)


def shell(outer, height):
    """The same of the housing around a rim: two discs and a band."""
    gap, wall, density = housing.CLEARANCE, housing.WALL, housing.DENSITY
    disc = cylinder(0.0, outer + gap + wall, wall, density)
    band = cylinder(outer + gap, outer + gap + wall, height + 2.0 * gap, density)
    arm = (height + 2.0 * gap + wall) / 2.0
    return (
        2.0 * disc[0] + band[0],
        2.0 * disc[1] + band[1],
        2.0 * (disc[2] + disc[0] * arm**2) + band[2],
    )


class Drive:
    """A motor behind a gear, with tables of its time and angle per inertia over the speed."""

    def __init__(self, motor, gear, voltage, cap):
        s = -1.0 if gear.reverses else 1.0
        ratio, rotor = gear.ratio, motor.rotor_inertia or 0.0
        k_t = motor.torque_constant
        self.mass = motor.mass + gear.mass
        radius, length = motor.diameter / 2.0, motor.length
        self.axial = motor.mass * radius**2 / 2.0
        self.across = motor.mass * (radius**2 / 4.0 + length**2 / 12.0)
        self.share = s * ratio * rotor
        # The motor accelerates rim, rotor and gear: I_m; the momentum counts I_rim + share.
        self.extra = ratio**2 * rotor + gear.inertia - self.share
        gain = ratio * gear.efficiency
        free = voltage / (k_t * ratio)
        limit = min(motor.speed_max, gear.motor_speed_max) / ratio
        limit = min(limit, gear.wheel_speed_max, inf if cap is None else cap)
        self.overspeed = OVERSPEED * min(free, limit)
        self.free = RESERVE * free
        self.stall = RESERVE * gain * voltage * k_t / motor.resistance
        self.peak = RESERVE * min(gain * motor.peak_torque, gear.torque_max)
        self.top = min(self.free, limit)
        self._tabulate()

    def _tabulate(self, count=6001):
        """Time and angle per inertia, to reach a speed and to brake from it (mid-point rule)."""
        share = np.linspace(0.0, 1.0, count)
        # Denser towards the top, where the line's torque goes to zero; the last point is left out.
        speed = self.top * (1.0 - (1.0 - share) ** 3)
        speed = np.minimum(speed, self.top * (1.0 - 1e-12))
        middle, step = (speed[1:] + speed[:-1]) / 2.0, np.diff(speed)
        push = np.minimum(self.peak, self.stall * (1.0 - middle / self.free))
        pull = np.minimum(self.peak, self.stall * (1.0 + middle / self.free))
        self.speed = speed
        self.rise_time, self.rise_angle = _sums(step / push), _sums(middle * step / push)
        self.fall_time, self.fall_angle = _sums(step / pull), _sums(middle * step / pull)

    def angle(self, time, inertia, final):
        """By which a wheel can turn beyond its final speed within the time; -inf if too late."""
        last = np.interp(final, self.speed, self.fall_time)
        last_angle = np.interp(final, self.speed, self.fall_angle)
        both = self.rise_time + self.fall_time
        units = time / inertia + last
        peak = np.interp(units, both, self.speed)
        turned = np.interp(peak, self.speed, self.rise_angle + self.fall_angle) - last_angle
        coast = np.maximum(units - both[-1], 0.0) * self.top
        excess = (turned + coast) * inertia - final * time
        reached = (final < self.top) & (
            np.interp(final, self.speed, self.rise_time) <= units - last
        )
        return np.where(reached, excess, -inf)


def _sums(steps):
    return np.concatenate([[0.0], np.cumsum(steps)])


@dataclass
class Grid:
    """Values to try."""

    incidence: np.ndarray
    outer: np.ndarray
    inner: np.ndarray
    height: np.ndarray


def whole_grid(problem, count):
    """Over everything that the envelope allows; r as a share of R."""
    room = problem.envelope
    stated = problem.incidence
    angles = np.linspace(0.0, pi / 2.0, count["incidence"]) if stated is None else [stated]
    return Grid(
        np.asarray(angles),
        np.linspace(room.inner_radius_min + room.wall_min, room.outer_radius_max, count["outer"]),
        np.linspace(0.02, 0.999, count["inner"]),
        np.linspace(room.height_min, room.height_max, count["height"]),
    )


def around(problem, best, widths, count):
    """A finer grid around a device, from `widths` below to `widths` above it."""
    room = problem.envelope
    limits = [(0.0, pi / 2.0), (0.0, room.outer_radius_max), (0.01, 0.9999)]
    limits.append((room.height_min, room.height_max))
    if problem.incidence is not None:
        limits[0] = (problem.incidence, problem.incidence)
    names = ("incidence", "outer", "inner", "height")
    values = [
        np.unique(np.clip(np.linspace(at - width, at + width, count[name]), *limit))
        for name, at, width, limit in zip(names, best, widths, limits, strict=True)
    ]
    return Grid(*values)


def lightest(problem, drive, material, grid, below):
    """The lightest device on the grid that can do everything: its mass and its four values."""
    angle, outer, inner, height = (
        values.ravel()
        for values in np.meshgrid(
            grid.incidence, grid.outer, grid.inner, grid.height, indexing="ij"
        )
    )
    bore = inner * outer
    mass, _, _ = cylinder(bore, outer, height, material.density)
    device = 2.0 * (mass + drive.mass + shell(outer, height)[0])
    keep = fits(problem, drive, material, bore, outer, height) & (device < below)
    rows = np.flatnonzero(keep)
    rows = rows[np.argsort(device[rows], kind="stable")]
    for start in range(0, rows.size, BLOCK):
        some = rows[start : start + BLOCK]
        can = np.flatnonzero(
            does_all(problem, drive, material, angle[some], bore[some], outer[some], height[some])
        )
        if can.size:
            row = some[can[0]]
            return device[row], (angle[row], outer[row], inner[row], height[row])
    return inf, None


def fits(problem, drive, material, inner, outer, height, slack=0.0):
    """Whether rims lie within the envelope, but for a relative `slack`, and stand their speed."""
    room, more, less = problem.envelope, 1.0 + slack, 1.0 - slack
    mass, _, _ = cylinder(inner, outer, height, material.density)
    ok = (inner >= room.inner_radius_min * less) & (outer - inner >= room.wall_min * less)
    ok &= (outer <= room.outer_radius_max * more) & (inner >= 0.01 * outer * less)
    ok &= (height >= room.height_min * less) & (height <= room.height_max * more)
    ok &= mass <= room.mass_max * more
    if material.yield_strength is None or material.poisson_ratio is None:
        return ok
    nu = material.poisson_ratio
    stretch = (3.0 + nu) * outer**2 + (1.0 - nu) * inner**2
    stress = material.density * drive.overspeed**2 / 4.0 * stretch
    return ok & (stress * room.stress_safety <= material.yield_strength * more)


def does_all(problem, drive, material, angle, inner, outer, height, slack=0.0):
    """Whether devices do every maneuver in time, but for a relative `slack`."""
    requirement = problem.requirement
    _, spin, _ = cylinder(inner, outer, height, material.density)
    momentum = spin + drive.share
    can = momentum > 0.0
    momentum = np.where(can, momentum, 1.0)
    for maneuver in requirement.maneuvers:
        at = angle if maneuver.incidence is None else np.full_like(angle, maneuver.incidence)
        inertia = whole(problem, drive, material, at, inner, outer, height)
        slew = maneuver.slew(inertia, requirement.standing_height)
        slew = replace(slew, duration=slew.duration * (1.0 + slack))
        can &= in_time(slew, drive, momentum, inertia, at)
    if requirement.rate_change is not None:
        inertia = whole(problem, drive, material, angle, inner, outer, height)
        for axis, share in enumerate((np.sin(angle), np.cos(angle))):
            asked = inertia[:, axis] * requirement.rate_change
            can &= asked <= 2.0 * share * momentum * drive.top * (1.0 + slack)
    return can


def whole(problem, drive, material, angle, inner, outer, height):
    """Inertia about roll and pitch of robot and device, shape (n, 2)."""
    rim, case = cylinder(inner, outer, height, material.density), shell(outer, height)
    mass = rim[0] + case[0] + drive.mass
    axial, across = rim[1] + case[1] + drive.axial, rim[2] + case[2] + drive.across
    gap = housing.CLEARANCE + housing.WALL
    reach = np.sqrt((outer + gap) ** 2 + (height / 2.0 + gap) ** 2)
    robot, place = problem.robot, problem.place
    x, y, z = (o + d * reach for o, d in zip(place.origin, place.outward, strict=True))
    total = robot.mass + 2.0 * mass
    com = [
        (robot.mass * robot.com[0] + 2.0 * mass * x) / total,
        robot.mass * robot.com[1] / total,
        (robot.mass * robot.com[2] + 2.0 * mass * z) / total,
    ]
    sine, cosine = np.sin(angle) ** 2, np.cos(angle) ** 2
    roll = robot.inertia[0, 0] + 2.0 * (axial * sine + across * cosine)
    pitch = robot.inertia[1, 1] + 2.0 * (axial * cosine + across * sine)
    bodies = [(robot.mass, *robot.com), (mass, x, y, z), (mass, x, -y, z)]
    for weight, px, py, pz in bodies:
        roll = roll + weight * ((py - com[1]) ** 2 + (pz - com[2]) ** 2)
        pitch = pitch + weight * ((px - com[0]) ** 2 + (pz - com[2]) ** 2)
    return np.stack([roll, pitch], axis=-1)


def in_time(slew, drive, momentum, inertia, angle):
    """Whether the busier of both wheels is in time, with the trunk giving way."""
    shares = np.maximum(np.stack([np.sin(angle), np.cos(angle)], axis=-1), 1e-12)
    excess = np.abs(slew.swept) / shares / (2.0 * momentum[:, None])
    held = np.abs(slew.momentum) / shares / (2.0 * momentum[:, None])
    lead = np.where(excess.sum(axis=-1, keepdims=True) > 0.0, excess, held)
    # The wheels run at w and k w: half their sum turns pitch, half their difference roll.
    k = (lead[:, 1] - lead[:, 0]) / np.maximum(lead[:, 1] + lead[:, 0], 1e-300)
    way = shares**2 / inertia
    give = way[:, 1] * (1.0 + k) + way[:, 0] * (1.0 - k)
    reduced = momentum + drive.extra - momentum**2 * give
    # Wheels that carry more than half of what they turn are no wheels; the package stops there.
    sane = 2.0 * momentum * give <= 1.0
    reachable = drive.angle(slew.duration, np.where(reduced > 0.0, reduced, 1.0), held.sum(axis=-1))
    return sane & (reduced > 0.0) & (reachable >= excess.sum(axis=-1))


COARSE = {"incidence": 46, "outer": 26, "inner": 30, "height": 12}
FINE = {"incidence": 9, "outer": 13, "inner": 21, "height": 9}


def brute_force(problem):
    """The lightest device of all combinations, and which it is; inf and None if there is none."""
    best, choice = inf, None
    for motor, gear, material in product(problem.motors, problem.gears, problem.materials):
        drive = Drive(motor, gear, problem.bus_voltage, problem.wheel_speed_max)
        # What zooming in might gain is let in.
        mass, values = lightest(problem, drive, material, whole_grid(problem, COARSE), 1.1 * best)
        if values is None:
            continue
        mass, values = zoomed(problem, drive, material, mass, values)
        if mass < best:
            best, choice = mass, (motor.name, gear.name, material.name, values)
    return best, choice


def zoomed(problem, drive, material, mass, values):
    """The lightest on grids around a device, which narrow where nothing better is on them."""
    room = problem.envelope
    widths = np.array([pi / 40.0, room.outer_radius_max / 15.0, 0.06, room.height_max / 8.0])
    while widths[2] > 1e-4:
        better, found = lightest(
            problem, drive, material, around(problem, values, widths, FINE), mass
        )
        gain = 0.0 if found is None else 1.0 - better / mass
        if found is not None:
            mass, values = better, found
        if gain < 1e-4:
            widths = widths * 0.6
    return mass, values
