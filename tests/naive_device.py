"""Capability of a device, derived independently of the package: an oracle for the selection.

Bodies are solid cylinders less their cavities, moments are taken about B's origin and moved to the
common centre of mass, both wheels and the trunk are three coupled equations, and the fastest turn
accelerates as long as it can still be braked in time. Only the dimensions of web and hub, the
outlines of printed parts (`naive_module`) and the data types come from the package.
"""

from dataclasses import replace
from math import inf, sqrt

import numpy as np
from carrier_parts import drive_parts
from naive_module import (
    bore_min,
    height_max,
    mount_of,
    outer_radius_min,
    printed_parts,
    revolved_body,
    screw_bodies,
    swept_size,
    total_body,
)
from naive_wheel import has_room_for_holes, hub_body

from ocs_design.actuation.fasteners import LIGAMENT
from ocs_design.parts.motor_mount import hub_of
from ocs_design.parts.rim import SHOULDER, STEP
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.turns import Drop, Flip

USABLE = 0.95
"""Usable fraction of voltage, current and speed."""
PROOF_SPEED = 1.2
"""Speed that a rim must withstand, over the highest speed of its drive."""
LEAST_BORE = 0.01
"""Smallest bore over the outer radius."""
HEIGHTS = (0.0, 0.005, 0.01, 0.02)
"""Heights of rims [m] between which cubic polynomials are exact."""


