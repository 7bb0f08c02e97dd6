"""The posture in which a legged robot stands, by inverse kinematics of each leg."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.chain import Chain, ChainPose, neutral_posture
from ocs_design.robot.leg_geometry import LegGeometry, leg_geometries
from ocs_design.robot.robot import Leg
from ocs_design.robot.tree import Tree

POSITION_TOLERANCE = 1e-3
"""Distance within which a foot is in place [m]."""

SOLE_TOLERANCE = 1e-2
"""Angle within which a sole is flat [rad]."""

LANDING_TOLERANCE = np.radians(5.0)
"""Largest roll and pitch at touchdown, and largest angle that a flip may fall short of [rad]."""

_REGULARISATION = 1e-3
"""Weight of staying near the start, relative to the foot's error over the leg's length.

It only settles what the foot leaves free (a hip's yaw): the foot misses by 1e-6 of that length.
"""


@dataclass(frozen=True, eq=False)
class Stance:
    """Joint values at which a leg stands.

    Attributes:
        values: of the leg's driven joints [rad or m].
        miss: distance from the foot to its place [m].
        tilt: of the sole against the ground [rad]; 0 for legs without ankles.
        knee_ahead: distance of the knee on the desired side of the line from hip to foot [m].
    """

    values: FloatArray
    miss: float
    tilt: float
    knee_ahead: float

    @property
    def good(self) -> bool:
        """Whether foot and sole are where they should be."""
        return self.miss < POSITION_TOLERANCE and self.tilt < SOLE_TOLERANCE


@dataclass(frozen=True, eq=False)
class StanceProblem:
    """Target position of a leg's foot. All vectors are in B.

    Attributes:
        geometry: of the leg.
        target: of the foot [m], shape (3,).
        knee_side: level unit vector in which the knee should point, shape (3,).
    """

    geometry: LegGeometry
    target: FloatArray
    knee_side: FloatArray

    def solve(self) -> Stance:
        """The best stance from a few fixed starts, with the knee on the desired side first.

        A stance with the knee on the other side is used only if the limits allow no better one.
        """
        # Takes half a second to import; a robot in a known posture does not need it.
        from scipy.optimize import least_squares  # noqa: PLC0415

        chain, plane, up = self.geometry.chain, self.geometry.plane, self.geometry.up
        lower, upper, columns = chain.lower, chain.upper, list(plane.columns)
        stances: list[Stance] = []
        stretched = chain.stretched(self.geometry.leg.foot, -up, plane.pitch, start=plane.level)
        # Bend that shortens a straight leg to the target's distance.
        reach = float(np.linalg.norm(self.target - plane.hip))
        angle = np.arccos(np.clip(reach / plane.length, 0.0, 1.0))
        bend = np.zeros(len(chain.driven))
        # Turning the hip by a positive angle about `pitch` swings a hanging leg to -pitch x up.
        towards = -np.sign(np.cross(plane.axis, up) @ self.knee_side)
        straight, axes = np.clip(plane.level, lower, upper), chain.pose(plane.level).axes
        for column, turns in zip(plane.pitch, (1.0, -2.0, 1.0), strict=False):
            axis = axes[chain.driven[column]]
            bend[column] = towards * turns * angle * np.sign(axis @ plane.axis)
        # The straight and the stretched leg, each bent to the desired side, then to the other.
        for side, values in product((1.0, -1.0), (straight, stretched)):
            start = np.clip(values + side * bend, lower, upper)[columns]
            solution = least_squares(
                self._residual,
                start,
                jac=self._jacobian,
                bounds=(lower[columns], upper[columns]),
                args=(start,),
                method="dogbox",
                xtol=1e-9,
                ftol=1e-9,
                gtol=1e-12,
                max_nfev=40,
            )
            # Rounded to nanoradians: an idle joint is at zero, not at 1e-17.
            stance = self._stance(np.round(self._values(solution.x), 9) + 0.0)
            if stance.good and stance.knee_ahead >= 0.0:
                return stance
            stances.append(stance)
        return min(
            stances, key=lambda s: (not s.good, s.good and s.knee_ahead < 0.0, s.miss + s.tilt)
        )

    @cached_property
    def _zero(self) -> ChainPose:
        return self.geometry.chain.pose(np.zeros(len(self.geometry.chain.driven)))

    @cached_property
    def _sole_up(self) -> FloatArray:
        """Direction in the last body's frame that points up while its sole is flat."""
        return self._zero.end.rotation.T @ self.geometry.up

    def _values(self, free: FloatArray) -> FloatArray:
        """Values of all driven joints [rad or m]; those that do not move the foot are at rest."""
        values = self.geometry.chain.neutral()
        values[list(self.geometry.plane.columns)] = free
        return values

    def _stance(self, values: FloatArray) -> Stance:
        """Stance at these values of all driven joints [rad or m]."""
        chain, plane, up = self.geometry.chain, self.geometry.plane, self.geometry.up
        pose, tilt, ahead = chain.pose(values), 0.0, 0.0
        foot = pose.point(self.geometry.leg.foot)
        if plane.flat:
            sole_up = pose.end.rotation @ self._sole_up
            tilt = float(np.arctan2(np.linalg.norm(np.cross(sole_up, up)), sole_up @ up))
        if len(plane.pitch) > 1:
            hip, knee = (pose.origins[chain.driven[column]] for column in plane.pitch[:2])
            ahead = float(self.knee_side @ (knee - 0.5 * (hip + foot)))
        return Stance(values, float(np.linalg.norm(foot - self.target)), tilt, ahead)

    def _residual(self, free: FloatArray, start: FloatArray) -> FloatArray:
        """Foot's error over the leg's length, sole's tilt, distance from the start, stacked."""
        pose, plane = self.geometry.chain.pose(self._values(free)), self.geometry.plane
        miss = (pose.point(self.geometry.leg.foot) - self.target) / plane.length
        tilt = pose.end.rotation @ self._sole_up - self.geometry.up
        parts = [miss, tilt] if plane.flat else [miss]
        return np.concatenate([*parts, _REGULARISATION * (free - start)])

    def _jacobian(self, free: FloatArray, start: FloatArray) -> FloatArray:
        """Derivative of `_residual`, shape (residuals, free)."""
        del start
        chain, plane = self.geometry.chain, self.geometry.plane
        pose = chain.pose(self._values(free))
        miss = chain.point_jacobian(pose, pose.point(self.geometry.leg.foot)) / plane.length
        tilt = chain.direction_jacobian(pose, pose.end.rotation @ self._sole_up)
        parts = [miss, tilt] if plane.flat else [miss]
        rows = np.concatenate(parts)[:, list(plane.columns)]
        return np.concatenate([rows, _REGULARISATION * np.eye(len(free))])


_NEWTON_STEPS = 10
"""Most Newton steps from one height to the next."""

_STEP_TOLERANCE = 1e-12
"""Size of all joints' steps below which the search ends [rad or m]."""

_DAMPING = 1e-3
"""Distance from the stretched leg at which steps are damped, over the leg's length."""


def lifted(
    chain: Chain, foot: FloatArray, length: float, posture: FloatArray, heights: FloatArray
) -> FloatArray:
    """Joints that lift the foot to each height in turn, within their limits, shape (k, n).

    Damped Newton steps from each height to the next.

    Args:
        chain: of the leg. foot: in its last body's frame [m], shape (3,). length: of the leg [m].
        posture: of its driven joints at height zero [rad or m], shape (n,).
        heights: of the foot above its position there, in B [m], shape (k,).
    """
    values = posture
    at_rest = chain.pose(posture).point(foot)
    damping = (_DAMPING * length) ** 2 * np.eye(3)
    postures = []
    for height in heights:
        target = at_rest + np.array([0.0, 0.0, height])
        for _ in range(_NEWTON_STEPS):
            pose = chain.pose(values)
            miss = target - pose.point(foot)
            jacobian = chain.point_jacobian(pose, pose.point(foot))
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping, miss)
            values = np.clip(values + step, chain.lower, chain.upper)
            if np.abs(step).max() < _STEP_TOLERANCE:
                break
        postures.append(values)
    return np.array(postures)


