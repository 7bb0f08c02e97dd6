"""What the paper says of its three simulations (section 4), flown again."""

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import degrees, pi, sqrt
from pathlib import Path

import mujoco
import numpy as np
from design_figures import paper_wheels
from statements import Statement, number, outcome, taken

from ocs_design import design_ocs, read_specification
from ocs_design.requirement.maneuver import Maneuver
from ocs_design.requirement.pushes import Disturbance
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.turns import Drop, Flip
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Metrics, Run
from ocs_design.simulation.scenario import Flights as Flown
from ocs_design.simulation.scenario import run_scenarios
from ocs_design.simulation.scene import robot_scene
from ocs_design.simulation.world_builder import Options

SPECIFICATION = Path(__file__).resolve().parents[1] / "solo12.toml"
HIGH_JUMP = 4.5
"""[m/s] upwards at lift-off, at which the bare robot does not get up again."""

LEVEL = 5.0
"""[deg]; less counts as none."""

SPINNING = "a wheel that spins fast gains or loses momentum with what is usual"

RPM = pi / 30.0


@dataclass(frozen=True, eq=False)
class Flights:
    """All that is flown, by maneuver and whether the device is there.

    Attributes:
        maneuvers: by name; "high jump" is the disturbance with a higher lift-off.
        runs: see `Run`.
        step: the drop with the device, asked for level at once, as the paper's law has it.
    """

    maneuvers: Mapping[str, Maneuver]
    runs: Mapping[tuple[str, bool], Run]
    step: Run


@cache
def specification() -> Specification:
    """Solo12 with the paper's wheel and its three experiments."""
    return paper_wheels(read_specification(SPECIFICATION))


@cache
def fly() -> Flights:
    """Every experiment with the device and without."""
    stated = specification()
    jump, drop, flip = stated.maneuvers
    forward, _ = jump.takeoff_velocity
    high = replace(jump, name="high jump", takeoff_velocity=(forward, HIGH_JUMP))
    with tempfile.TemporaryDirectory() as folder:
        maneuvers = (jump, drop, flip, high)
        asked = replace(stated, maneuvers=maneuvers)
        outcome = design_ocs(asked, out=Path(folder) / "paper")
    at_once = Options(drop_at_once=True)
    step, _ = run_scenarios(Flown(outcome.robot, outcome.device, [drop], options=at_once))
    height = outcome.robot.standing_height or 0.0
    return Flights(
        {each.name: replace(each, standing_height=height) for each in maneuvers},
        {(run.scenario, run.ocs): run for run in outcome.runs},
        step,
    )


def physics_statements(robot: Robot) -> Iterator[Statement]:
    """Table 3: the simulator, as a model of it says."""
    option = robot_scene(robot).option
    solver, cone, integrator = (
        name_of(kind, value)
        for kind, value in (
            (mujoco.mjtSolver, option.solver),
            (mujoco.mjtCone, option.cone),
            (mujoco.mjtIntegrator, option.integrator),
        )
    )
    other = "another simulator"
    yield taken("step size", f"{option.timestep:g} s")
    for what, stated, found, why in (
        ("real-time update rate", "250", "none", "as fast as it can"),
        ("physics engine", "ODE, in Gazebo", f"MuJoCo {mujoco.__version__}", other),
        ("solver", "Quick (projected Gauss–Seidel)", solver, other),
        ("iterations", "50", f"at most {option.iterations}, to {option.tolerance:g}", other),
        ("successive over-relaxation", "1.3", "none", other),
        ("rescaling of inertias", "no", "no", ""),
        ("friction", "pyramid", cone, ""),
        ("integrator", "not stated", integrator, SPINNING),
    ):
        yield Statement(what, stated, found, why=why)


def name_of(kind: type, value: int) -> str:
    """A choice of MuJoCo in lower case, as in "newton"."""
    return str(kind(value).name).partition("_")[2].lower()


def disturbance_statements() -> Iterator[Statement]:
    """First test."""
    flights = fly()
    jump = flights.maneuvers["disturbance"]
    assert isinstance(jump, Disturbance)
    forward, up = jump.takeoff_velocity
    yield taken("disturbance", f"{jump.torque} N m")
    yield taken("from, after lift-off", f"{jump.onset:g} s")
    yield taken("for", f"{jump.duration:g} s")
    assumed = "assumed: half a second of flight"
    yield Statement(
        "lift-off", "not stated", f"{forward:g} m/s forward, {up:g} m/s up", "", assumed
    )
    for name, which in (("disturbance", ""), ("high jump", f", lift-off at {HIGH_JUMP:g} m/s up")):
        yield outcome(
            f"without the device{which}",
            "falls after touchdown",
            landing(flights, name, ocs=False),
            agrees=not _metrics(flights.runs[name, False]).upright_at_end,
            why="the longer the flight, the further the push turns it",
        )
        yield outcome(
            f"with it{which}",
            "lands safely",
            landing(flights, name, ocs=True),
            agrees=_metrics(flights.runs[name, True]).upright_at_end,
        )
    yield from _motor(flights, "disturbance")