class Drive:
    """A motor behind a gear at a supply, seen at the wheel; no figure is missing."""

    def __init__(self, problem, motor, gear, points=3000):
        rotor = motor.rotor_inertia or 0.0
        self.foot_plate = problem.foot_plate
        self.motor, self.gear, self.mount = motor, gear, mount_of(motor, gear, self.foot_plate)
        # Posts of a cage are shorter behind a taller rim: integrals are at most cubic in height.
        drive_bodies = (drive_parts(motor, gear, height, self.foot_plate) for height in HEIGHTS)
        self.drive_bodies = [total_body(parts) for parts in drive_bodies]
        self.height_max = height_max(motor, gear, self.foot_plate)
        self.has_web, self.hub, self.hub_radius = problem.web, np.zeros(3), 0.0
        self.chamfer, self.web_material = chamfer_of(problem), problem.web_material
        if problem.web:
            self.web_thickness = 1.0e-3 if problem.web_material is None else 1.5e-3
            hub = hub_of(
                motor.mounting if gear.name == "direct" else None,
                motor.diameter,
                chamfer=problem.cuts.chamfer,
                web_thickness=self.web_thickness,
            )
            # This hub belongs to a solid web; it has holes if the widest web has room for them.
            widest = np.array([problem.envelope.outer_radius_max - least_wall(problem)])
            lightened = replace(hub, lightening=problem.lightenings[0])
            self.web_hub = lightened if has_room_for_holes(widest, lightened)[0] else hub
            # The lid clears the rim by 2 mm and the heads of the hub's screws by 0.5 mm.
            self.heads_height = hub.height + 2.0 * (hub.bolt_head - 1.5e-3) if hub.bolts else 0.0
            self.hub = hub_body(hub, 1.0)
            widest = max(hub.radius, bore_min(motor, gear, self.foot_plate))
            self.hub_radius = widest + LIGAMENT
        # The rotor turns at N W, in the opposite direction if the gear reverses.
        self.rotor_momentum = gear.ratio * rotor * (-1.0 if gear.reverses else 1.0)
        self.rotor_load = gear.ratio**2 * rotor + gear.inertia
        voltage, k_t = problem.supply.voltage, motor.torque_constant
        free = voltage / k_t / gear.ratio
        mechanical = min(
            min(speed_limit(motor), gear.motor_speed_max) / gear.ratio,
            gear.wheel_speed_max,
            problem.wheel_speed_max or inf,
        )
        self.proof_speed = PROOF_SPEED * min(free, mechanical)
        self.no_load_speed = USABLE * free
        self.speed_max = min(self.no_load_speed, USABLE * mechanical)
        boost = gear.ratio * gear.efficiency
        self.stall_torque = USABLE * boost * voltage / motor.resistance * k_t
        self.torque_limit = USABLE * min(boost * motor.peak_torque, gear.torque_max)
        self._tabulate(points)

    def _tabulate(self, points):
        """Tabulate time and angle per inertia up to a peak speed and down to rest."""
        peak = self.no_load_speed * (1.0 - np.exp(-(np.linspace(0.0, 16.0, points) ** 2) / 8.0))
        peak = np.append(
            peak[peak < self.speed_max], min(self.speed_max, self.no_load_speed * (1.0 - 1e-14))
        )
        up, down = self._up(peak), self._down(peak)
        self.time, self.angle, self.peak = up[0] + down[0], up[1] + down[1], peak

    def _up(self, speed):
        """Time and angle per inertia from rest, at a torque of min(limit, stall (1 - w / free))."""
        constant_torque = min(self.torque_limit, self.stall_torque)
        bend = self.no_load_speed * (1.0 - constant_torque / self.stall_torque)
        first = np.minimum(speed, bend)
        lag = self.no_load_speed / self.stall_torque
        later = lag * np.log(
            (self.no_load_speed - first) / (self.no_load_speed - np.maximum(speed, first))
        )
        on_line = self.no_load_speed * later - lag * (speed - first)
        time = first / constant_torque + later
        return time, first**2 / (2.0 * constant_torque) + on_line

    def _down(self, speed):
        """Time and angle per inertia to rest, at a torque of min(limit, stall (1 + w / free))."""
        bend = self.no_load_speed * max(self.torque_limit / self.stall_torque - 1.0, 0.0)
        last = np.minimum(speed, bend)
        lag = self.no_load_speed / self.stall_torque
        late = lag * np.log1p(last / self.no_load_speed)
        on_line = lag * last - self.no_load_speed * late
        return late + (speed - last) / self.torque_limit, on_line + (speed**2 - last**2) / (
            2.0 * self.torque_limit
        )

    def carrier(self, rims):
        """Integrals of motor, gear, housing and foot, see `naive_module`, shape (7, n)."""
        drive = sum(
            body[:, None] * np.prod([(rims.height - o) / (own - o) for o in HEIGHTS if o != own], 0)
            for own, body in zip(HEIGHTS, self.drive_bodies, strict=True)
        )
        shell = printed_parts(rims.outer, rims.height, self.mount, self.foot_plate)
        return drive + shell + screw_bodies(rims.outer, rims.height, self.foot_plate)

    def wheel(self, rims):
        """Rim, web and hub: mass, inertia about the axis and across it, shape (3, n)."""
        if not self.has_web:
            return rims.body
        density = self.web_density(rims.density)
        web = rims.web(density, self.web_thickness, self.web_hub)
        return rims.body + web + density * self.hub[:, None]

    def web_density(self, density):
        """Density of web and hub for a rim of this density [kg/m^3]."""
        return density if self.web_material is None else self.web_material.density

    def height_min(self, density):
        """Least height of a rim of this density, given by its web [m]."""
        if not self.has_web:
            return 0.0
        band = max(
            self.web_thickness + 2.0 * self.chamfer + STEP, 4.0 * self.chamfer, self.heads_height
        )
        if self.web_material is None:
            return band
        seated = self.web_thickness * max(1.0, self.web_material.density / density) + SHOULDER
        return max(seated, band)

    def swept_angle(self, time, inertia, final):
        """Largest angle of the wheels in a time, ending at a speed, less that speed times it."""
        end_time, end_angle = self._down(final)
        units = time / inertia + end_time
        peak = np.interp(units, self.time, self.peak)
        angle = np.interp(units, self.time, self.angle)
        angle += np.maximum(units - self.time[-1], 0.0) * self.peak[-1] - end_angle
        return np.where(peak >= final, angle * inertia - final * time, -inf)


