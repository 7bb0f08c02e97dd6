"""Limbs of a robot, and what can be judged of them without knowing which are legs.

Nothing is decided here: `recognition` weighs the findings. Shapes are used for wheels only, because
meshes may be missing or mere placeholders.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from math import inf

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.robot.chain import Chain, chain_of, neutral_posture
from ocs_design.robot.legs import PARALLEL, WORLD, far_ends, farthest_frame, is_wheel
from ocs_design.robot.mass import combine
from ocs_design.robot.tree import Tree


@dataclass(frozen=True, eq=False)
class Limb:
    """A chain that may be a leg, for some direction as up, in the root's frame.

    Attributes:
        base, first, last: indices of the body from which it branches, its first and its last body.
        chain: of its bodies.
        hinges: number of joints, including those that follow another limb's, without a wheel's.
        hip: origin of its first joint [m]. tip: at rest [m].
        axes: of its first two joints at rest, shape (n, 3).
        depth: of the stretched tip below the root's origin [m].
        reach: of the stretched tip below the hip [m].
    """

    base: int
    first: int
    last: int
    chain: Chain
    hinges: int
    hip: FloatArray
    tip: FloatArray
    axes: FloatArray
    depth: float
    reach: float

    @property
    def length(self) -> float:
        """Length from the first joint via all others to the farthest frame of the last body [m]."""
        return self.chain.span(farthest_frame(self.chain.bodies[-1]))


_DEPTH_MIN = 0.6
"""Least depth of a leg's tip below the centre of mass, over its reach."""
_DEPTH_TOLERANCE = 0.35
"""Largest difference of depth between the legs of a robot, over their reach."""
EVEN_TOLERANCE = 0.2
"""Largest difference of depths, or of heights at rest, that count as equal, over the reach."""
_MIRROR_TOLERANCE = 0.06
"""Largest distance of a hip from the mirror image of another, over the reach."""
_COAXIAL_DISTANCE = 0.05
"""Largest distance between the axes of limbs that share a hip, over the spread of all hips."""
_HANGING_HEIGHT = 0.2
"""Least height of a hip above the tip of a limb that hangs at rest, over its reach."""
_TWIN_TOLERANCE = 0.01
"""Largest difference of length between limbs that are alike, over their length."""
_MEETING_DISTANCE = 1e-3
"""Distance within which the ends of two limbs coincide, over the reach."""
_HIP_DISTANCE = 0.3
"""Distance within which two limbs on one axis share a hip, over the spread of all hips."""
_LEG_WORDS = re.compile(
    r"foot|feet|toe|calf|shank|thigh|shin|knee|hip|leg|ankle|tibia|femur|tarsus|paw|hock|sole|coxa|"
    r"hoof|haa|hfe|kfe|hind",
    re.IGNORECASE,
)
_ARM_WORDS = re.compile(
    r"arm(?!ature)|hand(?!le)|finger|wrist|elbow|gripper|thumb|palm|wing|antenna|head|neck|tail|jaw|"
    r"haltere|claw_?[lr]|rotor|propeller|labrum|flipper|fin(?!ger|al)",
    re.IGNORECASE,
)
_HANDS = re.compile(r"hand(?!le)|palm|gripper|wrist", re.IGNORECASE)


