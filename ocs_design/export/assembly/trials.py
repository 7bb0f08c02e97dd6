"""Balancing, spin test, resonance sweep and safety of a module, sentence by sentence."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from ocs_design.actuation.fasteners import BoltedJoint
from ocs_design.common.units import STANDARD_GRAVITY, rpm, significant
from ocs_design.device.device import Device
from ocs_design.device.joints import balance_of, burst_of, yield_margin
from ocs_design.device.resonances import DAMPING, Resonance, resonances_of
from ocs_design.export.assembly.content import LEAST_DRILL, Assembly
from ocs_design.export.electrics import demand_of
from ocs_design.parts.carrier_plate import STOCK, plate_part
from ocs_design.parts.guard import stepped
from ocs_design.parts.joints import GRADE
from ocs_design.parts.plate_strength import plate_frequency
from ocs_design.parts.printed import CLEARANCE
from ocs_design.parts.rim import stored_energy

SPIN_STEPS = (0.1, 0.25, 0.5, 0.75, 1.0)
"""Shares of the top speed at which a wheel is run for a minute each."""

SPIN_TEST = 1.1
"""Highest speed of the spin test, relative to the top speed."""

NEAR = 0.15
"""Distance of the largest speed from a mode, relative to the mode, within which it is reported."""

FINE_GRADE = 2.5
"""Balance grade of gas turbines and machine tools (ISO 21940-11), if G 6.3 shakes too much."""

_SOFT = 68.0
"""Heat deflection temperature of PETG at 0.45 MPa [deg C]: Prusament PETG, technical data sheet."""


def balance(assembly: Assembly) -> Iterator[str]:
    """How to balance a wheel, and the vibration by its residual unbalance."""
    wheel, speed = assembly.device.flywheel, assembly.top_speed
    if speed is None:
        return
    balance = balance_of(assembly.device)
    yield (
        f"Grade G {GRADE:g} (ISO 21940-11) at {rpm(speed)}: at most "
        f"{_two(1e6 * balance.unbalance)} g mm are left in one plane, the wheel's own; its "
        f"centre of mass is then {_two(1e6 * balance.eccentricity)} µm off the axis."
    )
    if balance.off_centre is not None:
        unbalance = balance.off_centre * wheel.mass
        yield (
            f"As built it may be {1e6 * balance.off_centre:.0f} µm off, {_two(1e6 * unbalance)} g "
            f"mm (turning, and {balance.centred_by}). So balance it on its motor, and mark "
            "both, so that they go back together the same way."
        )
    holes, cuts = balance.correction, wheel.cuts
    if cuts.holes:
        yield (
            f"Remove mass by deepening the {cuts.holes} balancing holes in a face, a little at "
            "a time, on the heavy side; never to the middle of the rim."
        )
    elif holes.hole_radius >= LEAST_DRILL / 2.0:
        yield (
            f"Remove mass on the heavy side with a drill of {2e3 * holes.hole_radius:.2g} mm, at "
            f"most {1e3 * holes.depth:.2g} mm deep, in both faces of the rim, one hole opposite "
            f"the other, {1e3 * holes.radius:.1f} mm from the axis and {1e3 * holes.apart:.2g} mm "
            f"from the next: a pair this deep removes {_two(1e3 * holes.mass)} g, or "
            f"{_two(1e6 * holes.mass * holes.radius)} g mm; half as deep, half of it. One half of "
            f"the rim has room for {holes.count} pairs, {_two(1e6 * holes.most)} g mm: remake a "
            "wheel that is off by "
            f"more.{'' if wheel.web is None else ' Take nothing off web and hub.'}"
        )
        yield from _at_the_rim(assembly)
    else:
        yield (
            "The rim's wall is too thin to drill by hand: grind the heavy side of its face, "
            "evenly over 60 degrees."
        )
    for mode in resonances_of(assembly.device):
        weights = _two(mode.acceleration / STANDARD_GRAVITY)
        yield (
            f"The {mode.name}'s first mode: {mode.frequency:.0f} Hz, {60.0 * mode.frequency:,.0f} "
            f"rpm. What is left pushes with {_two(mode.force)} N; a wheel held at it shakes "
            f"the module by {_two(1e6 * mode.amplitude)} µm, with {weights} "
            f"times its weight ({DAMPING:.0%} damping, assumed)."
        )
    motor, friction_text = assembly.device.motor, ""
    if motor.no_load_current and motor.torque_constant:
        friction = motor.no_load_current * motor.torque_constant / STANDARD_GRAVITY
        friction_text = (
            " Rolling it on level blades does not find it: the motor's friction alone holds up to "
            f"{significant(1e6 * friction, 2)} g mm."
        )
    yield (
        "Find the heavy side in four runs, with an accelerometer on the clamped foot and at one "
        "steady speed well below the first mode: once as it is, then three times with the same "
        "piece of wax on the rim at 0, 120 and 240 degrees. Draw a circle whose radius is the "
        "first reading, and around its points at those angles circles with the other three "
        "readings: they meet in one point. The heavy side is opposite that point, and the "
        "unbalance is the wax's times the first reading over the point's distance from the "
        f"centre.{friction_text}"
    )


def _at_the_rim(assembly: Assembly) -> Iterator[str]:
    """How to drill both faces of a rim whose inner face is next to the drum's floor."""
    device, mount = assembly.device, assembly.device.mount
    motor_screws = assembly.screws_of(BoltedJoint.MOTOR, BoltedJoint.MOTOR_IN_CAGE)
    if not motor_screws or "drum" not in assembly.numbers:
        return
    fastening = motor_screws[0].fastening
    screws = f"{fastening.count} screws{assembly.number(fastening)}"
    chips = "Chips stick to the motor's magnets: tape over all openings, and drill with it on top."
    back = "Put both back as they were marked, and check the run-out again."
    across, window = device.motor.diameter or 0.0, 2.0 * mount.holes.pilot_radius
    if mount.bell is not None:
        yield (
            f"The inner face is next to the drum's floor: undo the motor's {screws}, unplug it, "
            f"and motor and ring come out of the drum. {chips} {back}"
        )
    elif mount.cage is not None and across < window:
        yield (
            f"The inner face is {1e3 * CLEARANCE:g} mm off the drum's floor: undo the motor's "
            f"{screws}, unplug it, mark how it stood in its cage, and wheel and motor come out "
            f"together on the lid's side, because its {1e3 * across:.1f} mm pass through the "
            f"window of {1e3 * window:.1f} mm. {chips} {back}"
        )
    elif on_rotor := assembly.screws_of(BoltedJoint.WHEEL):
        fastening = on_rotor[0].fastening
        yield (
            f"The inner face is {1e3 * CLEARANCE:g} mm off the drum's floor: mark how the wheel "
            f"stands on the motor, undo its {fastening.count} screws{assembly.number(fastening)}, "
            f"and drill it off its motor. {back}"
        )
    else:
        yield (
            f"The inner face is {1e3 * CLEARANCE:g} mm off the drum's floor, and the motor's "
            f"{screws} are behind the wheel: drill the outer face alone, two holes beside each "
            "other for a pair, half of that room. Hold a vacuum cleaner to the drill, with tape "
            "over the motor's hole, because chips stick to its magnets."
        )