def speed_limit(motor):
    """Highest permitted speed of a motor [rad/s]; None if unknown."""
    if motor.speed_max is not None:
        return motor.speed_max
    if motor.no_load_speed is not None:
        return motor.no_load_speed
    if motor.rated_voltage is None or motor.torque_constant is None:
        return None
    return motor.rated_voltage / motor.torque_constant


def is_complete(motor, gear):
    """Whether all figures are known; the rotor may be unknown where it can only help."""
    figures = [motor.mass, motor.torque_constant, motor.resistance, motor.peak_torque]
    if gear.ratio > 1.0 or gear.reverses:
        figures.append(motor.rotor_inertia)
    return None not in [*figures, speed_limit(motor)]


def chamfer_of(problem):
    """Chamfer of the wheels, 0 without a web [m]."""
    return problem.cuts.chamfer if problem.web else 0.0


def least_wall(problem):
    """Least wall: as specified, and at least four chamfers, so that half of a face is left [m]."""
    return max(problem.envelope.wall_min, 4.0 * chamfer_of(problem))


def fits_envelope(problem, rims, slack=0.0):
    """Whether rims are within the envelope."""
    limits, factor = problem.envelope, 1.0 + slack
    inside = (rims.outer <= limits.outer_radius_max * factor) & (
        rims.inner * factor >= np.maximum(limits.inner_radius_min, LEAST_BORE * rims.outer)
    )
    inside &= (rims.height <= limits.height_max * factor) & (
        rims.height * factor >= limits.height_min
    )
    inside &= (rims.outer - rims.inner) * factor >= least_wall(problem)
    return inside & (rims.body[0] <= limits.mass_max * factor)


def is_buildable(problem, drive, rims, material, slack=0.0):
    """Whether rims have room for web and hub, and withstand the stress at the bore if known."""
    factor = 1.0 + slack
    seated = (rims.inner * factor >= drive.hub_radius) & (
        rims.height * factor >= drive.height_min(material.density)
    )
    seated &= rims.outer * factor >= outer_radius_min(drive.mount)
    seated &= rims.height <= drive.height_max * factor
    if drive.has_web:
        seated &= has_room_for_holes(rims.inner * factor, drive.web_hub)
    if material.yield_strength is None or material.poisson_ratio is None:
        return seated
    nu = material.poisson_ratio
    squares = (3.0 + nu) * rims.outer**2 + (1.0 - nu) * rims.inner**2
    stress = material.density * drive.proof_speed**2 / 4.0 * squares
    safety = problem.envelope.stress_safety
    if drive.has_web and drive.web_hub.lightening and safety:
        # Stress concentration at the edge of a hole.
        safety = max(safety, {5: 6.5, 6: 6.5, 7: 8.0, 8: 8.0}[drive.web_hub.lightening])
    return seated & (stress * safety <= material.yield_strength * factor)


def demand_of(maneuver, inertia, coupling):
    """Integral of the wheels' momentum, momentum at the end, and the time of a maneuver."""
    if isinstance(maneuver, Drop):
        time = sqrt(2.0 * (maneuver.height - maneuver.standing_height) / maneuver.gravity)
        angles, left = _off_level(maneuver.roll, maneuver.pitch), np.zeros((2, 1))
    elif isinstance(maneuver, Flip):
        time, left = maneuver.duration, np.zeros((2, 1))
        angles = np.array([[0.0], [maneuver.angle]])
    else:
        assert isinstance(maneuver, Disturbance)
        flight = 2.0 * maneuver.takeoff_velocity[1] / maneuver.gravity
        time = flight - maneuver.onset - maneuver.duration
        left = np.array(maneuver.torque)[:2, None] * maneuver.duration
        # The momentum rises linearly while the torque acts.
        return left * maneuver.duration / 2.0 + 0.0 * inertia, left + 0.0 * inertia, time
    return inertia * angles + coupling * angles[::-1], left + 0.0 * inertia, time