class Anatomy:
    """A tree at rest (joints at zero, or at the limit nearest to it), and its limbs."""

    def __init__(self, tree: Tree) -> None:
        self.tree = tree
        self.placements = tree.placements(neutral_posture(tree))
        self.masses = tree.mass_properties_at(self.placements)
        self.robot = combine(self.masses)
        self._known: dict[tuple[float, ...], list[Limb]] = {}
        self.children: dict[int, list[int]] = {}
        for index, body in enumerate(tree.bodies[1:], start=1):
            self.children.setdefault(body.parent, []).append(index)

    def limb(self, base: int, last: int, up: FloatArray) -> Limb:
        """The limb from body `base` to body `last`."""
        first = next(i for i in self.tree.ancestors(last) if self.tree.bodies[i].parent == base)
        chain = chain_of(self.tree, base, last, self.placements)
        end = chain.bodies[-1]
        local = farthest_frame(end)
        rest = chain.pose(chain.neutral())
        hinge = chain.driven[0] if chain.driven else 0
        hip = rest.origins[hinge]
        # Nao's right hip follows the left one, yet is a joint of its leg; in a finger that follows
        # its neighbour, most joints do.
        followers = sum(
            joint.mimic is not None and joint.mimic[0] not in chain.names for joint in chain.joints
        )
        driven = len(chain.driven)
        lowest = float(up @ chain.pose(chain.stretched(local, -up)).point(local))
        return Limb(
            base,
            first,
            last,
            chain,
            driven + (followers if followers < driven else 0) - is_wheel(end),
            hip,
            rest.point(local),
            rest.axes[hinge : hinge + 2],
            -lowest,
            float(up @ hip) - lowest,
        )

    def _all_limbs(self, up: FloatArray) -> list[Limb]:
        """Low, moving limbs of bodies with several of them, or of the root."""
        key = tuple(up)
        if key in self._known:
            return self._known[key]
        ends = far_ends(self.tree)
        limbs = []
        for first, body in enumerate(self.tree.bodies[1:], start=1):
            if body.parent != 0 and len(self.children[body.parent]) < 2:
                continue
            chain = chain_of(self.tree, body.parent, ends[first], self.placements)
            length = chain.span(farthest_frame(chain.bodies[-1]))
            # Fingers, for example, do not even reach down to the centre of mass.
            low = float(up @ (self.placements[first].position - self.robot.com)) < length
            if low and chain.driven:
                limbs.append(self.limb(body.parent, ends[first], up))
        self._known[key] = limbs
        return limbs

    def limbs(self, up: FloatArray) -> list[Limb]:
        """Limbs that stretch well below the centre of mass of the robot and of their carriers."""
        low_limbs = []
        for limb in self._all_limbs(up):
            level = abs(limb.axes[0] @ up) < 0.3
            rolls = limb.hinges == 1 and level and is_wheel(limb.chain.bodies[-1])
            swings = limb.hinges == 1 and level and self.names([limb]) is True
            if limb.reach <= 0.0 or not (limb.hinges >= 2 or rolls or swings):
                continue
            carriers = [self.masses[i] for i in self.tree.ancestors(limb.base)]
            if limb.base != 0 or len(self.children[0]) > 1:
                # A hopper's heavy foot lowers the centre of mass.
                carriers.append(self.robot)
            if all(
                limb.depth + up @ carrier.com > _DEPTH_MIN * limb.reach
                for carrier in carriers
                if carrier.mass > 0.0
            ):
                low_limbs.append(limb)
        return low_limbs

    def share_hips(self, chosen: Sequence[Limb], up: FloatArray) -> bool:
        """Whether every limb shares its hip with another, chosen or not."""
        hips = np.array([limb.hip for limb in chosen])
        return all(
            any(_on_one_hip(one, other, hips) for other in self._all_limbs(up)) for one in chosen
        )

    def is_joined(self, limb: Limb) -> bool:
        """Whether the end of a limb is tied to a body of another limb, or meets one at rest.

        Where a URDF leaves a loop open, exporters write a frame on both sides of the cut.
        """
        inside, above = self.inside([limb]), set(self.tree.ancestors(limb.base))
        for pair in self.tree.loops:
            tied = [self.tree.body_of_link[name] for name in pair]
            for end, beyond in (tied, reversed(tied)):
                if end == limb.last and beyond not in inside | above:
                    return True
        ends = self._fixed_frames(limb.last)
        for other in self._all_limbs(np.array([0.0, 0.0, 1.0])):
            # In planar robots, one leg is behind the other.
            apart = np.linalg.norm(other.hip - limb.hip) > _MIRROR_TOLERANCE * limb.reach
            if other.base == limb.base and other.first != limb.first and apart:
                other_ends = self._fixed_frames(other.last)
                gaps = np.linalg.norm(ends[:, None] - other_ends[None], axis=2)
                if (gaps < _MEETING_DISTANCE * limb.reach).any():
                    return True
        return False

    def _fixed_frames(self, body: int) -> FloatArray:
        """Origins at rest of a body's links, except the one at its joint [m], shape (n, 3)."""
        positions = [placement.position for placement in self.tree.bodies[body].links.values()]
        origins = [
            self.placements[body].point(position) for position in positions if position.any()
        ]
        return np.reshape(origins, (-1, 3))

    def one_of_each_pair(self, chosen: Sequence[Limb], up: FloatArray) -> list[Limb]:
        """The limbs; of those that share a hip only the deepest, or the first in the file."""
        if not self.share_hips(chosen, up):
            return list(chosen)
        hips = np.array([limb.hip for limb in chosen])
        kept: list[Limb] = []
        for limb in sorted(
            chosen, key=lambda candidate: (-round(candidate.depth, 3), candidate.first)
        ):
            if not any(_on_one_hip(limb, other, hips) for other in kept):
                kept.append(limb)
        return kept if len(kept) > 1 else list(chosen)

    def may_stand(self, chosen: Sequence[Limb], up: FloatArray) -> bool:
        """Whether limbs have equal numbers of joints, or are mirror images: a set worth judging."""
        return len({limb.hinges for limb in chosen}) == 1 or self.mirrored(chosen, up)

    def spines(self, sets: Sequence[Sequence[Limb]], up: FloatArray) -> Iterator[Sequence[Limb]]:
        """Sets of legs at both ends of a spine, such as shoulders and pelvis of a dog."""
        for one, other in combinations(sets, 2):
            ends = one[0].base, other[0].base
            if ends[0] == ends[1] or {limb.last for limb in one} & {limb.last for limb in other}:
                continue
            # The bodies between must not be part of either set's legs.
            if self.inside((*one, *other)) & set(ends):
                continue
            mirrored = self.mirrored(one, up) and self.mirrored(other, up)
            if mirrored and reach_alike((*one, *other), EVEN_TOLERANCE):
                yield (*one, *other)

    def single(self, limbs: Sequence[Limb], up: FloatArray) -> Iterator[Sequence[Limb]]:
        """The one leg of a hopper: the only limb, attached to the root."""
        at_root = [limb for limb in limbs if limb.base == 0]
        if len(at_root) == 1 and len(self.children.get(0, ())) <= 2:
            (limb,) = at_root
            if self.names(at_root) is False:
                return
            if up @ (limb.hip - limb.tip) > 0.5 * limb.reach:
                yield at_root

    def mirrored(self, chosen: Sequence[Limb], up: FloatArray) -> bool:
        """Whether the hips are mirror images, or evenly spaced about an upright axis."""
        hips, reach = np.array([limb.hip for limb in chosen]), reach_of(chosen)
        kinds = [(limb.hinges, round(limb.reach / reach, 1)) for limb in chosen]
        middle = hips.mean(axis=0)
        same = all(kind[0] == kinds[0][0] and abs(kind[1] - 1.0) <= 0.1 for kind in kinds)
        if len(chosen) == 2 and same and np.ptp(hips, axis=0).max() < _MIRROR_TOLERANCE * reach:
            # A planar robot, one leg behind the other.
            return True
        for side in np.eye(3)[up == 0.0]:
            if np.ptp(hips @ side) < _MIRROR_TOLERANCE * reach:
                continue
            images = hips - 2.0 * np.outer((hips - middle) @ side, side)
            gaps = np.linalg.norm(images[:, None, :] - hips[None, :, :], axis=2)
            partner = gaps.argmin(axis=1)
            if (gaps.min(axis=1) < _MIRROR_TOLERANCE * reach).all() and all(
                kinds[i][0] == kinds[j][0] and abs(kinds[i][1] - kinds[j][1]) <= 0.1
                for i, j in enumerate(partner)
            ):
                # A row of fingers is symmetric about its middle one; legs are not in rows of three.
                return len(chosen) % 2 == 0
        if len(chosen) < 3:
            return False
        flat = (hips - middle) @ np.eye(3)[up == 0.0].T
        radii = np.linalg.norm(flat, axis=1)
        turns = np.diff(np.sort(np.arctan2(flat[:, 1], flat[:, 0])))
        even = 2.0 * np.pi / len(chosen)
        return bool(np.ptp(radii) < 0.1 * radii.max() and np.abs(turns - even).max() < 0.2)

    def stand_level(self, chosen: Sequence[Limb], up: FloatArray) -> bool:
        """Whether the tips are level and below the hips, at rest or in a posture of the file."""
        reach = reach_of(chosen)
        postures: list[Mapping[str, float]] = [
            neutral_posture(self.tree),
            *self.tree.named_postures.values(),
        ]
        for posture in postures:
            placements = self.tree.placements(posture)
            tips, hips = [], []
            for limb in chosen:
                local = farthest_frame(self.tree.bodies[limb.last])
                tips.append(float(up @ placements[limb.last].point(local)))
                hips.append(float(up @ placements[limb.first].position))
            level = len(chosen) == 1 or np.ptp(tips) < EVEN_TOLERANCE * reach
            if level and min(hips) - max(tips) > 0.2 * reach:
                return True
        return False

    def hanging(self, up: FloatArray) -> list[Limb]:
        """Limbs that clearly hang: alike, equally deep, below their hips at rest; else none.

        If `up` is wrong, two legs of a quadruped may hang by chance; the other two, which are as
        long, then do not.
        """
        kinds: dict[tuple[int, int], list[Limb]] = {}
        for limb in self.limbs(up):
            if limb.hinges >= 2 and up @ (limb.hip - limb.tip) > _HANGING_HEIGHT * limb.reach:
                kinds.setdefault((limb.base, limb.hinges), []).append(limb)
        best: list[Limb] = []
        for kind, limbs in kinds.items():
            deepest = max(limb.depth for limb in limbs)
            even = [limb for limb in limbs if deepest - limb.depth < EVEN_TOLERANCE * limb.reach]
            twins = any(
                abs(one.length - other.length) < _TWIN_TOLERANCE * one.length
                for other in self._all_limbs(up)
                if (other.base, other.hinges) == kind and other not in even
                for one in even
            )
            if len(even) > 1 and not twins and deepest > max((x.depth for x in best), default=-inf):
                best = even
        return best

    def balanced(self, chosen: Sequence[Limb], up: FloatArray) -> bool:
        """Whether the robot's centre of mass is roughly over the hips' polygon, line or point."""
        level = np.eye(3)[up == 0.0]
        hips = np.array([limb.hip for limb in chosen]) @ level.T
        com = level @ self.robot.com
        share = 0.4 if len(chosen) < 3 else 0.1
        return _distance_outside(hips, com) < share * reach_of(chosen)

    def names(self, chosen: Sequence[Limb]) -> bool | None:
        """Whether links and joints have names of legs rather than of arms; None: neither."""
        legs = arms = 0
        for limb in chosen:
            words = " ".join(
                [*limb.chain.names, *(name for body in limb.chain.bodies for name in body.links)]
            )
            score = len(_LEG_WORDS.findall(words)) - len(_ARM_WORDS.findall(words))
            legs, arms = legs + (score > 0), arms + (score < 0)
        for base in {limb.base for limb in chosen}:
            if _HANDS.search(self.tree.bodies[base].name):
                arms += len(chosen)
        return None if legs == arms else legs > arms

    def inside(self, limbs: Sequence[Limb]) -> set[int]:
        """Bodies of limbs, and all their descendants."""
        bodies = {limb.first for limb in limbs}
        for index, body in enumerate(self.tree.bodies):
            if body.parent in bodies:
                bodies.add(index)
        return bodies

    def floats(self) -> bool | None:
        """Whether the robot floats freely in its file; None if the file does not say."""
        root = self.tree.bodies[0]
        return False if WORLD in root.links else self.tree.floats