def spin_test(assembly: Assembly) -> Iterator[str]:
    """Spin test of a module behind a wall, before it is mounted on the robot."""
    speed, burst = assembly.top_speed, assembly.burst
    if speed is None or burst is None:
        return
    yield (
        "Clamp the module by its foot on a bench inside a closed steel box or behind steel of "
        f"at least {max(2.0, math.ceil(2e3 * burst.steel)):.0f} mm (twice the wall that holds it, "
        "see Safety) on all sides of the wheel's plane. Nobody stands in that plane. Drive it "
        "from behind the wall; a switch there cuts the supply."
    )
    steps = ", ".join(f"{share:.0%} ({rpm(share * speed)})" for share in SPIN_STEPS)
    # On the bench only its own foot is under it.
    alone = replace(assembly.device, plate=None, pedestals=())
    past = "".join(
        f" Pass quickly through {60.0 * mode.frequency:,.0f} rpm, where the foot shakes."
        for mode in resonances_of(alone)
        if mode.name == "foot"
    )
    yield f"Run one minute each at {steps}; stop, feel the motor and check all screws.{past}"
    motor = assembly.device.motor
    allowed = math.inf if motor.speed_max is None else motor.speed_max
    share = min(SPIN_TEST, allowed / speed)
    over = rpm(share * speed)
    if share < SPIN_TEST:
        over += ", the limit of motor and wheel"
    if motor.bus_voltage is not None and share > 1.0:
        over += f", which takes {share * motor.bus_voltage:.3g} V"
    over += ". Raise the controller's speed limit for it." if share > 1.0 else "."
    if (stressed := yield_margin(assembly.device, share * speed)) is not None:
        where, factor = stressed
        over += f" The yield strength is then {factor:.1f} times the largest stress, in {where}."
    yield f"Once, for ten seconds, {share:.0%}: {over}"
    yield (
        "It fails if anything hums that did not before, if the vibration rises between two "
        "steps other than with the square of the speed, if the run-out has changed, if a screw "
        f"has moved, or if the print at the motor is warmer than {_SOFT - 8:.0f} °C (PETG "
        f"softens at {_SOFT:.0f} °C). Then balance again, or build again."
    )
    yield (
        "Brake from full speed with the battery that will be used, and watch the bus voltage: "
        "it must stay below the limits of controllers and battery."
    )


