"""Recognises a robot's trunk and legs, with a confidence, and asks the user if that is too low.

Every reading of a robot (a body as trunk, some limbs as legs) is judged by a few signs that a
person would look at, too. The confidence is the share of the signs that support it, reduced by
what speaks against it. No sign decides alone: names may mislead, meshes may be missing, and the
zero posture may be anything.
"""

from collections.abc import Container, Iterator, Sequence
from itertools import combinations

import numpy as np

from ocs_design.common.arrays import FloatArray
from ocs_design.common.errors import RobotError
from ocs_design.common.wording import some_of
from ocs_design.robot.legs import frame_link, leg_of
from ocs_design.robot.limbs import EVEN_TOLERANCE, Anatomy, Limb, reach_alike, reach_of, sets_of
from ocs_design.robot.robot import (
    CLOSED,
    JOINED,
    NO_LEGS,
    SPINE,
    Doubt,
    Evidence,
    Leg,
    Reading,
    Recognition,
)
from ocs_design.robot.tree import Tree

SURE = 0.8
"""Least confidence at which the user is not asked."""

_LIKELY = 0.3
"""Least confidence at which a reading is offered as an answer."""

_SHOWN_CONFIDENCE = 0.5
"""Least confidence at which an uncertain reading with legs is shown at all."""


_MOST_ANSWERS = 3
"""Most answers that are shown."""

_SPECIFIED = (Evidence("stated", "", holds=True),)

_FIXED = "the robot is fixed to the world in its file"

NAMES = "they have names of legs"

_SPINE = (Doubt(SPINE, 0.7),)


def recognise(
    tree: Tree, *, trunk: str | None = None, legs: Sequence[str] | None = None
) -> Recognition:
    """Trunk and legs of a robot.

    Args:
        tree: of the robot.
        trunk: link that the user named; None: found.
        legs: links that the user named, one per foot; empty: the robot has none; None: found.

    Raises:
        RobotError: named legs cannot be legs.
    """
    anatomy = _Readings(tree, trunk)
    given = (("trunk", trunk is not None), ("legs", legs is not None))
    specified = frozenset(what for what, is_given in given if is_given)
    if legs is not None:
        unaided = recognise(tree, trunk=trunk)
        first = next(
            (reading.legs for reading in (unaided.reading, *unaided.likely) if reading.legs), ()
        )
        found_legs = unaided.reading.legs if legs else ()
        if not legs:
            named = Reading(trunk or anatomy.heaviest, (), _SPECIFIED)
        elif {leg.name for leg in found_legs} == set(legs):
            named = anatomy.specified(trunk, found_legs)
        else:
            named = anatomy.named(trunk, legs, anatomy.up_of(first[0]) if first else None)
        # With a spine, the legs do not determine which of its ends carries the device.
        ends = {leg.base for leg in named.legs} if trunk is None else set()
        heaviest = sorted(ends, key=lambda body: -anatomy.masses[body].mass)
        spine = tuple(
            Reading(frame_link(tree.bodies[i]), named.legs, _SPECIFIED, _SPINE) for i in heaviest
        )
        return Recognition(named, spine if len(spine) > 1 else (), specified)
    readings = anatomy.readings()
    if trunk is not None:
        # If the trunk is named, doubts about it are settled.
        body = tree.body_of_link[trunk]
        readings = [anatomy.on_trunk(reading, trunk, body) for reading in readings]
    likely = [reading for reading in readings if reading.confidence >= _LIKELY]
    # Unconvincing limbs with names of arms are arms, but not those with names of legs.
    arms = not any(_sign_holds(reading, NAMES) for reading in readings) and all(
        _sign_holds(reading, NAMES) is False for reading in likely
    )
    legless = anatomy.without_legs(trunk, likely=not arms)
    best = _best(readings) if readings else legless
    if best.confidence >= SURE and best.legs:
        return Recognition(best, (), specified)
    if legless.confidence >= SURE and arms:
        return Recognition(legless, (), specified)
    offered = list({id(reading): reading for reading in (best, *likely)}.values())
    if all(reading.legs for reading in offered):
        offered.append(legless)
    root = frame_link(tree.bodies[0])
    if trunk is None and legless in offered and legless.trunk != root:
        # An upper body's heaviest link is its chest, but its pelvis may be the intended trunk.
        offered.append(anatomy.without_legs(None, likely=not arms, body=root))

    # This is a tool for legged robots: legs come first, unless they have names of arms. Of trunks
    # that are as likely, the root is usually meant.
    offered.sort(
        key=lambda reading: (
            not reading.legs or _sign_holds(reading, NAMES) is False,
            -round(reading.confidence, 9),
            bool(reading.legs),
            reading.trunk != root,
        )
    )
    # Commands that only show the robot, and need no certainty, show the likeliest reading.
    shown = next(
        reading
        for reading in offered
        if not reading.legs or reading.confidence >= _SHOWN_CONFIDENCE
    )
    return Recognition(shown, tuple(offered), specified)


