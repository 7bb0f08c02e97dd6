"""The reserve for sampled errors: margin so that the device works as built, not only as designed.

For each sampled robot, the closed forms of the selection give what its wheels can do within the
time and what is required of them: the factor by which they must exceed a device designed for the
mean. The reserve is the factor with which enough of all robots pass (docs/theory.md, From possible
to sure).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from ocs_design.actuation.drive import PLANNED, Drive, DriveLine
from ocs_design.actuation.spin_root import SweepDemand, capability
from ocs_design.actuation.tilt_inertia import OUT_OF_REACH, TiltInertia
from ocs_design.actuation.unit_drive import UnitDrive
from ocs_design.actuation.wheel_load import WheelTask, momentum_of_each, spin_demand
from ocs_design.common.arrays import FloatArray
from ocs_design.device.records.selection import (
    ManeuverReserveRecord,
    ReserveRecord,
    UncertaintyCost,
)
from ocs_design.requirement.bound import roll_momentum_per_rate
from ocs_design.requirement.froude import Gains
from ocs_design.requirement.maneuver import Built, Maneuver
from ocs_design.requirement.requirement import ManeuverReserve, Requirement
from ocs_design.requirement.uncertainty import UncertaintySection, complete_uncertainty, parts_of
from ocs_design.requirement.vocabulary import RELIABILITY, SAMPLES_DRAWN
from ocs_design.robot.robot import Robot
from ocs_design.robot.stance import LANDING_TOLERANCE
from ocs_design.sizing.selection.demand import (
    HEADINGS,
    roll_cancelling_momentum,
    seen_at,
    wheel_task,
)
from ocs_design.sizing.selection.problem import Candidate, SelectionProblem, inertia_at
from ocs_design.sizing.settling import tilt_left_of

PUSH_OFF_REMAINDER = 0.08
"""Fraction of m v d, the momentum about roll or pitch of a push-off at speed v with the centre of
mass off by d, that remains at lift-off: legs that track their plan absorb the rest."""

FLIGHT_RATIO = 1.03
"""Flight time of a robot that pushes off with four legs, relative to a rigid one's: its feet leave
slightly faster and higher than they land. Solo12 1.058 as designed and 1.042 in the mean of 128
samples, A1 1.038, Go1 1.039, Go2 1.031; the smallest is used."""

TILT_LEFT = 0.4
"""Tilt at touchdown of a robot whose wheels are too weak, relative to the tilt if it stopped
turning in time. The control law lets it keep turning at up to 1 rad/s, so it lands closer to level.
In simulation: 0.3 in drops that would be up to 9 deg off (Solo12, Romeo), 0.45 beyond, 0.3 to 0.4
in back-flips of Solo12. For back-flips it is used only with four legs or more."""

RELIABILITIES = (0.5, 0.8, 0.9, 0.95, 0.99, 0.999)
"""Reliabilities for which the mass is reported."""

NOMINAL = 0.5
"""Reliability of a device that is designed for the mean of all sampled errors, without a
reserve."""

_SEED = 0x5EED0F5E
"""Key of the random generator; no flight uses it, so a device is never sized on the samples that
certify it."""

_KNOTS = np.linspace(0.0, 1.0, 257)
_FACTOR_MIN, _FACTOR_MAX = 0.25, 4.0
"""Range of factors on the demand that is searched."""


@dataclass(frozen=True)
class Reserve:
    """Reserve for the errors of `[reality]`.

    Attributes:
        reliability: fraction of robots that must pass every maneuver.
        scale: factor on every deviation from the mean; above 1 where simulated flights need more.
        maneuvers: the resulting reserve of each, by name; empty until computed (`computed_for`).
    """

    reliability: float
    scale: float = 1.0
    maneuvers: Mapping[str, ManeuverReserve] = field(default_factory=dict)

    def raised(self, factor: float) -> "Reserve":
        """A reserve for deviations larger by this factor, not computed yet."""
        return replace(self, scale=self.scale * factor, maneuvers={})

    def applied_to(self, requirement: Requirement, *, incidence_is_free: bool) -> Requirement:
        """The requirement with this reserve (`Requirement.incidence_is_free`)."""
        return replace(requirement, reserves=self.maneuvers, incidence_is_free=incidence_is_free)

    def computed_for(
        self, errors: "SampledErrors", problem: SelectionProblem, device: Candidate
    ) -> "Reserve":
        """The reserve computed for a device that solves the problem without one."""
        if self.reliability <= NOMINAL or not problem.requirement.maneuvers:
            return self
        return self.covering(errors.needs(problem, device, self, errors.drawn(problem, device)))

    def covering(self, needs: "ReserveNeeds") -> "Reserve":
        """The reserve with which enough of these robots pass."""
        factors, roll_rates = needs.at_reliability(self.reliability)
        short = (factors > 1.0) | (roll_rates > needs.roll_rate_max)
        kept = {
            name: ManeuverReserve(max(factor, 1.0), rate, demand_with_rate, roll_rate, is_short)
            for (name, rate), factor, demand_with_rate, roll_rate, is_short in zip(
                needs.rates.items(),
                factors.tolist(),
                (factors * needs.remaining).tolist(),
                roll_rates.tolist(),
                short.tolist(),
                strict=True,
            )
        }
        return replace(self, maneuvers=kept)


@dataclass(frozen=True, eq=False)
class ReserveNeeds:
    """What sampled robots need.

    Attributes:
        factors: on the nominal maneuver's demand, shape (robots, maneuvers).
        rates: roll and pitch rates that the reserve covers [rad/s], by name.
        achieved: factor that the device achieves, shape (maneuvers,).
        remaining: fraction of `achieved` that remains with these rates, shape (maneuvers,).
        drifts_off: whether a robot ends off level about an axis that the wheels cannot control,
            shape (robots, maneuvers).
        roll_rates: at lift-off that flips must cancel [rad/s], shape (robots, maneuvers).
        roll_rate_max: largest roll rate that the device can cancel [rad/s], shape (maneuvers,);
            inf: none is required.
    """

    factors: FloatArray
    rates: Mapping[str, tuple[float, float]]
    achieved: FloatArray
    remaining: FloatArray
    drifts_off: NDArray[np.bool_]
    roll_rates: FloatArray
    roll_rate_max: FloatArray

    @property
    def reliability(self) -> float:
        """Fraction of the robots that pass every maneuver."""
        passes = (
            (self.factors <= self.achieved)
            & (self.roll_rates <= self.roll_rate_max)
            & ~self.drifts_off
        )
        return float(passes.all(axis=1).mean())

    def at_reliability(self, reliability: float) -> tuple[FloatArray, FloatArray]:
        """Factors and roll rates with which this fraction passes all, each maneuver equally likely.

        The nominal demand is always met, even where a factor below 1 would do, and the device's own
        capacity for roll is always used. Both have the shape (maneuvers,).
        """
        both = np.hstack([self.factors, self.roll_rates])
        met = np.hstack(
            [np.maximum(self.factors, 1.0), np.maximum(self.roll_rates, self.roll_rate_max)]
        )
        low, high = reliability, 1.0
        for _ in range(20):
            chance = (low + high) / 2.0
            passes = met <= np.quantile(met, chance, axis=0, method="higher")
            enough = passes.all(axis=1).mean() >= reliability
            low, high = (low, chance) if enough else (chance, high)
        factors, roll_rates = np.split(np.quantile(both, high, axis=0, method="higher"), 2)
        return factors, roll_rates

    def log_factor(self, reliability: float) -> float:
        """Logarithm of the factor, relative to the device's, that suffices at this reliability."""
        ratio = np.maximum(self.factors / self.achieved, self.roll_rates / self.roll_rate_max)
        # It is zero for maneuvers that demand nothing.
        tiny = np.finfo(np.float64).tiny
        return float(np.quantile(np.log(np.maximum(ratio.max(axis=1), tiny)), reliability))


