"""The flown wheel law and its plans as C99, traced symbolically from the code that flies it.

NumPy runs `WheelLaw.torque` once on arrays of CasADi symbols. The result is, operation by
operation, what the batch flies: there is no second implementation that could differ.
"""

import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import partial
from itertools import chain
from math import isinf
from pathlib import Path
from typing import Any, TypeVar

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ocs_design.common import quaternions
from ocs_design.common.arrays import FloatArray, stacked_columns
from ocs_design.export.templates import fill
from ocs_design.simulation.desaturation import Desaturation
from ocs_design.simulation.loop import LoopMargins, level_margins, plan_margins
from ocs_design.simulation.schedule import References
from ocs_design.simulation.target import Target
from ocs_design.simulation.wheel_law import WheelLaw
from ocs_design.simulation.world import World

SENSOR_RATES = (200.0, 1000.0)
"""Common IMU rates for which margins are given, besides the design's own rate [1/s]."""


class _Traced(np.ndarray):
    """Array of CasADi scalars: NumPy's functions on it build an expression."""

    def __array_ufunc__(
        self, ufunc: np.ufunc, method: str, *inputs: object, **keywords: object
    ) -> object:
        plain = [np.asarray(value) if isinstance(value, _Traced) else value for value in inputs]
        if method == "__call__" and ufunc in _OPERATIONS:
            return _traced(np.frompyfunc(_OPERATIONS[ufunc], ufunc.nin, 1)(*plain))
        return _traced(getattr(ufunc, method)(*plain, **keywords))

    def __array_function__(
        self,
        function: Callable[..., object],
        types: Iterable[type],
        args: Iterable[object],
        keywords: Mapping[str, object],
    ) -> object:
        if function is np.where:
            condition, one, other = (np.asarray(value) for value in args)
            return _traced(np.frompyfunc(ca.if_else, 3, 1)(condition, one, other))
        if function is np.linalg.norm:
            (vector,) = (np.asarray(value).view(_Traced) for value in args)
            return np.sqrt((vector * vector).sum(**keywords))  # type: ignore[call-overload]
        return _traced(super().__array_function__(function, types, args, keywords))


def _traced(result: object) -> object:
    return result.view(_Traced) if isinstance(result, np.ndarray) else result


_OPERATIONS: Mapping[Any, Callable[..., Any]] = {
    np.minimum: ca.fmin,
    np.maximum: ca.fmax,
    np.sqrt: ca.sqrt,
    np.arctan2: ca.atan2,
    np.sin: ca.sin,
    np.cos: ca.cos,
    np.absolute: ca.fabs,
    np.greater: operator.gt,
    np.greater_equal: operator.ge,
    np.less: operator.lt,
    np.less_equal: operator.le,
    np.invert: ca.logic_not,
    np.bitwise_or: ca.logic_or,
    np.bitwise_and: ca.logic_and,
    np.isinf: lambda value: isinstance(value, float) and isinf(value),
}
"""CasADi's equivalents of NumPy's functions; sums and products use the scalars' own operators."""


def _symbols(name: str, shape: tuple[int, ...]) -> tuple[ca.SX, Any]:
    """Column of symbols, and the same as an array of one world, shape (1, ...)."""
    column = ca.SX.sym(name, int(np.prod(shape)))
    entries = np.empty(column.numel(), dtype=object)
    entries[:] = ca.vertsplit(column)
    return column, entries.reshape(1, *shape).view(_Traced)


Traceable = TypeVar("Traceable")


