"""Inverse kinematics of one standing leg: foot at its place, sole flat, knee to its side."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.robot.stance.chain import Chain, ChainPose
from ocs_design.robot.stance.leg_plane import LegPlane

REACHED = 1e-3
"""A foot is in place within this distance [m]."""

LEVEL = 1e-2
"""A sole is flat within this angle [rad]."""

_SIMPLICITY = 1e-3
"""Weight of staying near the start, relative to the foot's error over the leg's length.

It decides only what the foot leaves open (the yaw of a hip): the foot misses by 1e-6 of its length.
"""


@dataclass(frozen=True, eq=False)
class Stance:
    """A leg's joints when it stands.

    Attributes:
        values: of the leg's driven joints [rad or m].
        miss: distance from the foot to its place [m].
        tilt: of the sole against the ground [rad]; 0 for legs without ankles.
        knee_ahead: how far the knee is on its wanted side of the line from hip to foot [m].
    """

    values: FloatArray
    miss: float
    tilt: float
    knee_ahead: float

    @property
    def good(self) -> bool:
        """Whether foot and sole are where they should be."""
        return self.miss < REACHED and self.tilt < LEVEL


@dataclass(frozen=True, eq=False)
class StanceProblem:
    """Where a leg's foot has to be. All vectors are in the chain's reference frame.

    Attributes:
        chain: the leg.
        plane: its geometry.
        foot: in the last body's frame [m], shape (3,).
        target: of the foot [m], shape (3,).
        up: unit vector against gravity, shape (3,).
        knee_side: level unit vector towards which the knee should point, shape (3,).
    """

    chain: Chain
    plane: LegPlane
    foot: FloatArray
    target: FloatArray
    up: FloatArray
    knee_side: FloatArray

    def solve(self) -> Stance:
        """The best stance from a few fixed starts, knee to the wanted side first.

        A stance with the knee on the other side is taken only if the limits leave no better.
        """
        found: list[Stance] = []
        for start in self._starts():
            stance = self._refined(start)
            if stance.good and stance.knee_ahead >= 0.0:
                return stance
            found.append(stance)
        return min(
            found, key=lambda s: (not s.good, s.good and s.knee_ahead < 0.0, s.miss + s.tilt)
        )

    def _starts(self) -> Iterator[FloatArray]:
        """The straight and the stretched leg, each bent to the wanted side, then to the other."""
        stretched = self.chain.stretched(self.foot, -self.up, self.plane.pitch)
        for side in (1.0, -1.0):
            for values in (self.chain.neutral(), stretched):
                yield np.clip(values + side * self._bend(), self.chain.lower, self.chain.upper)

    def _bend(self) -> FloatArray:
        """Change of the joints' values that shortens a straight leg to the target's distance."""
        reach = float(np.linalg.norm(self.target - self.plane.hip))
        angle = np.arccos(np.clip(reach / self.plane.length, 0.0, 1.0))
        bend = np.zeros(len(self.chain.driven))
        # Turning the hip by a positive angle about `pitch` swings a hanging leg to -pitch x up.
        towards = -np.sign(np.cross(self.plane.axis, self.up) @ self.knee_side)
        for column, turns in zip(self.plane.pitch, (1.0, -2.0, 1.0), strict=False):
            axis = self._zero.axes[self.chain.driven[column]]
            bend[column] = towards * turns * angle * np.sign(axis @ self.plane.axis)
        return bend

    @cached_property
    def _zero(self) -> ChainPose:
        return self.chain.pose(np.zeros(len(self.chain.driven)))

    @cached_property
    def _sole_up(self) -> FloatArray:
        """The last body's direction that points up while its sole is flat, in its frame."""
        return self._zero.end.rotation.T @ self.up

    def _values(self, free: FloatArray) -> FloatArray:
        """All driven joints; what does not move the foot rests."""
        values = self.chain.neutral()
        values[list(self.plane.columns)] = free
        return values

    def _refined(self, start: FloatArray) -> Stance:
        # Half a second to import, and a robot in a known posture does without.
        from scipy.optimize import least_squares  # noqa: PLC0415

        columns = list(self.plane.columns)
        solution = least_squares(
            self._residual,
            start[columns],
            jac=self._jacobian,
            bounds=(self.chain.lower[columns], self.chain.upper[columns]),
            args=(start[columns],),
            method="dogbox",
            xtol=1e-9,
            ftol=1e-9,
            gtol=1e-12,
            max_nfev=40,
        )
        # Whole nanoradians: a joint that has nothing to do is at zero, not at 1e-17.
        return self._stance(np.round(self._values(solution.x), 9) + 0.0)

    def _residual(self, free: FloatArray, start: FloatArray) -> FloatArray:
        """Foot's error over the leg's length, sole's tilt, distance from the start, stacked."""
        pose = self.chain.pose(self._values(free))
        miss = (pose.point(self.foot) - self.target) / self.plane.length
        tilt = pose.end.rotation @ self._sole_up - self.up
        parts = [miss, tilt] if self.plane.flat else [miss]
        return np.concatenate([*parts, _SIMPLICITY * (free - start)])

    def _jacobian(self, free: FloatArray, start: FloatArray) -> FloatArray:
        """Derivative of `_residual`, shape (residuals, free)."""
        del start
        pose = self.chain.pose(self._values(free))
        miss = self.chain.point_jacobian(pose, pose.point(self.foot)) / self.plane.length
        tilt = self.chain.direction_jacobian(pose, pose.end.rotation @ self._sole_up)
        parts = [miss, tilt] if self.plane.flat else [miss]
        rows = np.concatenate(parts)[:, list(self.plane.columns)]
        return np.concatenate([rows, _SIMPLICITY * np.eye(len(free))])

    def _stance(self, values: FloatArray) -> Stance:
        pose = self.chain.pose(values)
        foot = pose.point(self.foot)
        tilt = 0.0
        if self.plane.flat:
            sole_up = pose.end.rotation @ self._sole_up
            tilt = float(np.arctan2(np.linalg.norm(np.cross(sole_up, self.up)), sole_up @ self.up))
        return Stance(
            values, float(np.linalg.norm(foot - self.target)), tilt, self._knee_ahead(pose, foot)
        )

    def _knee_ahead(self, pose: ChainPose, foot: FloatArray) -> float:
        if len(self.plane.pitch) < 2:
            return 0.0
        hip, knee = (pose.origins[self.chain.driven[c]] for c in self.plane.pitch[:2])
        return float(self.knee_side @ (knee - 0.5 * (hip + foot)))