def reserve_record(
    reserve: Reserve,
    errors: "SampledErrors",
    problem: SelectionProblem,
    device: Candidate,
    resized: Callable[[Reserve], float | None],
    *,
    nominal: float,
) -> ReserveRecord | None:
    """The reserve and its cost; None without maneuvers.

    Args:
        reserve: with which the device was selected.
        resized: mass of the device of the same parts with another reserve [kg]; None: infeasible.
        nominal: mass of the lightest device without a reserve, before refinement [kg].
    """
    if not problem.requirement.maneuvers:
        return None
    drawn = errors.drawn(problem, device)
    needs = errors.needs(problem, device, reserve, drawn)
    curve = {
        level: resized(replace(reserve, reliability=level).covering(needs))
        for level in RELIABILITIES
    }
    reliability = reserve.reliability
    present_mass = curve[reliability] if reliability in curve else resized(reserve.covering(needs))
    # One quantity in turn is measured, so always at its mean.
    known = {
        key: errors.needs(
            problem, device, reserve, {**drawn, key: np.full_like(values, values.mean())}
        )
        for key, values in drawn.items()
    }
    level = max(reserve.reliability, RELIABILITY)
    reductions = {
        key: max(needs.log_factor(level) - without.log_factor(level), 0.0)
        for key, without in known.items()
    }
    total = sum(reductions.values()) or 1.0

    def saved(key: str) -> float:
        if present_mass is None or not has_cost:
            return 0.0
        lighter = resized(reserve.covering(known[key]))
        return 0.0 if lighter is None else max(present_mass - lighter, 0.0)

    has_cost = any(kept.short for kept in reserve.maneuvers.values())
    costs = [
        UncertaintyCost(key=key, share=reduction / total, mass=saved(key))
        for key, reduction in reductions.items()
    ]
    return ReserveRecord(
        reliability=reserve.reliability,
        predicted=needs.reliability,
        scale=reserve.scale,
        nominal=min(nominal, curve[NOMINAL] or nominal),
        maneuvers=tuple(
            ManeuverReserveRecord(
                maneuver=name,
                demand=reserve.maneuvers.get(name, ManeuverReserve()).demand,
                needed=factor,
                roll_rate=roll,
                pitch_rate=pitch,
                undone=undone,
                lost=drifting,
            )
            for (name, (roll, pitch)), factor, undone, drifting in zip(
                needs.rates.items(),
                *(each.tolist() for each in needs.at_reliability(reserve.reliability)),
                needs.drifts_off.mean(axis=0).tolist(),
                strict=True,
            )
        ),
        costs=tuple(sorted(costs, key=lambda cost: -cost.share)),
        curve=tuple((level, mass) for level, mass in curve.items() if mass is not None),
    )