@dataclass(frozen=True, eq=False)
class _Columns:
    """Numbers that differ between maneuvers, or between the samples of a plan.

    Attributes:
        shapes: by name, in their order in a row.
        rows: one for each maneuver or sample, shape (m, k).
    """

    shapes: Mapping[str, tuple[int, ...]]
    rows: FloatArray

    @classmethod
    def of(cls, tables: Sequence[object], *, fixed: bool = False) -> "_Columns":
        """Columns of the numbers in tables of a single row, without those that are infinite.

        Args:
            tables: of one type.
            fixed: also keep numbers that are the same in all tables.
        """
        values = [dict(_arrays(table)) for table in tables]
        named = {
            name: np.stack([arrays[name][0] for arrays in values]).astype(np.float64)
            for name in values[0]
        }
        kept = {
            name: value
            for name, value in named.items()
            if np.isfinite(value).all() and (fixed or (value != value[0]).any())
        }
        rows = [np.empty((len(tables), 0)), *(v.reshape(len(tables), -1) for v in kept.values())]
        return cls({name: value.shape[1:] for name, value in kept.items()}, np.hstack(rows))

    @property
    def legend(self) -> str:
        """Names and counts, for a comment in the C file."""
        counts = (f"{name} {int(np.prod(shape))}" for name, shape in self.shapes.items())
        return ", ".join(counts)

    def traced(self, table: Traceable) -> tuple[ca.SX, Traceable]:
        """A row of symbols, and the table with these symbols in place of its numbers."""
        parts = {name: _symbols(name, shape) for name, shape in self.shapes.items()}
        column = ca.vertcat(*(part[0] for part in parts.values()))
        # The rest is traced too: a plain array would convert symbols assigned to it to floats.
        rest = {name: value.astype(object).view(_Traced) for name, value in _arrays(table)}
        return column, _replaced(table, {**rest, **{name: part[1] for name, part in parts.items()}})


def _arrays(table: object, prefix: str = "") -> Iterator[tuple[str, NDArray[Any]]]:
    """Arrays of a table and of the tables in it, by name."""
    for field in fields(table):  # type: ignore[arg-type]
        value, name = getattr(table, field.name), prefix + field.name
        if isinstance(value, np.ndarray):
            yield name, value
        elif is_dataclass(value):
            yield from _arrays(value, f"{name}_")


def _replaced(table: Traceable, arrays: Mapping[str, Any], prefix: str = "") -> Traceable:
    """The table with the arrays of these names replaced."""
    changed = {}
    for field in fields(table):  # type: ignore[arg-type]
        value, name = getattr(table, field.name), prefix + field.name
        if name in arrays:
            changed[field.name] = arrays[name]
        elif is_dataclass(value):
            changed[field.name] = _replaced(value, arrays, f"{name}_")
    return replace(table, **changed)  # type: ignore[type-var]


@dataclass(frozen=True, eq=False)
class ManeuverConstants:
    """What differs between maneuvers.

    Attributes:
        law: of the wheels.
        brake: of the wheels in stance, with each setting in an array of one world; None: none.
    """

    law: WheelLaw
    brake: Desaturation | None

    @classmethod
    def of(cls, world: World) -> "ManeuverConstants":
        """Law and brake of a world."""
        desaturation = world.desaturation
        return cls(world.law, None if desaturation is None else stacked_columns([desaturation]))


def targets_of(worlds: Sequence[World], period: float) -> list[list[Target]]:
    """Targets of each world at its control instants since lift-off, until they stop changing."""
    longest = max(world.duration for world in worlds)
    times = period * np.arange(np.ceil(longest / period), dtype=np.float64)
    references = References(worlds, times, period)
    targets: list[list[Target]] = [[] for _ in worlds]
    for k in range(len(times)):
        current = references.at(np.full(len(worlds), k))
        for i, world_targets in enumerate(targets):
            target = current.take(slice(i, i + 1))
            plan = target.plan
            if plan is not None and not plan.holds.any():
                # Unused numbers, which would make a separate row of each instant.
                zeros = {name: np.zeros_like(value) for name, value in _arrays(plan)}
                target = replace(target, plan=_replaced(plan, zeros))
            world_targets.append(target)
    for world_targets in targets:
        rows = _Columns.of(world_targets).rows
        changes = np.flatnonzero((rows != rows[-1]).any(axis=1))
        del world_targets[changes[-1] + 2 if changes.size else 1 :]
    return targets