def sweep(assembly: Assembly) -> Iterator[str]:
    """Sweep for resonances on the robot, and remedies for one near an operating speed."""
    device, top = assembly.device, assembly.top_speed
    modes = resonances_of(device)
    if top is None or not modes:
        return
    flown = demand_of(assembly.margins, "wheel speed")
    reached = flown or top
    most = "what the maneuvers reach at most" if flown else "its top speed"
    rising = sorted(modes, key=lambda mode: mode.frequency)
    computed = ", ".join(f"{mode.name} {60.0 * mode.frequency:,.0f} rpm" for mode in rising)
    yield (
        "Hold the robot by its trunk, lids on, nobody in the wheels' planes, an accelerometer "
        "taped to one foot. Run that module's wheel alone from standstill to "
        f"{rpm(reached)}, {most}, in about a minute; then the others. "
        f"Write down where each shakes most. Computed speeds: {computed}; a trunk or screws that "
        "give make them lower, and damping is assumed."
    )
    fastest = "The largest speed of the maneuvers" if flown else "The wheel's top speed"
    for mode in modes:
        off = reached / (2.0 * math.pi * mode.frequency) - 1.0
        if 0.0 < abs(off) < NEAR:
            yield (
                f"{fastest}, {rpm(reached)}, is {abs(off):.0%} "
                f"{'above' if off > 0.0 else 'below'} the {mode.name}'s mode: it shakes the module "
                f"with {_two(mode.acceleration_at(reached) / STANDARD_GRAVITY)} times its weight, "
                f"and at the mode itself with {_two(mode.acceleration / STANDARD_GRAVITY)} times."
            )
    where = "stem of the foot" if device.plate is None else "plate beside its feet"
    cures = [
        f"balance that wheel again, to G {FINE_GRADE:g}, which leaves "
        f"{FINE_GRADE / GRADE:.0%} of the excitation",
        f"stick damping tape (butyl under aluminium foil) on the {where}",
        *_stiffer(device, modes),
    ]
    yield (
        "If it shakes most within 5 % of a speed that a maneuver holds for longer than 0.1 s "
        f"(validation/*.csv), do in this order: {'; '.join(cures)}. Then sweep again. "
        "Passing through a mode quickly does no harm."
    )


def _stiffer(device: Device, modes: Sequence[Resonance]) -> Iterator[str]:
    """Next plate thickness, with its longer screws, if a mode of the plate is near."""
    plate = device.plate
    if plate is None or plate.mast is not None or "plate" not in {mode.name for mode in modes}:
        return
    thick = next((thickness for thickness in STOCK if thickness > plate.thickness + 1e-6), None)
    if thick is None:
        return
    stiff = replace(plate, thickness=thick)
    frequency = plate_frequency(stiff, device.module_mass)
    heavier = sum(plate_part(single).mass() for single in stiff.single_plates)
    heavier -= sum(plate_part(single).mass() for single in plate.single_plates)
    longer = 1e3 * (thick - plate.thickness)
    yield (
        f"make the plate {1e3 * thick:g} mm thick, all screws through it {longer:g} mm longer: "
        f"{60.0 * frequency:,.0f} rpm, {1e3 * heavier:.0f} g heavier"
    )


