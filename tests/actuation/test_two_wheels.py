"""Two wheels at an incidence, and the screws of their motors."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from driven_wheels import EC45_LINE
from scipy.integrate import solve_ivp

from ocs_design.actuation.drive import armature, rotor_share
from ocs_design.actuation.fasteners import IN_PLASTIC, SCREWS, screw
from ocs_design.actuation.motor import DIRECT, Gear
from ocs_design.actuation.slew import slew_profile
from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.actuation.wheel_load import WheelTask
from ocs_design.common.errors import PartError
from ocs_design.device.layout import module_axes

INF = np.inf
TRUNK, TRANSVERSE, ROTOR = np.array([0.030, 0.0535]), 4e-5, 1.81e-5
BELT = Gear("belt", 3.0, 1.0, 0.0, 2e-6, INF, INF, INF, False, "test")
SPUR = Gear("spur", 2.5, 1.0, 0.0, 1e-6, INF, INF, INF, True, "test")
FASTER = Gear("faster", 0.5, 1.0, 0.0, 0.0, INF, INF, INF, False, "test")


@dataclass(frozen=True)
class Pair:
    """Two wheels with equal rims at an incidence on a trunk free to roll and pitch."""

    rim: float
    gear: Gear
    incidence: float
    product: float = 0.0

    @property
    def mass_matrix(self):
        """Mass matrix of roll and pitch rate and wheel speeds, (4, 4), from each body's energy."""
        s, c = np.sin(self.incidence), np.cos(self.incidence)
        sense = -1.0 if self.gear.reverses else 1.0
        matrix = np.diag([*TRUNK, 0.0, 0.0])
        matrix[0, 1] = matrix[1, 0] = self.product
        for wheel, side in enumerate((1.0, -1.0)):
            spin, rotor, gearing = np.zeros((3, 4))
            along, across = np.array([side * s, c, 0, 0]), np.array([c, -side * s, 0, 0])
            spin[:] = rotor[:] = along
            spin[2 + wheel] = gearing[2 + wheel] = 1.0
            rotor[2 + wheel] = sense * self.gear.ratio
            matrix += self.rim * np.outer(spin, spin) + TRANSVERSE * np.outer(across, across)
            matrix += ROTOR * np.outer(rotor, rotor) + self.gear.inertia * np.outer(
                gearing, gearing
            )
        return matrix

    @property
    def spin_inertia(self):
        return self.rim + rotor_share(ROTOR, self.gear)

    @property
    def armature(self):
        return armature(ROTOR, self.gear)

    def task(self, angle, rate):
        """Task of a turn by `angle`, from `rate` with wheels at rest, to rest."""
        trunk = self.mass_matrix[:2, :2]
        inertia = TiltInertia(np.diag(trunk), trunk[0, 1])
        return WheelTask(
            trunk @ angle, trunk @ rate, np.nan, inertia, module_axes(self.incidence)[:2]
        )


def motor_torque(speed, direction):
    """Torque at the wheel from full voltage in `direction`, with limited current [N m]."""
    torque = EC45_LINE.stall_torque * (direction - speed / EC45_LINE.no_load_speed)
    return np.clip(torque, -EC45_LINE.torque_limit, EC45_LINE.torque_limit)


def flight(pair, rate, drive, times):
    """State (angles, wheel angles, rates, wheel speeds) at the end; `drive(k, W, M)` gives Q."""
    matrix = pair.mass_matrix
    state = np.concatenate([np.zeros(4), rate, np.zeros(2)])
    for phase, (start, end) in enumerate(pairwise(times)):

        def slope(_, y, phase=phase):
            return np.concatenate([y[4:], np.linalg.solve(matrix, drive(phase, y[6:], matrix))])

        solution = solve_ivp(slope, (start, end), state, method="DOP853", rtol=1e-12, atol=1e-13)
        state = solution.y[:, -1]
    return state


PAIRS = [
    Pair(9e-5, DIRECT, 0.0),
    Pair(9e-5, DIRECT, np.radians(40.0)),
    Pair(4e-5, BELT, np.radians(25.0)),
    Pair(9e-5, SPUR, np.radians(40.0)),
    Pair(8e-5, FASTER, np.radians(60.0)),
    Pair(6e-3, DIRECT, np.radians(20.0)),
]


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize(("angle", "rate"), [(0.5, 0.0), (0.15, 0.6), (4.0, 0.0)])
def test_a_slew_about_pitch(pair, angle, rate):
    """Both motors on their limits turn the trunk by the angle and leave it at rest."""
    load = pair.task([0.0, angle], [0.0, rate]).load()
    final = load.final_speed(pair.spin_inertia)
    profile = slew_profile(
        load.angle(pair.spin_inertia),
        load.reduced_inertia(pair.spin_inertia, pair.armature),
        EC45_LINE,
        final,
    )

    def drive(phase, speeds, matrix):
        torque = motor_torque(speeds, (1.0, -1.0)[phase])
        return np.concatenate([np.zeros(2), torque])

    times = [0.0, float(profile.brake_from), float(profile.end)]
    state = flight(pair, [0.0, rate], drive, times)
    # The trunk turns against its wheels.
    assert state[:2] == pytest.approx([0.0, -angle], abs=1e-8 * angle)
    assert state[4:6] == pytest.approx([0.0, 0.0], abs=1e-8)
    assert state[6:] == pytest.approx([float(final)] * 2, rel=1e-8, abs=1e-6)
    # The angle swept beyond the final speed, plus that of the final speed.
    swept = float(load.angle(pair.spin_inertia) + final * profile.end)
    assert state[2:4] == pytest.approx([swept, swept], rel=1e-8)


