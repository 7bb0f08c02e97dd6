"""How a sized device does in flight, as designed and, if asked for, as it might be built."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ocs_design.device.answers import MonteCarloRecord
from ocs_design.device.records import SurvivalRecord
from ocs_design.jumping.jump import JumpPlans
from ocs_design.monte_carlo.campaign import Campaign, write_results
from ocs_design.monte_carlo.certificate import (
    ROUND,
    ROUNDS,
    SequentialTest,
    certificate,
    lesson,
)
from ocs_design.monte_carlo.outcomes import Outcomes, blocks_of
from ocs_design.monte_carlo.running import ThisMachine, run_campaign
from ocs_design.monte_carlo.summary import summarised
from ocs_design.report.text.console import Steps
from ocs_design.requirement.specification import RELIABILITY, ValidationSection
from ocs_design.simulation.engine import POSE_RATE
from ocs_design.simulation.scenario import Run
from ocs_design.sizing.on_robot import NeverHeld
from ocs_design.sizing.selection.advice import Refused
from ocs_design.workflows.flying import Flights, control_of, trajectories
from ocs_design.workflows.placed import Placed, references_of, size_on_robot

if TYPE_CHECKING:
    from ocs_design.sizing.trajectory.plans import Reference

CERTIFICATE_FOLDER = "certificate"
"""Folder of the many flights of `--certify`."""


@dataclass(frozen=True, eq=False)
class Certificate:
    """Many flights of a device, and what they say."""

    campaign: Campaign
    outcomes: Outcomes
    record: MonteCarloRecord

    def write(self, folder: Path, design: str) -> None:
        """Write them into a folder of their own below `folder`.

        Args:
            folder: that exists. design: hash of what is flown (`flown_hash`).
        """
        own = folder / CERTIFICATE_FOLDER
        own.mkdir()
        write_results(self.campaign, self.outcomes, self.record, own, design=design)


@dataclass(frozen=True, eq=False)
class Proof:
    """How a device is to fly, how it does as designed, and its certificate.

    Attributes:
        references: turns that the flights track, by the maneuver's name.
        flights: all that they need. runs: as designed; empty if nothing is flown.
        survival: with each drive stopping on the way; None: none has to.
        certificate: None: none was asked for.
    """

    references: Mapping[str, "Reference"]
    flights: Flights
    runs: tuple[Run, ...] = ()
    survival: SurvivalRecord | None = None
    certificate: Certificate | None = None


def prove(placed: Placed, stated: ValidationSection, steps: Steps) -> Proof:
    """Plan the maneuvers and fly them, if that is wanted."""
    requirement, jumps = placed.resolved.requirement, dict[str, JumpPlans]()
    with steps.step("plan the maneuvers"):
        references = references_of(placed, requirement.maneuvers)
    if stated.enabled is not False:
        with steps.step("plan the jumps") as step:
            jumps = {} if placed.jumping is None else dict(placed.jumping.plans())
            others = [name for name, jump in jumps.items() if jump.carrying.legs is None]
            step.note = f"at lift-off starts: {', '.join(others)}" if others else ""
    flights = Flights(
        robot=placed.robot,
        device=placed.designed.device,
        maneuvers=requirement.maneuvers,
        control=control_of(stated, placed.robot),
        references=trajectories(references),
        jumps=jumps,
        detection=requirement.detection,
    )
    if stated.enabled is False:
        return Proof(references, flights)
    runs = flights.fly(steps, pose_rate=POSE_RATE)
    return Proof(references, flights, runs, flights.fly_stopped(steps))


def certify(placed: Placed, proof: Proof, steps: Steps, *, strict: bool) -> tuple[Placed, Proof]:
    """Fly robots as they might be built; what falls short is sized anew with more in reserve.

    Args:
        placed: the device. proof: that it flies as designed.
        steps: are told. strict: warnings are errors.

    Returns:
        Device of the last round and its flights.
    """
    specification = placed.specification
    stated = specification.validation
    test = SequentialTest(placed.resolved.reliability or RELIABILITY)
    told: list[str] = []
    for number in range(1, ROUNDS + 1):
        campaign = proof.flights.campaign(proof.runs, specification.reality, stated.seed or 0)
        with steps.step(f"fly the certificate, round {number}") as step:
            flown = run_campaign(
                campaign,
                blocks_of(test.most, first=number * ROUND),
                workers=ThisMachine(),
                enough=test.decided,
                progress=step.update,
            )
            found = certificate(test, campaign, flown, number=number)
            step.note = f"{found.verdict}, {found.whole:,} of {found.samples:,} pass"
        reserve, learnt = placed.designed.reserve, None
        if found.verdict == "falls short" and number < ROUNDS and reserve is not None:
            learnt = lesson(test, campaign, flown)
            told.append(f"round {number}: {step.note}; {learnt.told}")
        outcomes = flown.take(slice(found.samples))
        found = replace(found, rounds=tuple(told))
        record = replace(summarised(campaign, outcomes, test.most), certificate=found)
        proof = replace(proof, certificate=Certificate(campaign, outcomes, record))
        if reserve is None or learnt is None or learnt.factor == 1.0:
            break
        with steps.step("size the device with more in reserve") as step:
            try:
                again = size_on_robot(
                    specification,
                    placed.robot,
                    strict=strict,
                    reserve=reserve.raised(learnt.factor),
                    estimates=placed.estimates,
                )
            except (Refused, NeverHeld):
                step.note = "nothing has that reserve"
                break
            step.note = again.combinations
        placed, proof = again, prove(again, stated, steps)
    return placed, proof
