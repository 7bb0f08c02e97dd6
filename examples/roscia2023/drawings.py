"""Figures 3 to 9 of the paper again, as SVG."""

from collections.abc import Iterator, Sequence
from math import cos, degrees, radians, sin
from pathlib import Path

import numpy as np
from design_figures import INCIDENCE, MOTOR_SPEED, SPIN_INERTIA, abducted, equal_rate
from experiments import RPM, Flights
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from ocs_design.actuation.tilt_inertia import TiltInertia
from ocs_design.requirement.bound import bound_curve
from ocs_design.requirement.pushes import Disturbance
from ocs_design.robot.robot import Robot
from ocs_design.simulation.run import Run

WITH, WITHOUT, THIRD, GREY = "#0072b2", "#d55e00", "#009e73", "#767676"
"""Told apart by colour-blind eyes too (Okabe and Ito)."""

SPEEDS = (1000.0, 3600.0, 7200.0, 14400.0, 28800.0)
"""[rpm] of the bound's curves."""

_STYLE = {
    "font.size": 9.0,
    "svg.hashsalt": "ocs-design",
    "axes.grid": True,
    "grid.color": "#e3e3e3",
}


def draw_all(robot: Robot, flights: Flights, folder: Path) -> Iterator[Path]:
    """Every figure, the same bytes every time."""
    folder.mkdir(parents=True, exist_ok=True)
    with style.context(["default", _STYLE]):
        figures = {
            "bound": bound_figure(),
            "angle": angle_figure(robot),
            "momentum": momentum_figure(robot, flights),
            "disturbance": flight_figure(flights, "disturbance", 0),
            "drop": flight_figure(flights, "drop", 0),
            "back-flip": flight_figure(flights, "back-flip", 2),
        }
        for name, figure in figures.items():
            path = folder / f"{name}.svg"
            figure.savefig(path, metadata={"Date": None})
            yield path


def bound_figure() -> Figure:
    """Figure 3."""
    figure = Figure(figsize=(7.0, 3.6), layout="constrained")
    axes = figure.subplots()
    changes = np.linspace(0.25, 20.0, 80)
    for index, speed in enumerate(SPEEDS):
        color = str(0.65 * index / len(SPEEDS))
        (derived,) = bound_curve(changes, [speed * RPM])
        axes.plot(changes, derived, color=color, label=f"{speed:,.0f} rpm")
        axes.plot(changes, changes / (changes + speed * RPM), color=color, linestyle="--")
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 0.3)
    axes.set_xlim(0.0, 20.0)
    axes.set_xlabel("change of the trunk's rate d [rad/s]")
    axes.set_ylabel("$I_f / I_r$ at least")
    axes.plot([], [], color="0", linestyle="--", label="as printed")
    axes.legend(title="wheel speed", loc="lower right", ncols=2, frameon=False)
    return figure


def angle_figure(robot: Robot) -> Figure:
    """Figures 4 and 5."""
    figure = Figure(figsize=(7.0, 3.4), layout="constrained")
    ellipse, posture = figure.subplots(1, 2)
    _draw_ellipse(ellipse, robot)
    hips = np.linspace(0.0, 1.4, 29)
    angles = [equal_rate(abducted(robot, hip)) for hip in hips]
    posture.plot(np.degrees(hips), angles, color=WITH)
    posture.axhline(degrees(INCIDENCE), color=WITHOUT, linestyle="--")
    posture.text(2.0, degrees(INCIDENCE) + 0.4, "the paper's", color=WITHOUT)
    posture.set_xlabel("abduction of the hips [deg]")
    posture.set_ylabel("α* [deg]")
    return figure