def law_function(
    worlds: Sequence[World], targets: Sequence[Target], period: float
) -> tuple[ca.Function, _Columns, _Columns]:
    """The law of one control step in CasADi; constants of each world; numbers of each target.

    The function takes attitude, rate, wheel speeds, time on the ground, numbers of a target and
    constants of a maneuver, and returns the motor torques of a robot that has already lifted off.
    """
    flown = [ManeuverConstants.of(world) for world in worlds]
    constants, columns = _Columns.of(flown, fixed=True), _Columns.of(targets)
    constant_row, traced = constants.traced(flown[0])
    target_row, target = columns.traced(targets[0])
    attitude, q = _symbols("attitude", (4,))
    rate, w = _symbols("rate", (3,))
    speed, W = _symbols("wheel_speed", flown[0].law.torque_map.shape[1:2])
    ground, stood = _symbols("ground_time", (1,))
    target = target.landed(stood[:, 0] > 0.0)
    if traced.brake is not None:
        target = replace(target, torque=target.torque + traced.brake.torque(W, stood))
    torque = traced.law.torque(quaternions.vertical(q), w, W, target, period, attitude=q)
    inputs = [attitude, rate, speed, ground, target_row, constant_row]
    return ca.Function("ocs_law", inputs, [ca.vertcat(*np.ravel(torque))]), constants, columns


def write_controller(
    name: str,
    worlds: Mapping[str, World],
    folder: Path,
    *,
    joints: Sequence[str],
    period: float,
    delay: tuple[float, float] | None = None,
) -> None:
    """Write the controller in C, its test harness, its Python binding and a README.

    Args:
        name: of the robot, safe for file names.
        worlds: one for each maneuver with driven wheels, in flight from the start.
        joints: of the wheels, in their order.
        period: of the control steps [s].
        delay: smallest and largest delay from measurement to torque that the design was sized
            for [s]; None: none.
    """
    flown = list(worlds.values())
    targets = targets_of(flown, period)
    function, constants, columns = law_function(flown, list(chain(*targets)), period)
    counts = [len(world_targets) for world_targets in targets]
    identifiers = _identifiers(worlds)
    values = {
        "name": name,
        "wheels": str(function.size1_out(0)),
        "period": repr(period),
        "rate": f"{1.0 / period:g}",
        "maneuvers": "".join(f"    {identifier},\n" for identifier in identifiers),
        "legend": constants.legend,
        "constants": _rows(constants.rows),
        "constant_count": str(constants.rows.shape[1]),
        "target_legend": columns.legend,
        "targets": _rows(columns.rows),
        "target_count": str(max(columns.rows.shape[1], 1)),
        "first": ", ".join(str(int(index)) for index in np.cumsum([0, *counts])),
        "body": _body(function),
        "table": "".join(
            f"| {i} | `{identifier}` | {maneuver} | {1e3 * period * (count - 1):.0f} ms |\n"
            for i, (identifier, maneuver, count) in enumerate(
                zip(identifiers, worlds, counts, strict=True)
            )
        ),
        "margins": _margin_table(worlds, period),
        "delay": "" if delay is None else _DELAY.format(*(1e3 * seconds for seconds in delay)),
        "brake": _NOT_BRAKED if flown[0].desaturation is None else _BRAKED,
        "order": _axes_table(worlds, joints),
    }
    for template, file in _FILES.items():
        (folder / file.format(name)).write_bytes(fill(template, values).encode())


_HEADER_WORDS = {"WHEELS", "PERIOD", "MANEUVERS", "CONTROLLER_H"}
"""Words of the header's own constants, which no maneuver may have."""


def _identifiers(maneuvers: Iterable[str]) -> list[str]:
    """Constant in C of each maneuver: its name, with its index where that alone is not distinct."""
    plain = [re.sub(r"[^A-Z0-9]+", "_", name.upper()).strip("_") for name in maneuvers]
    reserved, identifiers = {*plain, *_HEADER_WORDS}, []
    for index, name in enumerate(plain):
        word = name
        if not name or plain.count(name) > 1 or name in _HEADER_WORDS:
            word = f"{name or 'MANEUVER'}_{index}"
            while word in reserved:
                word += "X"
        identifiers.append(f"OCS_{word}")
    return identifiers