SHARE_OF_LEG = 0.8
"""Distance of a standing robot's feet below its hips, over the stretched leg."""

_STRAIGHTER_SHARES = (0.85, 0.9, 0.95, 1.0)
"""Shares tried in turn if joint limits forbid the desired one."""


@dataclass(frozen=True, eq=False)
class Stand:
    """A standing posture.

    Attributes:
        posture: value of every moving joint [rad or m].
        share: distance from hip to foot over that of the stretched leg, of the straightest leg.
        warnings: where limits forbid the desired posture.
    """

    posture: Mapping[str, float]
    share: float
    warnings: tuple[str, ...]


def stand(tree: Tree, trunk: str, legs: Sequence[Leg], share: float = SHARE_OF_LEG) -> Stand:
    """Posture with the trunk level and every foot on one ground plane below its hip.

    The robot has legs. The ground is at a depth at which none is stretched beyond `share` of its
    length; if joint limits forbid that, the legs are straighter. Legs with ankles (five joints or
    more) keep their soles as level as they are at zero. If the limits allow, the knees of a biped
    point forward (B's x) and those of a robot with more legs inwards, as on Solo12. Other joints
    are at zero, or at the limit nearest to it.
    """
    geometries = leg_geometries(tree, trunk, legs)
    stances = tuple(problem.solve() for problem in _problems(geometries, share))
    warnings = [
        f"leg '{geometry.leg.name}' cannot stand level below its hip within its joint limits: its "
        f"foot is {1e3 * stance.miss:.0f} mm off and tilted by {np.degrees(stance.tilt):.1f} deg"
        for geometry, stance in zip(geometries, stances, strict=True)
        if not stance.good
    ]
    for straighter in (longer for longer in _STRAIGHTER_SHARES if warnings and longer > share):
        solved: list[Stance] = []
        for problem in _problems(geometries, straighter):
            solved.append(problem.solve())
            # One leg that fails is enough.
            if not solved[-1].good:
                break
        else:
            warnings = [
                f"joint limits keep the legs from bending to {share:.0%} of their length: "
                f"the robot stands at {straighter:.0%}"
            ]
            stances, share = tuple(solved), straighter
            break
    values = dict(neutral_posture(tree))
    for geometry, stance in zip(geometries, stances, strict=True):
        values.update(zip(geometry.chain.names, map(float, stance.values), strict=True))
    return Stand(tree.complete(values), share, tuple(warnings))


def _problems(geometries: Sequence[LegGeometry], share: float) -> list[StanceProblem]:
    """Each leg's problem, with the ground at `share` of the leg that reaches least."""
    up = geometries[0].up
    ground = max(
        float(up @ geometry.plane.hip) - share * geometry.plane.length - geometry.leg.foot_radius
        for geometry in geometries
    )
    middle = np.mean([geometry.plane.hip for geometry in geometries], axis=0)
    problems = []
    for geometry in geometries:
        leg, plane = geometry.leg, geometry.plane
        # Straight below the hip; the knees of a biped point forward, others inwards.
        target = plane.hip + up * (ground + leg.foot_radius - float(up @ plane.hip))
        inwards = np.sign(plane.forward @ (middle - plane.hip)) or 1.0
        side = plane.forward if len(geometries) == 2 else plane.forward * inwards
        problems.append(StanceProblem(geometry, target, side))
    return problems
