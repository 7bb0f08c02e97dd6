"""Cost of uncertainty: Monte Carlo against open-loop `rollout`, threads, Dask workers, memory.

Ratios of one process on one machine, each case once a round so that other load meets all alike:

    python benchmarks/monte_carlo.py speed      closed loop with everything drawn / open loop
    python benchmarks/monte_carlo.py threads    two threads / one
    python benchmarks/monte_carlo.py workers    two Dask workers / one
    python benchmarks/monte_carlo.py memory     10,000 drops, within 2 GiB
    python benchmarks/monte_carlo.py growth     as many, cut short after 10 ms: does memory grow?
    python benchmarks/monte_carlo.py humanoid DESIGN   128 samples of a design: seconds, memory

Goals: 0.85, 1.9, 1.8 and 2 GiB.
"""

import resource
import sys
import time
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path

import mujoco
import numpy as np
from distributed import LocalCluster
from mujoco.rollout import Rollout
from paired import SOLO12

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from wheels import motor, paper_device

from ocs_design.monte_carlo.campaign import make_campaign
from ocs_design.monte_carlo.outcomes import blocks_of
from ocs_design.monte_carlo.running import BLOCKS_AT_ONCE, Cluster, fly_here, run_campaign
from ocs_design.monte_carlo.uncertainty import Uncertainty
from ocs_design.requirement.froude import default_maneuvers
from ocs_design.requirement.specification import Specification
from ocs_design.requirement.uncertainty import UncertaintySection
from ocs_design.robot.reader import read_robot
from ocs_design.simulation.scenario import Flights
from ocs_design.simulation.simulate import simulate
from ocs_design.simulation.world import start_states
from ocs_design.workflows.flying import read_flights

WORLDS, SECONDS, ROUNDS = 1024, 0.2, 5
DROPS, SHORT = 10_000, 0.01


def drops(until=None):
    """A campaign of drops of Solo12 with the paper's wheels on a motor of some power."""
    robot, device = read_robot(SOLO12), paper_device(drive=motor(2000.0, 1.5, 1.0))
    campaign = make_campaign(
        Flights(robot, device, default_maneuvers(robot)[1:2]),
        can_stand=[True],
        uncertainty=Uncertainty.of(UncertaintySection(), robot, device),
        seed=0,
    )
    (flight,) = campaign.flights
    world = flight.world if until is None else replace(flight.world, duration=until)
    return replace(campaign, flights=(replace(flight, world=world),))


def open_loop_rate(worlds, threads):
    """Physics steps per second of one `rollout` of all worlds."""
    steps = round(SECONDS / worlds[0].model.opt.timestep)
    control = np.repeat(np.stack([w.ctrl for w in worlds])[:, None], steps, axis=1)
    models = [w.model for w in worlds]
    data = [mujoco.MjData(models[0]) for _ in range(threads)]
    with Rollout(nthread=threads if threads > 1 else 0) as pool:
        start = time.perf_counter()
        pool.rollout(models, data, start_states(worlds), control)
        return len(worlds) * steps / (time.perf_counter() - start)


def interleaved(cases):
    """Each case once a round, so that other load on the machine meets all alike."""
    rounds = [{name: case() for name, case in cases.items()} for _ in range(ROUNDS)]
    return {name: np.array([measured[name] for measured in rounds]) for name in cases}


def spread(ratios):
    """Median and range of the rounds."""
    return f"{np.median(ratios):.2f} ({ratios.min():.2f} to {ratios.max():.2f})"


def speed():
    """The same drawn models with nothing but their physics, and with all that acts on them."""
    campaign = drops(SECONDS)
    worlds = [world for n in range(WORLDS) for world in campaign.worlds(campaign.sample(n))]
    plain = [replace(world, imperfections=None) for world in worlds]

    def closed(those):
        start = time.perf_counter()
        recording = simulate(those, threads=2)
        return int(recording.lengths.sum()) * 5 / (time.perf_counter() - start)

    rates = interleaved(
        {
            "open loop": lambda: open_loop_rate(worlds, 2),
            "law alone": lambda: closed(plain),
            "with uncertainty": lambda: closed(worlds),
        }
    )
    print(f"{WORLDS} worlds, 2 threads")
    for name, rate in rates.items():
        print(f"{name:14s}{rate.max():9.0f} steps/s, ratio {spread(rate / rates['open loop'])}")


def threads():
    """Blocks of samples on one thread and on two, building them included."""
    campaign = drops()
    blocks = blocks_of(128)

    def rate(count):
        start = time.perf_counter()
        run_campaign(campaign, blocks, fly=partial(fly_here, threads=count, at_once=BLOCKS_AT_ONCE))
        return 128 / (time.perf_counter() - start)

    rates = interleaved({"one": lambda: rate(1), "two": lambda: rate(2)})
    print(f"two threads over one: {spread(rates['two'] / rates['one'])}")


def workers():
    """The same on Dask workers of one thread each."""
    campaign, blocks = drops(), blocks_of(128, 8)
    with (
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as single,
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as double,
    ):

        def rate(cluster):
            with closing(Cluster(cluster.scheduler_address)) as own:
                start = time.perf_counter()
                run_campaign(campaign, blocks, fly=own.fly)
                return 128 / (time.perf_counter() - start)

        rates = interleaved({"one": lambda: rate(single), "two": lambda: rate(double)})
    print(f"two workers over one: {spread(rates['two'] / rates['one'])}")


def flown_with_peaks(campaign, blocks, progress, threads=None):
    """Tells the peak of this process each time that twice as many samples are flown."""
    reported = 0
    for block, outcomes in fly_here(campaign, blocks, progress, threads=threads):
        if block.stop >= 2 * reported:
            reported = block.stop
            print(f"{reported:9,} samples: {peak():7.1f} MiB", flush=True)
        yield block, outcomes


def peak():
    """Largest memory that this process ever held [MiB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10


def memory(until=None):
    """Whether the peak grows with the number of samples, and what it comes to."""
    start = time.perf_counter()
    outcomes = run_campaign(drops(until), blocks_of(DROPS), fly=flown_with_peaks)
    took, passed = time.perf_counter() - start, outcomes.passed.mean()
    print(f"{DROPS:,} drops in {took:.0f} s, {peak():.1f} MiB, {passed:.1%} pass")


def growth():
    """The same drops, cut short: what is kept of each is as large."""
    memory(SHORT)


def humanoid(design):
    """Processor seconds of a sample and the peak of this process, on one thread and on two."""
    flights = read_flights(Path(design), Specification())
    campaign = make_campaign(
        flights,
        can_stand=[False for _ in flights.maneuvers],
        uncertainty=Uncertainty.of(flights.uncertainty, flights.robot, flights.device),
        seed=0,
    )
    for count in (1, 2):
        start, clock = time.process_time(), time.perf_counter()
        run_campaign(campaign, blocks_of(128), fly=partial(flown_with_peaks, threads=count))
        used, took = time.process_time() - start, time.perf_counter() - clock
        print(f"{count} threads: {used / 128:.2f} processor seconds a sample, {took:.0f} s in all")


BENCHMARKS = (speed, threads, workers, memory, growth)


if __name__ == "__main__":
    if sys.argv[1:2] == ["humanoid"]:
        humanoid(sys.argv[2])
    else:
        for wanted in sys.argv[1:]:
            next(each for each in BENCHMARKS if each.__name__ == wanted)()