def safety(assembly: Assembly) -> Iterator[str]:
    """Stored energy of a wheel, its containment if it bursts, and rules near it."""
    speed, burst = assembly.top_speed, assembly.burst
    if speed is None or burst is None:
        return
    count = len(assembly.device.modules)
    energy = stored_energy(assembly.device.flywheel.spin_inertia, speed)
    flown, both = "", demand_of(assembly.margins, "stored energy")
    if both is not None:
        where = "in all wheels" if count > 1 else "in it"
        flown = f"; the planned maneuvers reach {significant(both, 3)} J {where}"
    wheels = f", {count} of them {significant(count * energy, 3)} J" if count > 1 else ""
    yield (
        f"{'Each' if count > 1 else 'The'} wheel stores {significant(energy, 3)} J at "
        f"{rpm(speed)}{wheels}{flown}. {significant(count * energy, 3)} J is "
        f"{_two(count * energy / STANDARD_GRAVITY)} kg dropped from 1 m."
    )
    part = burst.fragment
    yield (
        f"If a wheel bursts at that speed, a third of it ({1e3 * part.mass:.0f} g) flies off "
        f"at {part.speed:.0f} m/s with {_two(part.energy)} J."
    )
    rule = "BRL formula, 1.25 times the thickness that is just perforated"
    built = assembly.device.guard_wall
    if built >= burst.steel:
        yield (
            f"The guard ring of {1e3 * built:.1f} mm holds that piece by the {rule}, which "
            f"asks for {_at_least(burst.steel)} mm. That formula rests on tests of large plates; "
            "no ring of this kind has been tested: stay out of the wheel's plane all the same."
        )
    elif "drum" in assembly.numbers:
        short = f" and its ring of {1e3 * built:.1f} mm" if built else ""
        steel, aluminium = burst.masses
        yield (
            f"The printed guard{short} keeps fingers out. It does not hold a burst rim: that "
            f"would need a ring of {_at_least(burst.steel)} mm of mild steel in the drum, "
            f"{1e3 * steel:.0f} g each ({2e3 * burst.inner_radius:.1f} mm inside, "
            f"{1e3 * burst.height:.1f} mm wide; {rule}), or by an estimate without tests "
            f"behind it {_at_least(burst.aluminium)} mm of 6061-T6, "
            f"{1e3 * aluminium:.0f} g each. `size --guard containing` builds in the "
            "steel one."
        )
    yield from _runaway(assembly)
    if "cage" in assembly.numbers:
        yield (
            "Between the posts of the cage the motor's bell turns with the wheel and can be "
            "touched: keep hands away while the supply is on, and cables tied to the cage."
        )
    yield (
        "Whenever the supply is on: nobody in the plane of a wheel, eye protection for "
        "everybody in the room, no loose sleeves or cables, the lid on. Wheels coast on "
        "after the supply is cut; wait until they stop."
    )
    yield (
        "After a crash, a fall on a wheel, or a touch of rim and housing: run-out, balance and "
        "spin test again before the next flight."
    )


def _runaway(assembly: Assembly) -> Iterator[str]:
    """Speed limit by the wheel law, and the energy of a runaway wheel without it."""
    motor, built = assembly.device.motor, assembly.device.guard_wall
    top = assembly.top_speed
    if top is None or motor.bus_voltage is None or not math.isfinite(motor.no_load_speed):
        return
    speed, verdict = SPIN_TEST * motor.no_load_speed, ""
    worst = burst_of(assembly.device, speed)
    if built:
        enough = "thick enough" if built >= worst.steel else "too thin"
        verdict = f", and the ring built in is {enough}"
    yield (
        f"The wheel law, which computes with {motor.bus_voltage:g} V, drives no wheel past "
        f"{rpm(top)}, however full the battery is, and brakes one that is faster. A controller "
        "that ignores it may run away: on a battery with "
        f"{SPIN_TEST:.0%} of that voltage to {rpm(speed)}, where a third of the wheel has "
        f"{_two(worst.fragment.energy)} J; holding it takes {_at_least(worst.steel)} mm of mild "
        f"steel{verdict}."
    )


def _two(value: float) -> str:
    """Value with two digits: most of these figures are estimates."""
    return significant(value, 2)


def _at_least(wall: float) -> str:
    """Required wall thickness in millimetres, rounded up to a thickness that is built."""
    return f"{1e3 * stepped(wall):.1f}"