def drop_statements() -> Iterator[Statement]:
    """Second test."""
    flights = fly()
    drop = flights.maneuvers["drop"]
    assert isinstance(drop, Drop)
    bare, turned = (flights.runs["drop", ocs] for ocs in (False, True))
    yield taken("height", f"{drop.height:.1f} m", "of the trunk; the paper does not say of what")
    yield taken("pitch at release", f"{degrees(drop.pitch):.0f}°")
    yield taken("rate at release", "0")
    yield number("pitch at touchdown without the device", "30", _touchdown_pitch(bare), "°")
    yield outcome(
        "pitch at touchdown with it",
        "horizontal",
        f"{abs(_touchdown_pitch(turned)):.1f}°",
        agrees=abs(_touchdown_pitch(turned)) < LEVEL,
    )
    yield outcome(
        "after touchdown without it",
        "the trunk oscillates",
        f"pitch swings over {_swing(bare):.0f}°, CoM moves {_drift(bare):.0f} mm forward",
        agrees=_metrics(bare).upright_at_end,
        why="the legs only hold their posture here; the paper does not state their gains",
    )
    yield outcome(
        "after touchdown with it",
        "oscillations “drastically reduced” in both",
        f"pitch swings over {_swing(turned):.1f}°, CoM moves {_drift(turned):.0f} mm forward",
        agrees=_swing(turned) < 0.5 * _swing(bare) and _drift(turned) < 0.5 * _drift(bare),
    )
    yield from _motor(flights, "drop")
    planned, step = _metrics(turned), _metrics(flights.step)
    more = step.peak_wheel_torque / planned.peak_wheel_torque
    yield Statement(
        "the same with the paper's law and a step command to level",
        "not stated",
        _effort(step),
        why=f"{more:.1f} times the torque of a smooth turn; the paper limits neither",
    )


def flip_statements() -> Iterator[Statement]:
    """Third test."""
    flights = fly()
    flip = flights.maneuvers["back-flip"]
    assert isinstance(flip, Flip)
    bare, turned = (flights.runs["back-flip", ocs] for ocs in (False, True))
    yield taken("gravity", f"{flip.gravity:g} m/s²")
    yield taken("α", f"{degrees(flip.incidence or 0.0):.0f}°")
    yield taken("height of the jump", f"{flip.jump_height:g} m")
    ballistic = "2 √(2 h / g): a jump of 1 m lasts longer; 2 s is one of 0.81 m"
    yield number(
        "time in the air", "2", 2.0 * sqrt(2.0 * flip.jump_height / flip.gravity), "s", ballistic
    )
    yield taken(
        "turn", f"{abs(degrees(flip.angle)):.0f}°", f"here in {flip.duration:g} s of flight"
    )
    yield number("turned with the device", "360", abs(_turned(turned)), "°")
    yield outcome(
        "turned without it",
        "not possible",
        f"{abs(_turned(bare)):.1f}°",
        agrees=abs(_turned(bare)) < LEVEL,
    )
    yield outcome(
        "landing with it",
        "lands",
        landing(flights, "back-flip", ocs=True),
        agrees=_metrics(turned).upright_at_end,
    )
    yield from _motor(flights, "back-flip")


def landing(flights: Flights, name: str, *, ocs: bool) -> str:
    """How a flight ends, in words."""
    metrics = _metrics(flights.runs[name, ocs])
    ends = "stands" if metrics.upright_at_end else "falls"
    pitch, roll = (abs(degrees(a)) for a in (metrics.touchdown_pitch, metrics.touchdown_roll))
    return f"touches down {pitch:.1f}° off in pitch, {roll:.1f}° in roll, and {ends}"


def _motor(flights: Flights, name: str) -> Iterator[Statement]:
    found = _effort(_metrics(flights.runs[name, True]))
    yield Statement("required of the motors", "not stated", found, why="the paper has no motor")


def _effort(metrics: Metrics) -> str:
    return f"{metrics.peak_wheel_speed / RPM:,.0f} rpm, {metrics.peak_wheel_torque:.2f} N m a wheel"


def _metrics(run: Run) -> Metrics:
    if run.metrics is None:
        raise SystemExit(f"{run.scenario}: {run.reason}")
    return run.metrics


def _touchdown_pitch(run: Run) -> float:
    return degrees(_metrics(run).touchdown_pitch)


def _turned(run: Run) -> float:
    return degrees(_metrics(run).turned_angle)


def _after(run: Run) -> np.ndarray:
    """Which instants lie after touchdown."""
    touchdown = _metrics(run).touchdown_time
    return run.series.time > (np.inf if touchdown is None else touchdown)


def _swing(run: Run) -> float:
    """Of the pitch after touchdown [deg]."""
    return degrees(np.ptp(run.series.pitch[_after(run)]))


def _drift(run: Run) -> float:
    """Of the centre of mass forwards after touchdown [mm]."""
    return 1e3 * float(np.ptp(run.series.com[_after(run), 0]))