@dataclass(frozen=True, eq=False)
class SampledErrors:
    """Sampled errors of a robot and its device, as far as the closed forms depend on them.

    Attributes:
        specified: section `[reality]`; missing values come from its file or the package.
        height: standing height of the robot [m].
        trunk: second moments of the trunk's mass along x, y and z [kg m^2], shape (3,).
        trunk_mass: mass of the trunk alone, whose centre of mass is off [kg].
        pushes_off: whether jumps start on the ground.
        flight: flight time relative to a rigid robot's.
        gains: of the wheel law.
    """

    specified: UncertaintySection
    height: float
    trunk: FloatArray
    trunk_mass: float
    pushes_off: bool
    flight: float
    gains: Gains

    @classmethod
    def of(
        cls,
        specified: UncertaintySection,
        robot: Robot,
        height: float,
        gains: Gains,
        *,
        ballistic: bool,
    ) -> "SampledErrors":
        """Errors of a robot that stands at this height [m]; `ballistic`: it never pushes off."""
        index = robot.tree.body_of_link[robot.trunk]
        placed = robot.tree.placements_from(robot.trunk, robot.posture)[index].rotation
        body = robot.tree.bodies[index].mass_properties
        inertia = placed @ body.inertia @ placed.T
        moments = np.trace(inertia) / 2.0 - np.diag(inertia)
        legs = 0 if ballistic else len(robot.legs)
        flight = FLIGHT_RATIO if legs > 3 else 1.0
        return cls(specified, height, moments, body.mass, legs > 0, flight, gains)

    def drawn(self, problem: SelectionProblem, device: Candidate) -> Mapping[str, FloatArray]:
        """Sampled values of each key, strata in random order, shape (robots, parts)."""
        motor = Drive.of(device.motor, device.gear, problem.supply.voltage)
        spreads = complete_uncertainty(self.specified, self.height, motor)
        random = np.random.Generator(np.random.Philox(key=_SEED))
        strata, values_by_key = (np.arange(SAMPLES_DRAWN) + 0.5) / SAMPLES_DRAWN, {}
        for key in _RELEVANT_KEYS:
            knots = [getattr(spreads, key).at(knot) for knot in _KNOTS]
            parts = parts_of(key, device.layout.names)
            scores = np.stack([random.permutation(strata) for _ in parts], axis=1)
            values_by_key[key] = np.interp(scores, _KNOTS, knots)
        return values_by_key

    def needs(
        self,
        problem: SelectionProblem,
        device: Candidate,
        reserve: Reserve,
        sampled_values: Mapping[str, FloatArray],
    ) -> ReserveNeeds:
        """What the robots need of a device selected for the problem, and what it can do.

        The reserve's `scale` multiplies the deviations, its reliability sets the rates.
        `sampled_values`: see `drawn`.
        """
        drawn = {
            key: mean + reserve.scale * (values - mean)
            for key, values in sampled_values.items()
            for mean in [values.mean(axis=0)]
        }
        # Voltage lines of all wheels as built: the law commands what the nominal motor can do,
        # and the real one gives k_t / k_t0 times that within its own line. The torque limit already
        # includes mean friction.
        constant = 1.0 + drawn["torque_constant_error"]
        voltage, resistance = 1.0 + drawn["bus_voltage_error"], 1.0 + drawn["resistance_error"]
        nominal, current_ratio = device.line, np.minimum(voltage / resistance, 1.0)
        drag = drawn["coulomb_friction"] + 0.5 * nominal.no_load_speed * drawn["viscous_friction"]
        extra_drag = drag - drag.mean(axis=0)
        line = DriveLine(
            stall_torque=nominal.stall_torque * constant * current_ratio - extra_drag,
            no_load_speed=nominal.no_load_speed * np.minimum(voltage / constant, 1.0),
            torque_limit=nominal.torque_limit * constant - extra_drag,
            speed_max=nominal.speed_max,
            power_max=nominal.power_max * np.minimum(constant, 1.0),
        )
        deviations = NormalDist().inv_cdf(reserve.reliability)
        maneuvers = problem.requirement.maneuvers
        sampled = [
            _SampledManeuver.of(self, problem, device, maneuver, drawn) for maneuver in maneuvers
        ]
        rates = [each.covered_rates(deviations) for each in sampled]
        achieved, with_rate = np.array(
            [each.achieved(rate) for each, rate in zip(sampled, rates, strict=True)]
        ).T
        factors = np.stack(
            [
                each.factors(each.sweeps(line, reserve.reliability), factor)
                for each, factor in zip(sampled, achieved, strict=True)
            ],
            axis=1,
        )
        if reserve.scale > 1.0:
            # Simulated flights needed more than computed here, so factors below 1 are no margin.
            unscaled = self.needs(problem, device, replace(reserve, scale=1.0), sampled_values)
            factors = factors / np.minimum(unscaled.at_reliability(reserve.reliability)[0], 1.0)
        return ReserveNeeds(
            factors=factors,
            rates=dict(zip((maneuver.name for maneuver in maneuvers), rates, strict=True)),
            achieved=achieved,
            remaining=np.array(
                [
                    reduced / full if reduced > 0.0 and np.isfinite(full) else 1.0
                    for reduced, full in zip(with_rate, achieved, strict=True)
                ]
            ),
            drifts_off=np.stack([each.drifts_off for each in sampled], axis=1),
            roll_rates=np.stack([each.roll_rates for each in sampled], axis=1),
            roll_rate_max=np.array([each.roll_rate_max for each in sampled]),
        )