_FILES = {
    "controller/controller.h": "{}_ocs_controller.h",
    "controller/controller.c": "{}_ocs_controller.c",
    "controller/harness.c": "harness.c",
    "controller/binding.pyt": "{}_ocs_controller.py",
    "controller/Makefile": "Makefile",
    "controller/README.md": "README.md",
}
"""File written for each template."""


def _rows(rows: FloatArray) -> str:
    """Initialiser of a table; each number in the fewest digits that read back the same."""
    # No -0.0, which puzzles readers. C has no empty row.
    lines = (", ".join(repr(float(value) + 0.0) for value in row) or "0" for row in rows)
    return "".join(f"    {{{line}}},\n" for line in lines)


def _body(function: ca.Function) -> str:
    """The function's arithmetic in C, without the code that CasADi adds for its own loader."""
    generator = ca.CodeGenerator("ocs_law.c", {"with_header": False})
    generator.add(function)
    match = re.search(
        r"^static int \w+\(.*?\{\n(.*?)^  return 0;\n\}", generator.dump(), re.S | re.M
    )
    assert match, "CasADi writes C in an unknown form"
    assert "casadi_nan" not in match.group(1), "a symbol was taken for a number"
    # None of the pointers is null.
    plain = re.sub(r"arg\[\d\]\? (arg\[\d\]\[\d+\]) : 0", r"\1", match.group(1))
    return re.sub(r"if \(res\[0\]!=0\) ", "", plain).replace("casadi_", "ocs_")


def _margin_table(worlds: Mapping[str, World], period: float) -> str:
    """Margins at the design's own rate and at those of common sensors, as rows of Markdown."""
    loops: dict[str, Callable[[float], LoopMargins]] = {}
    for name, world in worlds.items():
        if world.trajectory is None or world.trajectory.gains is None:
            loops.setdefault("level flight", partial(level_margins, world.law, world.body))
        else:
            loops[f"plan of {name}"] = partial(plan_margins, world.trajectory, world.body)
    rows = []
    for loop, margins in loops.items():
        for rate in sorted({1.0 / period, *SENSOR_RATES}):
            margin, remark = margins(1.0 / rate), " (this design)" if rate == 1.0 / period else ""
            rows.append(
                f"| {loop} | {rate:g} Hz{remark} | {margin.crossover:.2f} rad/s "
                f"| {np.degrees(margin.phase):.1f} deg | {1e3 * margin.delay:.1f} ms |\n"
            )
    return "".join(rows)


_DELAY = "This\ndesign was sized for {:.3g} to {:.3g} ms (`torque_delay` of its `[reality]`)."
_NOT_BRAKED = (
    "This design does not brake the wheels in stance; one sized with `desaturate = true` under\n"
    "  `[validation]` does."
)
_BRAKED = "After some time on the ground it also brakes the wheels (constants `brake_...`)."


def _axes_table(worlds: Mapping[str, World], joints: Sequence[str]) -> str:
    """Markdown table of the wheels' axes; one column per maneuver if modules are turned by hand."""
    axes = {name: world.body.axes for name, world in worlds.items()}
    first = next(iter(axes.values()))
    if all(np.array_equal(matrix, first) for matrix in axes.values()):
        axes = {"": first}
    head = "".join(f" axis in B{', ' if name else ''}{name} |" for name in axes)
    lines = [f"| index | joint |{head}\n", "|---|---|" + "---|" * len(axes) + "\n"]
    for i, joint in enumerate(joints):
        of_each = (", ".join(f"{x + 0.0:.6f}" for x in matrix[:, i]) for matrix in axes.values())
        lines.append(f"| {i} | `{joint}` |" + "".join(f" ({axis}) |" for axis in of_each) + "\n")
    return "".join(lines)