def _off_level(roll, pitch):
    """Rotation vector in roll and pitch that levels a trunk, for any heading, shape (2, 1)."""
    about_x = np.array(
        [[1.0, 0.0, 0.0], [0.0, np.cos(roll), -np.sin(roll)], [0.0, np.sin(roll), np.cos(roll)]]
    )
    about_y = np.array(
        [[np.cos(pitch), 0.0, np.sin(pitch)], [0.0, 1.0, 0.0], [-np.sin(pitch), 0.0, np.cos(pitch)]]
    )
    up = (about_y @ about_x).T @ [0.0, 0.0, 1.0]
    axis = np.cross(up, [0.0, 0.0, 1.0])[:2]
    size = np.linalg.norm(axis)
    return (np.arccos(up[2]) * axis / size)[:, None]


def margin(problem, drive, rims, angle):
    """Capability over demand for the worst maneuver; at least 1 if feasible."""
    spin = drive.wheel(rims)[1] + drive.rotor_momentum
    worst = np.where(spin > 0.0, inf, 0.0)
    spin = np.maximum(spin, 1e-12)
    for maneuver in problem.requirement.maneuvers:
        at = angle if maneuver.incidence is None else np.full_like(angle, maneuver.incidence)
        worst = np.minimum(worst, _maneuver_margin(problem, drive, rims, maneuver, spin, at))
    if problem.requirement.rate_change is not None:
        inertia = inertia_on(problem, drive, rims, angle)
        coupling = coupling_on(problem, drive, rims, angle)
        # Avoid a division by zero where the wheels have no share in an axis.
        shares = np.maximum([np.sin(angle), np.cos(angle)], 1e-12)
        demand = (
            inertia / shares + np.abs(coupling) / shares[::-1]
        ) * problem.requirement.rate_change
        worst = np.minimum(worst, (2.0 * spin * drive.speed_max / demand).min(axis=0))
    return worst


def _maneuver_margin(problem, drive, rims, maneuver, spin, angle):
    inertia = inertia_on(problem, drive, rims, angle)
    coupling = coupling_on(problem, drive, rims, angle)
    shares = np.stack([np.sin(angle), np.cos(angle)])
    inertia, coupling = release_unreached(inertia, coupling, shares, chord_of(maneuver))
    through, left, time = demand_of(maneuver, inertia, coupling)
    # A cosine of 1e-17 counts as zero.
    levers = np.where(shares > 1e-9, 2.0 * shares * spin, np.where(through != 0.0, 1e-30, 1.0))
    # Roll is half the difference of both wheels' angles, pitch half their sum.
    turns = wheels_of(through / levers)
    row = np.abs(turns).argmax(axis=0)
    busy, other = (np.take_along_axis(turns, k[None], 0)[0] for k in (row, 1 - row))
    ratio = np.divide(other, busy, out=np.ones_like(busy), where=busy != 0.0)
    # Of  tau = ((I_rim + load) 1 - h^2 A' J^-1 A) dW  the row of the busier wheel.
    compliance = compliance_of(inertia, coupling, shares)
    own = compliance[0, 0] * (row == 0) + compliance[1, 1] * (row == 1)
    load = drive.wheel(rims)[1] + drive.rotor_load - spin**2 * (own + ratio * compliance[0, 1])
    final = np.abs(wheels_of(left / levers)).max(axis=0)
    possible = drive.swept_angle(time, np.maximum(load, 1e-15), final)
    busy = np.abs(busy)
    ratio = np.divide(possible, busy, out=np.where(possible >= 0.0, inf, 0.0), where=busy > 0.0)
    return np.where(load > 0.0, ratio, 0.0)


def chord_of(maneuver):
    """Largest chord of a turn away from level."""
    if isinstance(maneuver, Disturbance):
        return 0.0
    if isinstance(maneuver, Flip):
        return 2.0 * abs(np.sin(maneuver.angle / 2.0))
    return 2.0 * np.sin(np.linalg.norm(_off_level(maneuver.roll, maneuver.pitch)) / 2.0)