_RELEVANT_KEYS = (
    "mass_error",
    "inertia_error",
    "com_error",
    "incidence_error",
    "torque_constant_error",
    "resistance_error",
    "bus_voltage_error",
    "coulomb_friction",
    "viscous_friction",
    "torque_delay",
    "attitude_bias",
    "takeoff_rate",
)
"""Keys of `[reality]` on which the closed forms depend."""


@dataclass(frozen=True, eq=False)
class _SampledManeuver:
    """One maneuver of the sampled robots.

    Attributes:
        maneuver, requirement, device: what is flown.
        designed_axes: axes of the wheels as designed, shape (3, n).
        nominal: inertia of robot and device as designed.
        inertia: about roll and pitch as built [kg m^2], shape (robots, 2); about yaw too where the
            wheels must act about it.
        swept, momentum: about the same axes, that the wheels must absorb, at each heading that the
            trunk passes, shape (headings, robots, 2 or 3).
        heading_left: by which it turns from each of these until the end [rad], shape (headings,
            robots).
        rates: of roll and pitch at lift-off [rad/s], shape (robots, 2).
        duration: in which it must be done [s], shape (robots, 1).
        share: fraction of the drives' capability that is used.
        tilt_left: fraction of what the wheels miss that remains as tilt at touchdown, see
            `TILT_LEFT`; above 1 on a pivot, where gravity makes a tilt grow.
        axes: of the wheels as built, shape (robots, 2 or 3, n).
        unsettled: roll and pitch at touchdown if the wheels give all that is commanded, by the
            bias of the measurement and by what feedback leaves of a push [rad], shape (robots, 2).
    """

    maneuver: Maneuver
    requirement: Requirement
    device: Candidate
    designed_axes: FloatArray
    nominal: TiltInertia
    inertia: FloatArray
    swept: FloatArray
    momentum: FloatArray
    heading_left: FloatArray
    rates: FloatArray
    duration: FloatArray
    share: float
    tilt_left: float
    axes: FloatArray
    unsettled: FloatArray

    @classmethod
    def of(
        cls,
        errors: SampledErrors,
        problem: SelectionProblem,
        device: Candidate,
        maneuver: Maneuver,
        drawn: Mapping[str, FloatArray],
    ) -> "_SampledManeuver":
        """The maneuver of the sampled robots."""
        at = device.incidence if maneuver.incidence is None else maneuver.incidence
        reached = np.abs(device.layout.axes(at)[:2]).max(axis=1)
        nominal = inertia_at(problem, device, at).within_reach(reached, maneuver.tilt_per_drift)
        # I_xx = S_y + S_z and I_yy = S_x + S_z, of the trunk's second moments S.
        moments = errors.trunk * drawn["inertia_error"]
        from_inertia = moments[:, 2:] + moments[:, 1::-1]
        from_mass = drawn["mass_error"] * np.diag(problem.robot.inertia)[:2]
        diagonal = nominal.diagonal + from_inertia + from_mass
        inertia = TiltInertia(diagonal, np.broadcast_to(nominal.product, len(diagonal)))
        built_errors = Built(
            offset=drawn["com_error"] * (errors.trunk_mass / device.total.mass),
            weight=1.0 + drawn["mass_error"][:, 0] * (problem.robot.mass / device.total.mass),
            bias=drawn["attitude_bias"],
        )
        slew = maneuver.as_built(maneuver.slew(inertia), built_errors)
        speed = maneuver.lift_off
        # A centre of mass off forward pitches the robot in push-off; one off to the left rolls it.
        off = drawn["com_error"][:, 1::-1] if errors.pushes_off else 0.0
        rates = PUSH_OFF_REMAINDER * device.total.mass * speed * off / diagonal
        rates = rates + (drawn["takeoff_rate"] if speed else 0.0)
        time, share = slew.duration, 1.0
        # Measured for falls and pushes, where feedback turns the trunk to level until touchdown.
        reaches_level = not maneuver.estimated and not maneuver.on_pivot
        if maneuver.counts_turns:
            # A robot behind its plan may use the whole flight, but then brakes late, and finishes
            # in time only if the supply absorbs the wheels' energy in the part of the flight after
            # the planned turn.
            energy = 0.5 * device.spin_inertia * device.line.top_speed**2
            flight_time = errors.flight * maneuver.flight_time
            late = energy <= device.line.power_max * (flight_time - time)
            reaches_level = bool(late) and errors.flight > 1.0
            time, share = (flight_time, 1.0) if late else (time, PLANNED)
        # Each module is turned by hand on its foot; shape (robots, 2, n).
        headed = maneuver.has_heading_demand
        built, off = device.layout.axes(at), drawn["incidence_error"][:, None]
        across = np.cross(device.layout.feet(built), built, axis=0)
        axes = (np.cos(off) * built + np.sin(off) * across)[:, : 3 if headed else 2]
        if problem.requirement.detection is not None:
            # Each robot in turn loses another wheel, from the start.
            failed = np.arange(len(axes)) % len(device.layout)
            axes = axes * (np.arange(len(device.layout)) != failed[:, None])[:, None]
            time -= problem.requirement.detection
            reaches_level = False
        unsettled, push = -drawn["attitude_bias"], maneuver.push
        swept, momentum = slew.swept, slew.momentum + diagonal * rates
        turned = np.asarray(maneuver.turned(inertia).diagonal)
        # I_zz = S_x + S_y.
        vertical = device.total.inertia[2, 2] + moments[:, 0] + moments[:, 1]
        vertical = vertical + drawn["mass_error"][:, 0] * problem.robot.inertia[2, 2]
        if headed:
            about_yaw = maneuver.heading(vertical)
            swept, momentum, turned = (
                np.column_stack([tilting, yawing])
                for tilting, yawing in zip(
                    (swept, momentum, turned), (*about_yaw, vertical), strict=True
                )
            )
        headings = np.zeros((1, len(diagonal)))
        if push is not None and not maneuver.on_feet:
            if np.any(slew.yaw):
                headings = slew.headings(vertical, HEADINGS).T
            unsettled = unsettled + tilt_left_of(
                push,
                errors.gains,
                (slew.duration - drawn["torque_delay"])[:, 0],
                acceleration=slew.momentum / (diagonal * push.duration),
                rate=rates,
                yaw_rate=headings[-1] / slew.duration,
            )
        return cls(
            maneuver=maneuver,
            requirement=problem.requirement,
            device=device,
            designed_axes=device.layout.axes(at),
            nominal=nominal,
            inertia=turned,
            # A turn cancels a tilt of the opposite sense.
            swept=seen_at(headings, swept * (-1.0 if push is None else 1.0)),
            momentum=seen_at(headings, momentum),
            heading_left=headings[-1] - headings,
            rates=rates,
            duration=time - drawn["torque_delay"],
            share=share,
            tilt_left=TILT_LEFT if reaches_level else maneuver.growth,
            axes=axes,
            unsettled=unsettled,
        )

    @property
    def yaw_inertia(self) -> float:
        """I_zz of robot and device as designed [kg m^2]."""
        return float(self.device.total.inertia[2, 2])

    @property
    def _turns_over(self) -> bool:
        """Whether roll turns with the trunk (a flip) and the wheels cannot control yaw."""
        without_yaw = bool((np.abs(self.designed_axes[2]) <= OUT_OF_REACH).all())
        return self.maneuver.pitches_over and without_yaw

    @property
    def _cancels_roll(self) -> bool:
        """Whether wheels must cancel roll at lift-off; a flip at its own incidence may leave it."""
        return self._turns_over and bool(self._controlled[0] or self.maneuver.incidence is None)

    @property
    def _controlled(self) -> NDArray[np.bool_]:
        """Whether the wheels control roll and pitch, shape (2,)."""
        return self._reached[:2]

    @property
    def _reached(self) -> NDArray[np.bool_]:
        """Whether they act about each axis that counts, shape (2 or 3,)."""
        reach = np.abs(self.designed_axes[: self.axes.shape[1]]).max(axis=1)
        return np.asarray(reach > OUT_OF_REACH)

    def covered_rates(self, deviations: float) -> tuple[float, float]:
        """Roll and pitch rates covered [rad/s]: this many `deviations`; 0 if out of reach."""
        covered = self._controlled | (self.maneuver.incidence is None)
        covered[0] &= not self._turns_over
        roll, pitch = np.where(covered, deviations * self.rates.std(axis=0), 0.0).tolist()
        return roll, pitch

    def _task(self, rate: tuple[float, float] = (0.0, 0.0)) -> WheelTask:
        """The maneuver as designed, then the same with these rates at its start."""
        reserves = {self.maneuver.name: ManeuverReserve(1.0, rate)}
        requirement = replace(self.requirement, reserves=reserves)
        yaw_inertia, axes = np.array([[self.yaw_inertia]]), self.designed_axes[None, None]
        both = [self.maneuver, self.maneuver]
        return wheel_task(
            both, requirement, self.nominal, yaw_inertia, axes, with_rate=[False, True]
        )

    def achieved(self, rate: tuple[float, float]) -> list[float]:
        """What the device can do, relative to the demand, by the selection's own formula.

        Without a rate at the start, and with this one.
        """
        demand = spin_demand(
            self._task(rate), self.device.line.reserved(), self.device.drive.armature
        )
        capacity = capability(demand, np.asarray(self.device.spin_inertia))
        # Beside a change of rate, a maneuver may ask for nothing.
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = np.where(demand.sweep > 0.0, capacity.sweep / demand.sweep, np.inf)
        return ratio.ravel().tolist()

    def _momentum_per_wheel(self, momentum: FloatArray) -> FloatArray:
        """Momentum of each wheel for a given momentum about roll and pitch, shape (robots, n).

        Axes that the wheels cannot control are ignored.
        """
        reached = self._reached
        return momentum_of_each(self.axes * reached[:, None], momentum * reached)

    def sweeps(self, line: DriveLine, reliability: float) -> tuple[FloatArray, FloatArray]:
        """Sweep required of each wheel and possible [N m s^2], signed, shape (robots, n)."""
        momentum = self.momentum
        if np.quantile(self.roll_rates, reliability) > self.roll_rate_max:
            # Larger wheels would not cancel the roll; that takes other wheels or another incidence.
            momentum = momentum - self.inertia * self.rates * [1.0, 0.0]
        held, load = self._momentum_per_wheel(momentum), self._task().load()
        load = replace(
            load,
            initial_speed=np.asarray(load.initial_speed.flat[0]),
            one_way=bool(np.all(load.one_way)),
        )
        required = self._momentum_per_wheel(self.swept + momentum * self.duration)
        demand = SweepDemand(
            sweep=np.abs(required),
            momentum=np.abs(held),
            duration=self.duration,
            coupling=load.coupling[0],
            armature=np.asarray(self.device.drive.armature),
            least=np.zeros(1),
            drive=UnitDrive.of(*load.from_initial_speed(line.reserved(self.share))),
        )
        possible = capability(demand, np.asarray(self.device.spin_inertia)).sweep
        return required, np.copysign(possible, required)

    def factors(self, sweeps: tuple[FloatArray, FloatArray], achieved: float) -> FloatArray:
        """Factor on the nominal demand with which each robot lands level, shape (robots,).

        Required and possible sweeps are those of each wheel; the device achieves this factor.
        """
        # Robots last, as short last axes are slow.
        required, possible, scale, unsettled, axes = (
            np.ascontiguousarray(np.moveaxis(values, -2 if values.ndim == 3 else 0, -1))
            for values in (
                *sweeps,
                self.tilt_left * self._controlled / self.inertia[:, :2],
                self.unsettled,
                np.moveaxis(self.axes[:, :2], 0, 1),
            )
        )
        sense, robots = np.sign(required), required.shape[-1]
        cosine, sine = np.cos(self.heading_left), np.sin(self.heading_left)
        low, high = np.full(robots, _FACTOR_MIN), np.full(robots, _FACTOR_MAX)
        for _ in range(18):
            factor = np.sqrt(low * high)
            missing = required - possible * (factor / achieved)
            missing = np.where(missing * sense > 0.0, missing, 0.0)
            roll, pitch = np.moveaxis(scale * (axes * missing[:, None]).sum(axis=2), 1, 0)
            # As seen from the heading at the end (`seen_at`).
            turned = np.stack([cosine * roll + sine * pitch, cosine * pitch - sine * roll])
            off = turned.mean(axis=1) + unsettled
            level = (np.abs(off) <= LANDING_TOLERANCE).all(axis=0)
            low, high = np.where(level, low, factor), np.where(level, factor, high)
        # No wheel helps robots whose feedback alone settles too slowly.
        slow = (np.abs(self.unsettled) > LANDING_TOLERANCE) & self._controlled
        return np.where(slow.any(axis=1), _FACTOR_MIN, high)

    @property
    def roll_rates(self) -> FloatArray:
        """Roll rates at lift-off that a flip must cancel [rad/s], shape (robots,)."""
        momentum = np.abs(self.rates[:, 0]) * roll_momentum_per_rate(
            self.inertia[:, 0], self.yaw_inertia
        )
        nominal = roll_momentum_per_rate(self.nominal.diagonal[..., 0], self.yaw_inertia)
        return momentum / nominal if self._cancels_roll else np.zeros(len(momentum))

    @property
    def roll_rate_max(self) -> float:
        """The largest roll rate at lift-off that the device can cancel in a flip [rad/s]."""
        per_rate = roll_cancelling_momentum(
            1.0, self.nominal, self.yaw_inertia, self.designed_axes, self.requirement
        )
        capacity = self.device.spin_inertia * float(self.device.line.reserved().top_speed)
        return capacity / float(per_rate) if self._cancels_roll and per_rate > 0.0 else np.inf

    @property
    def drifts_off(self) -> NDArray[np.bool_]:
        """Whether a robot ends off level whatever its wheels, shape (robots,).

        It drifts about an axis that they do not control, or feedback settles too slowly.
        """
        off = np.where(self._controlled, 0.0, self.rates * self.duration) + self.unsettled
        return np.asarray((np.abs(off) > LANDING_TOLERANCE).any(axis=1))