def _draw_ellipse(axes: Axes, robot: Robot) -> None:
    """Seen from above, forward up."""
    roll, pitch = np.diag(robot.inertia)[:2]
    axes.add_patch(Ellipse((0.0, 0.0), 2.0 * pitch, 2.0 * roll, fill=False, color=GREY))
    axes.plot(
        pitch * np.array([1, 1, -1, -1, 1]), roll * np.array([1, -1, -1, 1, 1]), ":", color=GREY
    )
    standing = radians(equal_rate(robot.mass_properties))
    for angle, color, dash, name in (
        (standing, WITH, "-", f"α* = {degrees(standing):.1f}°"),
        (INCIDENCE, WITHOUT, "--", f"the paper's {degrees(INCIDENCE):.0f}°"),
    ):
        reach = 1.15 * float(np.hypot(roll, pitch))
        for side in (1.0, -1.0):
            axes.plot(
                [0.0, side * reach * cos(angle)],
                [0.0, reach * sin(angle)],
                color=color,
                linestyle=dash,
                label=name if side > 0.0 else None,
            )
    axes.set_aspect("equal")
    axes.set_ylim(-2.1 * roll, 1.6 * roll)
    axes.invert_xaxis()
    for each in (axes.xaxis, axes.yaxis):
        each.set_major_formatter(lambda value, _: f"{abs(value):g}")
    axes.set_xlabel("left: $I_{yy}$ [kg m²]")
    axes.set_ylabel("forward: $I_{xx}$ [kg m²]")
    axes.legend(loc="lower center", frameon=False)


def momentum_figure(robot: Robot, flights: Flights) -> Figure:
    """Figure 6: what the wheels hold at 7,200 rpm, and what is asked for."""
    figure = Figure(figsize=(7.0, 3.6), layout="constrained")
    axes = figure.subplots()
    most = 2.0 * SPIN_INERTIA * MOTOR_SPEED * 1e3
    star = radians(equal_rate(robot.mass_properties))
    for angle, color, dash in ((0.0, GREY, ":"), (star, WITH, "-"), (INCIDENCE, WITHOUT, "--")):
        roll, pitch = most * sin(angle), most * cos(angle)
        axes.plot(
            [pitch, 0.0, -pitch, 0.0, pitch],
            [0.0, roll, 0.0, -roll, 0.0],
            color=color,
            linestyle=dash,
            label=f"held at 7,200 rpm, α = {degrees(angle):.1f}°",
        )
    for name, marker in (("disturbance", "o"), ("drop", "s"), ("back-flip", "D")):
        roll, pitch = 1e3 * flights.maneuvers[name].momentum(TiltInertia.of(robot.inertia))
        axes.plot(pitch, roll, marker, color=THIRD, label=f"asked for: {name}")
    axes.set_xlabel("pitch momentum [mN m s]")
    axes.set_ylabel("roll momentum [mN m s]")
    axes.legend(loc="upper right", frameon=False)
    return figure


def flight_figure(flights: Flights, name: str, axis: int) -> Figure:
    """Figures 8 to 10: the centre of mass along x or z, and the pitch."""
    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    for ocs, color, dash, word in ((True, WITH, "-", "with"), (False, WITHOUT, "--", "without")):
        run = flights.runs[name, ocs]
        look = {"color": color, "linestyle": dash, "label": f"{word} the device"}
        above.plot(run.series.time, run.series.com[:, axis], **look)
        below.plot(run.series.time, np.degrees(run.series.pitch), **look)
        _mark_touchdown((above, below), run, color)
    maneuver = flights.maneuvers[name]
    metrics = flights.runs[name, True].metrics
    if isinstance(maneuver, Disturbance) and metrics is not None:
        begin = (metrics.lift_off_time or 0.0) + maneuver.onset
        for axes in (above, below):
            end = begin + maneuver.duration
            axes.axvspan(begin, end, color="#56b4e9", alpha=0.35, linewidth=0.0)
    above.set_ylabel("CoM forward [m]" if axis == 0 else "CoM height [m]")
    below.set_ylabel("pitch [deg]")
    below.set_xlabel("time [s]")
    above.legend(loc="best", frameon=False)
    return figure


def _mark_touchdown(plots: Sequence[Axes], run: Run, color: str) -> None:
    touchdown = run.metrics.touchdown_time if run.metrics else None
    for axes in plots:
        if touchdown is not None:
            axes.axvline(touchdown, color=color, linestyle=":", linewidth=0.9)