def sets_of(limbs: Sequence[Limb]) -> Iterator[list[Limb]]:
    """Sets of two or more limbs on one body: those with equally many joints, and all of them."""
    bases: dict[int, list[Limb]] = {}
    for limb in limbs:
        bases.setdefault(limb.base, []).append(limb)
    for group in bases.values():
        kinds: dict[int, list[Limb]] = {}
        for limb in group:
            kinds.setdefault(limb.hinges, []).append(limb)
        alike = []
        for kind in kinds.values():
            deepest = max(limb.depth for limb in kind)
            even = [limb for limb in kind if deepest - limb.depth < _DEPTH_TOLERANCE * limb.reach]
            if len(even) > 1:
                alike.append(even)
        yield from alike
        if len(alike) > 1:
            yield [limb for kind in alike for limb in kind]


def reach_alike(limbs: Sequence[Limb], share: float) -> bool:
    """Whether limbs reach equally deep, within a share of their reach."""
    return float(np.ptp([limb.depth for limb in limbs])) < share * reach_of(limbs)


def reach_of(limbs: Sequence[Limb]) -> float:
    """Reach of the limb that reaches farthest [m]."""
    return max(limb.reach for limb in limbs)


def _on_one_hip(one: Limb, other: Limb, hips: FloatArray) -> bool:
    """Whether two limbs on one side of all hips [m], shape (n, 3), share a nearby axis."""
    between, middle = other.hip - one.hip, hips.mean(axis=0)
    spread = float(np.ptp(hips, axis=0).max())
    return (
        one.first != other.first
        and one.base == other.base
        and float(np.linalg.norm(between)) < _HIP_DISTANCE * spread
        and any(
            abs(axis @ twin) > PARALLEL
            and float(np.linalg.norm(np.cross(axis, between))) < _COAXIAL_DISTANCE * spread
            # The hips of a quadruped's left and right leg share an axis, too.
            and axis @ (one.hip - middle) * (axis @ (other.hip - middle)) > 0.0
            for axis in one.axes
            for twin in other.axes
        )
    )


def _distance_outside(points: FloatArray, point: FloatArray) -> float:
    """Distance of a point, shape (2,), from the convex hull of others, shape (n, 2) [m]."""
    middle = points.mean(axis=0)
    if len(points) == 1:
        return float(np.linalg.norm(point - points[0]))
    order = np.argsort(np.arctan2(*(points - middle).T[::-1]))
    ring = [*points[order], points[order[0]]]
    inside = len(points) > 2
    nearest = np.inf
    for start, end in pairwise(ring):
        edge = end - start
        along = np.clip((point - start) @ edge / max(float(edge @ edge), 1e-300), 0.0, 1.0)
        nearest = min(nearest, float(np.linalg.norm(point - start - along * edge)))
        inside = inside and bool(edge[0] * (point - start)[1] - edge[1] * (point - start)[0] >= 0.0)
    return 0.0 if inside else nearest