COUPLED = [
    Pair(9e-5, DIRECT, np.radians(40.0), 0.004),
    Pair(4e-5, BELT, np.radians(25.0), -0.012),
    Pair(6e-3, SPUR, np.radians(50.0), 0.012),
]


@pytest.mark.parametrize("pair", [*PAIRS[1:], *COUPLED])
@pytest.mark.parametrize(
    "angle", [(0.0, 0.5), (0.4, 0.0), (0.3, 0.5), (0.3, -0.5), (-0.1, 0.6), (0.02, 0.9)]
)
def test_a_slew_about_both_axes(pair, angle):
    """The wheel with more load is at its limits, the other in proportion and within its own.

    Either wheel may have more load; where the trunk's axes are coupled, a turn about one of them
    needs both. Without gyroscopic coupling, which the full simulation has.
    """
    load = pair.task(angle, [0.0, 0.0]).load()
    profile = slew_profile(
        load.angle(pair.spin_inertia),
        load.reduced_inertia(pair.spin_inertia, pair.armature),
        EC45_LINE,
    )
    roll, pitch = pair.mass_matrix[:2, :2] @ angle
    roll, pitch = roll / np.sin(pair.incidence), pitch / np.cos(pair.incidence)
    turns = np.array([pitch + roll, pitch - roll])
    busy = int(np.abs(turns).argmax())
    other, sense = 1 - busy, np.sign(turns[busy])
    ratio, torques = turns[other] / turns[busy], []

    def drive(phase, speeds, matrix):
        """The other wheel's torque keeps the ratio of the speeds."""
        inverse, torque = np.linalg.inv(matrix)[2:, 2:], np.zeros(2)
        torque[busy] = sense * motor_torque(sense * speeds[busy], (1.0, -1.0)[phase])
        torque[other] = torque[busy] * (ratio * inverse[busy, busy] - inverse[other, busy])
        torque[other] /= inverse[other, other] - ratio * inverse[busy, other]
        torques.append((torque[other], speeds[other]))
        return np.concatenate([np.zeros(2), torque])

    times = [0.0, float(profile.brake_from), float(profile.end)]
    state = flight(pair, [0.0, 0.0], drive, times)
    assert -state[:2] == pytest.approx(angle, abs=1e-8)
    assert state[4:] == pytest.approx(np.zeros(4), abs=1e-6)
    second, speed = np.array(torques).T
    assert (second <= motor_torque(speed, 1.0) + 1e-9).all()
    assert (second >= motor_torque(speed, -1.0) - 1e-9).all()


@pytest.mark.parametrize(
    ("name", "thickness", "designation"),
    [
        ("M3", 0.005, "ISO 4762 M3 x 8"),
        ("M4", 0.005, "ISO 4762 M4 x 10"),
        ("M3", 0.0051, "ISO 4762 M3 x 10"),
        ("M2.5", 0.0066, "ISO 4762 M2.5 x 10"),
        ("M4", 0.016, "ISO 4762 M4 x 20"),
        ("M4", 0.0161, "ISO 4762 M4 x 25"),
        ("M6", 0.029, "ISO 4762 M6 x 35"),
        ("M4", 0.0661, "ISO 4762 M4 x 80"),
    ],
)
def test_thread_engagement_is_at_least_the_diameter(name, thickness, designation):
    bolt = screw(name)
    assert bolt.designation(bolt.length_through(thickness)) == designation


@pytest.mark.parametrize(
    ("name", "millimetres"),
    [("M2", 20), ("M2.5", 25), ("M3", 30), ("M4", 40), ("M5", 50), ("M6", 60), ("M8", 80)],
)
def test_the_longest_commercial_length(name, millimetres):
    """The end of the range of commercial lengths: ISO 4762:2004, table 1."""
    assert screw(name).usual_length == pytest.approx(1e-3 * millimetres)


def test_thread_engagement_in_plastic_is_twice_the_diameter():
    assert screw("M2").length_through(0.0016, IN_PLASTIC) == 0.006


# kg per 1000, Fuller Metric, weight chart of DIN 912 (the weights of ISO 4762 are the same).
MASSES = {
    ("M2", 6): 0.215,
    ("M2.5", 8): 0.465,
    ("M3", 8): 0.8,
    ("M3", 10): 0.9,
    ("M3", 16): 1.2,
    ("M4", 10): 1.8,
    ("M4", 20): 2.7,
    ("M5", 12): 3.0,
    ("M6", 12): 5.1,
    ("M6", 20): 6.5,
}


@pytest.mark.parametrize(("name", "length"), MASSES)
def test_masses_of_screws_agree_with_a_maker(name, length):
    """Heads have their largest permitted size here, which adds up to 30 mg to small screws."""
    specified = MASSES[name, length] * 1e-3
    assert screw(name).mass(1e-3 * length) == pytest.approx(specified, rel=0.1, abs=5e-5)


def test_dimensions_of_every_screw_are_in_order():
    for each in SCREWS:
        assert each.tapping_drill < each.diameter < each.clearance_hole < each.head_diameter
        assert each.head_height == pytest.approx(each.diameter)


def test_an_unknown_screw_is_refused_with_the_known_ones():
    with pytest.raises(PartError, match="M7") as caught:
        screw("M7")
    assert "M2.5" in caught.value.hint