def question_about(recognition: Recognition) -> RobotError:
    """Question to the user about an uncertain robot, with the likely answers."""
    best = recognition.likely[0]
    against = [
        *(doubt.what for doubt in best.doubts),
        *(sign.against for sign in best.signs if sign.holds is False),
    ]
    text = (
        f"{len(best.legs)} legs ({some_of([leg.name for leg in best.legs], most=6)}) on "
        f"'{best.trunk}'"
        if best.legs
        else f"no legs, and '{best.trunk}' as the trunk"
    )
    answers = "; or ".join(
        f"{reading.options} ({reading.confidence:.0%})" if reading.legs else reading.options
        for reading in recognition.likely[:_MOST_ANSWERS]
    )
    none = f"; or --legs {NO_LEGS}" if f"--legs {NO_LEGS}" not in answers else ""
    why = "; ".join(against) or "nothing certain"
    return RobotError(
        f"trunk and legs are not clear: most likely {text}, at {best.confidence:.0%} "
        f"confidence ({SURE:.0%} needed). Against it: {why}",
        hint=f"say which: {answers}{none}. `inspect ROBOT --picture FILE.svg` draws them",
    )


def _sign_holds(reading: Reading, what: str) -> bool | None:
    """Whether one sign of a reading holds."""
    return next((sign.holds for sign in reading.signs if sign.what == what), None)


def _best(readings: Sequence[Reading]) -> Reading:
    """The reading of highest confidence, or a sufficiently confident one with more legs."""
    best = max(readings, key=lambda reading: reading.confidence)
    bodies = {leg.body for leg in best.legs}
    larger = [
        reading
        for reading in readings
        if bodies < {leg.body for leg in reading.legs}
        and reading.confidence >= min(best.confidence, SURE)
    ]
    return max(larger or [best], key=lambda reading: (reading.confidence, len(reading.legs)))


def _drop(up: FloatArray, limbs: Sequence[Limb]) -> float:
    """How far limbs hang along an axis at rest, on average [m]."""
    return float(np.mean([up @ (limb.hip - limb.tip) for limb in limbs]))


_UPS = np.eye(3)[[2, 1, 0]]

_ALIGNED = 0.999
"""Least product of two unit vectors that count as one axis (3 degrees)."""

_LONGER = 1.2
"""Ratio by which legs must be longer along another axis for that to be up."""

_LIGHT_TRUNK = 0.2
"""Share of the mass that is carried, below which the legs seem to be most of the robot."""


_GROUNDED = 0.25
"""Height of the hips above a frame, over the legs' reach, from which it seems to be on the ground.

The frames of public robots' trunks are less than 0.01 below the hips, or above them.
"""