def device_mass(drive, rims):
    """Mass of both modules [kg]."""
    return 2.0 * (drive.wheel(rims)[0] + drive.carrier(rims)[0])


def inertia_on(problem, drive, rims, angle):
    """Braked inertia of robot and modules about roll and pitch at the common centre of mass."""
    total = _tensor(problem, drive, rims, angle)
    return np.stack([total[0, 0], total[1, 1]])


def coupling_on(problem, drive, rims, angle):
    """Roll momentum per pitch rate, and the reverse, without momentum about yaw."""
    total = _tensor(problem, drive, rims, angle)
    yaw_rate = -total[2, 1] / total[2, 2]
    return total[0, 1] + total[0, 2] * yaw_rate


def _tensor(problem, drive, rims, angle):
    """Braked inertia of robot and modules about the common centre of mass, shape (3, 3, n)."""
    module = revolved_body(*drive.wheel(rims)) + drive.carrier(rims)
    mass, along, up, across, axis, upright, aslant = module
    robot, place = problem.robot, problem.place
    size = rims.outer, rims.height, drive.motor, drive.gear, drive.foot_plate
    reach, standing = swept_size(*size)
    x, y, z = (o + d * reach for o, d in zip(place.origins[0], place.outward[0], strict=True))
    z = z + standing if place.upright else z
    sine, cosine = np.sin(angle), np.cos(angle)
    zero = np.zeros_like(sine + mass)
    # First and second moments of the left and the right module about B's origin.
    first, second = np.zeros((3, *zero.shape)), np.zeros((3, 3, *zero.shape))
    for side in (1.0, -1.0):
        first += np.stack(
            [mass * x + along * sine, side * (mass * y + along * cosine), mass * z + up]
        )
        xx = mass * x**2 + 2.0 * x * along * sine + across * cosine**2 + axis * sine**2
        yy = mass * y**2 + 2.0 * y * along * cosine + across * sine**2 + axis * cosine**2
        zz = mass * z**2 + 2.0 * z * up + upright
        xy = mass * x * y + x * along * cosine + y * along * sine + (axis - across) * sine * cosine
        xz = mass * x * z + x * up + z * along * sine + aslant * sine
        yz = mass * y * z + y * up + z * along * cosine + aslant * cosine
        rows = [[xx, side * xy, xz], [side * xy, yy, side * yz], [xz, side * yz, zz]]
        second += np.array([[entry + zero for entry in row] for row in rows])
    total = robot.mass + 2.0 * mass
    center = (robot.mass * np.asarray(robot.com)[:, None] + first) / total
    inertia = np.asarray(robot.inertia)
    own = np.trace(inertia) / 2.0 * np.eye(3) - inertia
    own += robot.mass * np.outer(robot.com, robot.com)
    moments = own[:, :, None] + second - total * center[:, None] * center[None]
    return np.trace(moments) * np.eye(3)[:, :, None] - moments


def release_unreached(inertia, coupling, shares, chord):
    """Let an axis that the wheels do not control follow the other, if it ends within 1 degree."""
    follows = np.abs(coupling) / inertia * chord <= np.radians(1.0)
    free = (shares <= 1e-9) & follows
    less = np.where(free, coupling**2 / inertia, 0.0)[::-1]
    return inertia - less, np.where(free.any(axis=0), 0.0, coupling)


def wheels_of(half):
    """Values of the left and the right wheel, from half the difference and half the sum."""
    return np.stack([half[1] + half[0], half[1] - half[0]])


def compliance_of(inertia, coupling, shares):
    """A' J^-1 A, rows and columns by wheel."""
    determinant = inertia[0] * inertia[1] - coupling**2
    inverse = np.array([[inertia[1], -coupling], [-coupling, inertia[0]]]) / determinant
    axes = np.array([[shares[0], -shares[0]], [shares[1], shares[1]]])
    return np.einsum("ian,ijn,jbn->abn", axes, inverse, axes)
