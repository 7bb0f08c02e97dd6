"""The momentum that the wheels take in each maneuver: as flown, or as asked for."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ocs_design.arrays import FloatArray
from ocs_design.design import SIDES
from ocs_design.report.flight import Flight
from ocs_design.report.story import Story
from ocs_design.sizing.incidence import module_axes


@dataclass(frozen=True, eq=False)
class Taken:
    """Momentum of the wheels in one maneuver.

    Attributes:
        source: name of the maneuver, or of what else asks for it.
        incidence: of the modules in it [rad].
        path: roll and pitch momentum of both wheels together [N m s], shape (n, 2).
    """

    source: str
    incidence: float
    path: FloatArray

    def largest(self, axis: int) -> float:
        """About roll (0) or pitch (1) [N m s]."""
        return float(np.abs(self.path[:, axis]).max())


def taken(story: Story) -> tuple[Taken, ...]:
    """By each flight with the device up to touchdown; where none was flown, what was asked for.

    A motor's choice may turn a robot with less momentum than constant torque one way and then the
    other would take, which is what the demands count: then only flights tell.
    """
    flown = tuple(_flown(story, flight) for flight in story.flights if flight.ocs)
    return flown or (tuple(_asked(story)) if story.design.selection is None else ())


def _flown(story: Story, flight: Flight) -> Taken:
    own = {each.name: each.incidence for each in story.design.requirement.maneuvers}
    stated = own.get(flight.scenario)
    incidence = story.design.ocs.incidence if stated is None else stated
    speeds = [flight.columns[f"wheel_speed_{side}_rad_s"] for side in SIDES]
    along = story.design.ocs.spin_inertia * np.stack(speeds, axis=1)[flight.driven]
    return Taken(flight.scenario, incidence, along @ module_axes(incidence)[:2].T)


def _asked(story: Story) -> Iterator[Taken]:
    for demand in story.design.requirement.demands:
        momentum = np.array([[demand.roll_momentum, demand.pitch_momentum]])
        yield Taken(demand.source, demand.incidence, momentum)