class _Readings(Anatomy):
    """Possible readings of a tree.

    Attributes:
        ups: axes of the root that may point up, the likeliest first, shape (n, 3).
    """

    def __init__(self, tree: Tree, trunk: str | None) -> None:
        super().__init__(tree)
        self.ups = _UPS
        if trunk is not None:
            # The user names a frame whose z points up.
            index = tree.body_of_link[trunk]
            frame = self.placements[index] @ tree.bodies[index].links[trunk]
            axis = int(np.argmax(np.abs(frame.rotation[:, 2])))
            first = np.eye(3)[axis] * np.sign(frame.rotation[axis, 2])
            self.ups = np.array([first, *(up for up in _UPS if (up != first).any())])

    def link_of(self, trunk: int, limbs: Sequence[Limb], up: FloatArray) -> str:
        """Link whose frame represents a trunk with legs; heights are those of its origin.

        A root on the ground, such as `base_footprint`, would give the robot no height: then it is
        the trunk's heaviest link, if its axes are the root's.
        """
        body, placement = self.tree.bodies[trunk], self.placements[trunk]
        root, heaviest = frame_link(body), max(body.link_masses, key=body.link_masses.__getitem__)
        hips = float(np.mean([up @ limb.hip for limb in limbs]))
        least = hips - _GROUNDED * reach_of(limbs)
        heights = [float(up @ (placement @ body.links[name]).position) for name in (root, heaviest)]
        turned = body.links[root].rotation.T @ body.links[heaviest].rotation
        aligned = bool((np.abs(turned).max(axis=0) > _ALIGNED).all())
        return heaviest if heights[0] < least < heights[1] and aligned else root

    @property
    def heaviest(self) -> str:
        """Link of the heaviest body."""
        return frame_link(max(self.tree.bodies, key=lambda body: body.mass_properties.mass))

    def up_of(self, leg: Leg) -> FloatArray:
        """Up of a leg in the root's frame, shape (3,)."""
        return np.round(self.placements[leg.base].rotation @ leg.up, 9)

    def readings(self) -> list[Reading]:
        """Every reading with legs, each set of feet once."""
        by_feet: dict[frozenset[int], Reading] = {}
        # Files of other conventions are rare: other axes are tried only if nothing hangs along z.
        upright, hanging_limbs = next(self._hanging_along(self.ups), (self.ups[0], []))
        for up in upright[None] if hanging_limbs else self.ups:
            by_feet.update(self._readings_along(up, hanging_limbs, by_feet))
            if any(candidate.confidence >= _LIKELY for candidate in by_feet.values()):
                break
        # An axis that points down, such as a camera's y, is up only if that settles the matter.
        if all(candidate.confidence < SURE for candidate in by_feet.values()):
            downwards = list(self._hanging_along(-self.ups))
            for up, limbs in sorted(downwards, key=lambda pair: _drop(*pair))[-1:]:
                along = self._readings_along(up, limbs, {})
                by_feet.update((k, v) for k, v in along.items() if v.confidence >= SURE)
        readings = list(by_feet.values())
        # For robots with a spine, its other ends as trunk.
        for candidate in by_feet.values():
            spine = any(doubt.what == SPINE for doubt in candidate.doubts)
            for base in sorted({leg.base for leg in candidate.legs}) if spine else ():
                name = frame_link(self.tree.bodies[base])
                if name != candidate.trunk:
                    lighter = Doubt(f"'{name}' is lighter than '{candidate.trunk}'", 0.9)
                    doubts = (*candidate.doubts, lighter)
                    readings.append(Reading(name, candidate.legs, candidate.signs, doubts))
        return readings

    def _hanging_along(self, ups: FloatArray) -> Iterator[tuple[FloatArray, list[Limb]]]:
        """Axes along which limbs clearly hang, each with its limbs; or along which they lie."""
        for up in ups:
            if limbs := self.hanging(up):
                upright = self._upright(limbs, up)
                yield upright, [self.limb(limb.base, limb.last, upright) for limb in limbs]

    def _readings_along(
        self, up: FloatArray, hanging: list[Limb], known: Container[frozenset[int]]
    ) -> dict[frozenset[int], Reading]:
        """Readings with `up` upwards, by their feet; without those whose feet are `known`.

        `hanging`: limbs that clearly hang along it, if any.
        """
        by_feet: dict[frozenset[int], Reading] = {}
        limbs = self.limbs(up)
        sets = [group for group in sets_of(limbs) if self.may_stand(group, up)]
        # Legs that differ, such as a prosthesis, are recognised by their names alone.
        named = [limb for limb in limbs if self.names([limb])]
        bases = {group[0].base for group in sets}
        named = [limb for limb in named if not bases & self.inside([limb])]
        for base in sorted({limb.base for limb in named}):
            unlike = [limb for limb in named if limb.base == base]
            if unlike not in sets:
                sets.append(unlike)
        sets += [hanging] if hanging else []
        sets = [self.one_of_each_pair(group, up) for group in sets]
        for chosen in (*sets, *self.spines(sets, up), *self.single(limbs, up)):
            feet = frozenset(limb.last for limb in chosen)
            ordered = sorted(chosen, key=lambda limb: limb.last)
            legs = tuple(
                leg_of(self.tree, limb.base, limb.last, up, self.placements) for limb in ordered
            )
            if feet in known or feet in by_feet or any(leg.length <= 0.0 for leg in legs):
                continue
            trunk = self._spine_trunk([limb.base for limb in chosen])
            signs, doubts = self._signs(chosen, sets, up)
            reading = Reading(self.link_of(trunk, chosen, up), legs, signs, doubts)
            # If `up` is wrong, some limbs hang by chance.
            if (up == self.ups[0]).all() or hanging or _sign_holds(reading, NAMES):
                by_feet[feet] = reading
        return by_feet

    def _upright(self, limbs: Sequence[Limb], up: FloatArray) -> FloatArray:
        """Up of a robot that lies down at zero: the axis along which its legs lie and are longest.

        It is `up` itself if the robot stands or crouches at zero.
        """

        def lengths(axis: FloatArray) -> list[float]:
            """Length of each as a leg [m]."""
            legs = (leg_of(self.tree, x.base, x.last, axis, self.placements) for x in limbs)
            return [leg.length for leg in legs]

        drop = np.sum([limb.hip - limb.tip for limb in limbs], axis=0)
        axis = int(np.argmax(np.abs(drop)))
        along = np.asarray(np.eye(3)[axis] * np.sign(drop[axis]))
        is_lying = along @ up < 0.5 and min(lengths(along)) > _LONGER * max(lengths(up))
        return along if is_lying else up

    def without_legs(self, trunk: str | None, *, likely: bool, body: str | None = None) -> Reading:
        """The reading of a robot without legs.

        Args:
            trunk: link that the user named, whose mass and position are not questioned.
            likely: whether some limbs look like legs.
            body: taken as the trunk; None: the heaviest.
        """
        name = trunk or body or self.heaviest
        index = self.tree.body_of_link[name]
        share = self.masses[index].mass / max(self.robot.mass, 1e-300)
        signs = (
            Evidence("no limbs look like legs", "some limbs look like legs", not likely),
            Evidence(
                "the trunk is the root of the file",
                f"'{name}' is not the root of the file",
                index == 0,
            ),
            Evidence(
                "the trunk has a third of the mass",
                f"'{name}' has only {share:.0%} of the mass",
                share > 1 / 3,
            ),
            Evidence("the trunk has a sixth of the mass", "that is not much", share > 1 / 6),
        )
        if trunk is not None:
            return Reading(name, (), signs[:1])
        chain = len(self.tree.bodies) > 2 and all(
            len(children) < 2 for children in self.children.values()
        )
        # A heavy root that carries one chain, such as a pendulum on a cart, is no arm.
        is_arm = chain and self.tree.body_of_link[self.heaviest] > 0
        doubts = (
            *((Doubt("the robot is one chain, as an arm is", 0.6),) if is_arm else ()),
            *((Doubt(_FIXED, 0.75),) if self.floats() is False else ()),
        )
        return Reading(name, (), signs, doubts)

    def on_trunk(self, reading: Reading, trunk: str, body: int) -> Reading:
        """Legs as found, on a trunk that the user named."""
        doubts = tuple(doubt for doubt in reading.doubts if doubt.what != SPINE)
        ancestors = self.tree.ancestors
        if any(
            body != leg.base and body in ancestors(leg.body) and body not in ancestors(leg.base)
            for leg in reading.legs
        ):
            doubts = (*doubts, Doubt(f"'{trunk}' is part of a leg", 0.3))
        return Reading(trunk, reading.legs, reading.signs, doubts)

    def named(
        self, trunk: str | None, names: Sequence[str], up: FloatArray | None = None
    ) -> Reading:
        """The reading that the user specified; `up` is in the root's frame, None if unknown."""
        bodies = [self.tree.body_of_link[name] for name in names]
        for (one, body), (other, twin) in combinations(zip(names, bodies, strict=True), 2):
            if body in self.tree.ancestors(twin) or twin in self.tree.ancestors(body):
                raise RobotError(
                    f"'{one}' and '{other}' are links of one limb",
                    hint="name one link of each leg with --legs: its foot",
                )
        stem = 0 if trunk is None else self.tree.body_of_link[trunk]
        bases = [self._base_of(body, bodies, stem, alone=trunk is None) for body in bodies]
        for name, body, base in zip(names, bodies, bases, strict=True):
            if base < 0 or base == body:
                raise RobotError(
                    f"'{name}' cannot be a leg: no joint moves it relative to the trunk",
                    hint="name the feet with --legs, and the link that carries them with --trunk",
                )
        up = (
            max(self.ups, key=lambda axis: self._hanging_score(bodies, bases, axis))
            if up is None
            else up
        )
        pairs = sorted(zip(bodies, bases, strict=True))
        legs = tuple(leg_of(self.tree, base, body, up, self.placements) for body, base in pairs)
        for leg in legs:
            if leg.length <= 0.0:
                raise RobotError(
                    f"'{leg.name}' cannot be a leg: it does not reach below its hip",
                    hint="name the feet with --legs; `inspect ROBOT --picture FILE.svg` draws all",
                )
        return self.specified(trunk, legs)

    def closed_chain(self, chosen: Sequence[Limb], up: FloatArray) -> str:
        """Sentence on how limbs form closed chains; empty: they do not."""
        if self.share_hips(chosen, up):
            return CLOSED
        return JOINED if any(map(self.is_joined, chosen)) else ""

    def specified(self, trunk: str | None, legs: Sequence[Leg]) -> Reading:
        """The reading with legs that the user specified."""
        up, bases = self.up_of(legs[0]), [leg.base for leg in legs]
        limbs = [self.limb(leg.base, leg.body, up) for leg in legs]
        doubts = (
            *((Doubt(SPINE, 1.0),) if len(set(bases)) > 1 else ()),
            *((Doubt(how, 1.0),) if (how := self.closed_chain(limbs, up)) else ()),
        )
        name = trunk or self.link_of(self._spine_trunk(bases), limbs, up)
        return Reading(name, tuple(legs), _SPECIFIED, doubts)

    def _hanging_score(self, bodies: Sequence[int], bases: Sequence[int], up: FloatArray) -> float:
        """Score of an axis as up: how far the legs hang and reach along it, with z preferred."""
        total = 0.5 * float(up @ self.ups[0]) - 0.1 * up[0]
        for body, base in zip(bodies, bases, strict=True):
            limb = self.limb(base, body, up)
            reach = max(limb.reach, 1e-9)
            total += (float(up @ (limb.hip - limb.tip)) / reach + np.sign(limb.reach)) / len(bodies)
        return float(total)

    def _base_of(self, body: int, feet: Sequence[int], stem: int, *, alone: bool) -> int:
        """The body that the leg to `body` branches from; -1 if there is none.

        It is the first on the way to the root from which other legs or the named trunk branch, too.
        """
        trunks = set() if alone else set(self.tree.ancestors(stem))
        others = [foot for foot in feet if foot != body]
        for above in list(self.tree.ancestors(body))[1:]:
            shared = any(above in self.tree.ancestors(other) for other in others)
            if shared or above in trunks or (not others and alone and above == 0):
                return above
        return -1

    def _spine_trunk(self, bases: Sequence[int]) -> int:
        """Heaviest of the bodies that the legs branch from and of those between them."""
        paths = [list(self.tree.ancestors(base)) for base in set(bases)]
        joint = max(set.intersection(*map(set, paths)))
        between = {body for path in paths for body in path if body >= joint}
        return max(between, key=lambda body: (self.masses[body].mass, -body))

    def _signs(
        self, chosen: Sequence[Limb], sets: Sequence[Sequence[Limb]], up: FloatArray
    ) -> tuple[tuple[Evidence, ...], tuple[Doubt, ...]]:
        inside = self.inside(chosen)
        outside = [i for i in range(len(self.tree.bodies)) if i not in inside]
        heavy = [i for i in outside if self.masses[i].mass > 0.0]
        # The root's origin is often on the ground below the robot.
        points = [self.masses[i].com for i in heavy]
        points += [self.placements[i].position for i in heavy if i > 0]
        lowest = min((float(up @ point) for point in points), default=0.0)
        deep = min(limb.depth for limb in chosen) > -lowest + 0.1 * reach_of(chosen)
        several = len(chosen) > 1
        signs = (
            Evidence(
                "the limbs are mirror images",
                "the limbs are not mirror images",
                self.mirrored(chosen, up),
                2.0,
            )
            if several
            else Evidence(
                "it is the robot's only limb",
                "it is not the robot's only limb",
                len(self.children.get(0, ())) == 1,
                2.0,
            ),
            Evidence(
                "stretched, they reach below everything else",
                "something else is lower than their ends when stretched",
                deep,
                2.0,
            ),
            Evidence(
                "they reach equally deep",
                "they do not reach equally deep",
                reach_alike(chosen, EVEN_TOLERANCE) if several else None,
            ),
            Evidence(
                "their ends stand level in a posture of the file",
                "in no posture of the file do their ends stand level below the hips",
                self.stand_level(chosen, up),
            ),
            Evidence(
                "the centre of mass is between them",
                "the centre of mass is not between them",
                self.balanced(chosen, up),
            ),
            Evidence(NAMES, "they have names of arms", self.names(chosen), 1.5),
            Evidence("the robot is free in its file", _FIXED, self.floats()),
        )
        doubts: list[Doubt] = []
        if len({limb.base for limb in chosen}) > 1:
            doubts.extend(_SPINE)
        if how := self.closed_chain(chosen, up):
            doubts.append(Doubt(how, 0.5))
        if self.names(chosen) is False:
            doubts.append(Doubt("limbs with such names are rarely legs", 0.9))
        if all(limb.hinges == 1 for limb in chosen):
            doubts.append(Doubt("each has a single joint", 0.75))
        if not several and not (signs[-2].holds or signs[-1].holds):
            doubts.append(Doubt("a single limb may just as well be an arm", 0.6))
        left_out = [
            self.tree.bodies[limb.last].name
            for limb in self._all_limbs(up)
            if limb.last not in inside
            and any(
                (limb.base, limb.hinges) == (chosen_limb.base, chosen_limb.hinges)
                for chosen_limb in chosen
            )
            and self.names([limb]) is True
        ]
        if left_out and not self.share_hips(chosen, up):
            what = f"limbs that reach less deep have names of legs, too: {some_of(left_out)}"
            doubts.append(Doubt(what, 0.75))
        rivals = [
            rival
            for rival in sets
            if not self.inside(rival) & inside
            and not any(limb.base in inside for limb in rival)
            and reach_alike((*rival, *chosen), EVEN_TOLERANCE)
            and self.mirrored(rival, up)
            and (self.names(rival) is not False or self.stand_level((*chosen, *rival), up))
        ]
        if rivals:
            names = some_of([self.tree.bodies[limb.last].name for limb in rivals[0]])
            doubts.append(Doubt(f"other limbs reach as deep: {names}", 0.65))
        carried = sum(self.masses[i].mass for i in outside)
        if carried < _LIGHT_TRUNK * self.robot.mass:
            doubts.append(Doubt("what the legs carry is lighter than a fifth of the robot", 0.85))
        return signs, tuple(doubts)
