"""Joints of a designed device and with its robot, and balancing of its wheels."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import ceil, floor, inf, sqrt

from ocs_design.actuation.fasteners import LIGAMENT, BoltedJoint, Fastening, longest_within, screw
from ocs_design.actuation.motor import DIRECT
from ocs_design.catalogue.materials import Material, material, recorded_material
from ocs_design.common.units import STANDARD_GRAVITY, format_quantity
from ocs_design.device.device import Device, Module
from ocs_design.device.records.flights import Margin
from ocs_design.parts.bell import GLUE_GAP
from ocs_design.parts.cage import floor_at_shock, heads_at_shock
from ocs_design.parts.guard import Containment, fragment_of
from ocs_design.parts.joints import (
    BOND_SHARE,
    COLDEST,
    EPOXY,
    EPOXY_STRENGTH,
    FRICTION,
    GRADE,
    HOTTEST,
    OVERSPEED,
    SERVICE,
    SMOOTHING,
    WARMEST,
    Correction,
    Grade,
    ShrinkFit,
    bell_bond_tension,
    correction,
    cylinder_torque,
    hub_joint,
    joint_preload,
    shear_torque,
    shrink_fit,
    slip_fit_eccentricity,
    tightening_torque,
    tolerance_width,
)
from ocs_design.parts.motor_mount import bond_length, motor_front
from ocs_design.parts.plate_strength import plate_screws_use
from ocs_design.parts.printed import (
    CLEARANCE,
    PETG,
    PRESSURE_SHARE,
    SHOCK,
    WASHER_HEIGHT,
    trunk_screws,
)
from ocs_design.parts.tightening import MotorGrip, motor_grips
from ocs_design.parts.turning_rings import Ring, TurningRings, holed_peaks
from ocs_design.parts.web_bending import BentWeb, bent_web
from ocs_design.parts.wheel import Flywheel, Web

RIM_JOINT, SHAFT_JOINT, MOUNT_JOINT = "rim joint", "shaft joint", "motor mount"
WHEEL_STRESS = "largest stress of the wheel"

FOOT_SHOCK, FLOOR_SHOCK = "landing shock, foot", "landing shock, cage"
WEB_SHOCK = "landing shock, web"

WEB_STEP = 0.5e-3
"""Step of the thickness of webs [m]."""
SCREWS_SHOCK = "landing shock, screws in the trunk"

BEARING_MOMENT = "bearing moment"
"""Name of the margin of the moment that turns a wheel's axis."""

RUN_OUT = 0.05e-3
"""Permissible run-out of the rim relative to the bore on the wheel's drawing [m]; the eccentricity
is half of it."""


def burst_of(device: Device, speed: float | None = None) -> Containment:
    """Containment for a wheel that bursts at a speed [rad/s]; None: at its top speed."""
    wheel = device.flywheel
    web = 0.0 if wheel.web is None else wheel.web.mass
    piece = fragment_of(
        inner_radius=wheel.inner_radius,
        outer_radius=wheel.outer_radius,
        height=wheel.height,
        rim_mass=wheel.rim_mass,
        web_mass=web,
        wheel_speed=device.motor.top_speed if speed is None else speed,
    )
    housing = device.foot.housing
    return Containment.of(piece, housing.guard_radius, housing.guard_height)


def foot_screws(device: Device, module: Module) -> Fastening:
    """Screws of a module's foot, including washers where they have any.

    Those in a plate end above its underside, for the trunk may be there and would hold their heads
    off: the next shorter ones, or cut ones where these have too little thread.
    """
    screws, plate = counted_foot_screws(device, module), device.plate
    if device.foot_hold.washers:
        screws = replace(screws, thickness=screws.thickness + WASHER_HEIGHT)
    if plate is None:
        return screws
    through = screws.thickness + plate.thickness
    # Lengths are made to js15: ISO 4762.
    longer = tolerance_width(screws.length, Grade.IT15) / 2.0
    if screws.length + longer <= through:
        return screws
    thread = longest_within(through - longer) - screws.thickness
    if thread >= screws.screw.least_thread:
        return replace(screws, depth=thread / screws.screw.diameter)
    cut = 1e-4 * floor(1e4 * (through - longer) + 1e-6)
    return replace(screws, engagement_max=cut - screws.thickness)


def counted_foot_screws(device: Device, module: Module) -> Fastening:
    """Screws of a module's foot into its pedestal, the plate or the trunk, as counted in the mass.

    Washers, which depend on the module's mass, are not counted.
    """
    if any(pedestal.module == module.name for pedestal in device.pedestals):
        return device.pedestals[0].seat_screws
    screws = trunk_screws(device.foot_plate)
    return screws if device.plate is None else replace(screws, joint=BoltedJoint.FOOT_ON_PLATE)


def unheld_moment(device: Device, margins: Sequence[Margin]) -> float:
    """Moment of a wheel that would turn its foot about the vertical [N m]; 0: friction holds it.

    All of it counts as vertical, as for a pitching trunk and a horizontal wheel axis that is not
    lateral.

    Args:
        device: device whose feet are held (`foot_hold`). margins: of its motion.
    """
    moments = (margin.demand for margin in margins if margin.name == BEARING_MOMENT)
    demand = max(moments, default=0.0)
    return demand if demand > device.foot_hold.turning else 0.0


def joints_of(device: Device) -> tuple[Margin, ...]:
    """Joints of one module: of rim, shaft and mount; empty with massless spokes.

    A joint of unknown capacity keeps the device from being built.
    """
    if device.on_bell:
        return (*_bell_joints(device), *_mount_joints(device), *_shocks(device))
    web = device.flywheel.web
    if web is None:
        return ()
    own = *_rim_joints(device, web), *_shaft_joints(device, web)
    return (*own, *_mount_joints(device), *_shocks(device))


def slipping(device: Device) -> tuple[MotorGrip, ...]:
    """Screws between motor and foot whose friction may not hold its torque.

    The booklet has their holes filled with epoxy.
    """
    torque = SERVICE * (device.motor.torque_limit or 0.0)
    return tuple(grip for grip in motor_grips(device.mount) if grip.friction < torque)


def _mount_joints(device: Device) -> Iterator[Margin]:
    """Margin of the screws between motor and foot, by friction or in filled holes."""
    grips, slip = motor_grips(device.mount), slipping(device)
    if not grips:
        return

    def holds(grip: MotorGrip) -> float:
        return max(grip.friction, grip.filled) if grip in slip else grip.friction

    weakest = min(grips, key=holds)
    screws = weakest.fastening
    by = "by friction under their heads, limited by the print"
    if weakest in slip:
        by = (
            "in their holes, filled with epoxy: the print bears "
            f"{1e-6 * PRESSURE_SHARE * PETG.strength:g} MPa, half its yield strength"
        )
    note = f"{screws.name}: {screws.count} x {screws.screw.name} {by}, against {SERVICE:g} x peak"
    torque = SERVICE * (device.motor.torque_limit or 0.0)
    yield Margin(MOUNT_JOINT, torque, holds(weakest), "N m", note=f"{note} torque")


def _shocks(device: Device) -> Iterator[Margin]:
    """Accelerations at which the module's mount breaks."""
    module_mass, hold = device.module_mass, device.foot_hold
    mass_text = format_quantity(module_mass, "kg" if module_mass >= 1.0 else "g", digits=3)
    shock, end = f"a shock of {SHOCK / STANDARD_GRAVITY:.0f} g", "the foot, printed of PETG, breaks"
    if hold.heads_bear < hold.prints_bear:
        end = f"the {'washers' if hold.washers else 'heads'} of its screws sink in"
    capacity = min(hold.prints_bear, hold.heads_bear)
    note = f"{shock} on {mass_text} along the wheel's axis, until {end}"
    yield Margin(FOOT_SHOCK, SHOCK, capacity, "m/s2", note=note)
    plate = device.plate
    if plate is not None:
        use = plate_screws_use(plate, module_mass, device.foot.wheel_height)
        count = len(plate.trunk)
        note = f"{shock} on all modules, until one of {count} {plate.thread} of class 8.8 breaks"
        if max(plate.sleeves) > 0.0:
            note += f", or a {'post' if plate.on_posts else 'sleeve'} gives way"
        yield Margin(SCREWS_SHOCK, SHOCK, SHOCK / use, "m/s2", note=note)
    yield from _web_shock(device)
    cage = device.mount.cage
    if cage is not None:
        drive, wheel = device.motor.mass or 0.0, device.flywheel.mass
        breaking_floor = floor_at_shock(cage, drive, wheel)
        if breaking_floor > 0.0:
            capacity = SHOCK * (cage.floor / breaking_floor) ** 2
            note = f"{shock} on motor and wheel, which tilt the cage's floor, until it breaks"
            heads_capacity = heads_at_shock(cage, drive, wheel)
            if heads_capacity < capacity:
                capacity = heads_capacity
                note = f"{shock} on motor and wheel, until the heads of the cage's screws sink in"
            yield Margin(FLOOR_SHOCK, SHOCK, capacity, "m/s2", note=note)


def _bent_web(device: Device) -> tuple[float, BentWeb] | None:
    """Strength of a wheel's web that `SHOCK` may use [Pa], and its bending by `SHOCK`.

    Spinning at top speed, or a shrink fit, uses the rest. None where material data are unknown.
    """
    wheel, rings, fit = device.flywheel, wheel_rings(device.flywheel), rim_fit(device)
    web = wheel.web
    if web is None or rings is None or (fit is None and web.material != wheel.material):
        return None
    metal, (hub, disc, rim) = material(web.material), rings
    if metal.yield_strength is None:
        return None
    spun = TurningRings.of(rings, device.motor.top_speed).peak(1) if fit is None else fit.stress_web
    bent = bent_web(
        SHOCK * wheel.mass,
        (hub.outer, rim.inner),
        disc.thickness,
        elastic_modulus=disc.elastic_modulus,
        poisson_ratio=disc.poisson_ratio,
        holes=web.holes,
    )
    return max(metal.yield_strength - spun, 0.0), bent


def least_web_thickness(device: Device) -> float:
    """Thickness of a wheel's web that bears `SHOCK`, in steps of half a millimetre [m].

    0 if there is none to compute; at most the hub's height. Stress falls with the square of the
    thickness, deflection with its cube.
    """
    found, web = _bent_web(device), device.flywheel.web
    if found is None or web is None:
        return 0.0
    left, bent = found
    thicker = max((bent.deflection / CLEARANCE) ** (1.0 / 3.0), 1.0)
    thicker = max(sqrt(bent.stress / left), thicker) if left > 0.0 else inf
    if thicker == 1.0:
        return web.thickness
    most = floor(web.hub.height / WEB_STEP + 1e-6)
    steps = most if thicker == inf else min(ceil(thicker * web.thickness / WEB_STEP - 1e-6), most)
    return max(WEB_STEP * steps, web.thickness)


def _web_shock(device: Device) -> Iterator[Margin]:
    """Acceleration along its axis that a spinning wheel withstands on its web.

    The web must not yield, nor its rim touch the housing.
    """
    found = _bent_web(device)
    if found is None:
        return
    left, bent = found
    yields, touches = left / bent.stress, CLEARANCE / bent.deflection
    end = "its web yields" if yields < touches else "its rim touches the housing"
    shock = f"{SHOCK / STANDARD_GRAVITY:.0f} g"
    moved = format_quantity(bent.deflection, "mm", digits=2)
    note = (
        f"a shock of {shock} on a wheel at top speed, along its axis, until {end}; at {shock} the "
        f"rim moves by {moved}"
    )
    yield Margin(WEB_SHOCK, SHOCK, SHOCK * min(yields, touches), "m/s2", note=note)


def wheel_rings(wheel: Flywheel) -> tuple[Ring, ...] | None:
    """Hub, web and rim as rings; None where material data are unknown."""
    web = wheel.web
    if web is None:
        return None
    web_elastic = _elastic(recorded_material(web.material))
    rim_elastic = _elastic(recorded_material(wheel.material))
    if web_elastic is None or rim_elastic is None:
        return None
    hub = web.hub
    return (
        Ring(hub.bore_radius, hub.radius, hub.height, web.density, *web_elastic),
        Ring(hub.radius, wheel.inner_radius, web.thickness, web.density, *web_elastic),
        Ring(wheel.inner_radius, wheel.outer_radius, wheel.height, wheel.density, *rim_elastic),
    )


def _elastic(material: Material | None) -> tuple[float, float] | None:
    """Elastic modulus [Pa] and Poisson's ratio."""
    if material is None or material.elastic_modulus is None or material.poisson_ratio is None:
        return None
    return material.elastic_modulus, material.poisson_ratio


def _rim_joints(device: Device, web: Web) -> Iterator[Margin]:
    """Stress of a one-piece wheel, or torque, stresses and buckling of a shrink fit."""
    wheel = device.flywheel
    rings, fit = wheel_rings(wheel), rim_fit(device)
    if rings is None:
        name = WHEEL_STRESS if web.material == wheel.material else RIM_JOINT
        note = f"elastic figures of {wheel.material} are not known"
        yield Margin(name, 0.0, None, "Pa", note=note)
    elif web.material == wheel.material:
        where, peak = _peak(web, rings, OVERSPEED * device.motor.top_speed)
        note = (
            f"in {where} at {OVERSPEED:g} x top speed, against yield; one piece, as a rotating "
            "disc of three thicknesses"
        )
        strength = material(wheel.material).yield_strength
        yield Margin(WHEEL_STRESS, peak, strength, "Pa", note=note)
    elif fit is None:
        yield Margin(RIM_JOINT, 0.0, None, "N m", note="thermal expansions are not known")
    else:
        least, most = (
            format_quantity(2.0 * interference, "um", digits=3)
            for interference in (fit.least, fit.most)
        )
        note = (
            f"shrunk on, {least} to {most} interference on diameter, less "
            f"{format_quantity(SMOOTHING, 'um', digits=2)} by smoothing of the surfaces; friction "
            f"of {FRICTION:g} at the looser fit, at {OVERSPEED:g} x top speed or at rest, "
            f"{COLDEST:g} to {WARMEST:g} deg C, against {SERVICE:g} x peak torque"
        )
        torque = SERVICE * (device.motor.torque_limit or 0.0)
        yield Margin(RIM_JOINT, torque, fit.torque, "N m", note=note)
        stresses = (("web", fit.stress_web, web.material), ("rim", fit.stress_rim, wheel.material))
        for part, stress, name in stresses:
            strength, note = material(name).yield_strength, "at the tightest fit, to yield"
            held = f"{part} of the shrink fit"
            yield Margin(held, stress, strength, "Pa", note=f"largest stress {note}")
        buckling, note = "web of the shrink fit, to buckling", "a full plate with its edge held"
        yield Margin(buckling, fit.squeezed, fit.buckling, "Pa", note=note)


def _peak(web: Web, rings: tuple[Ring, ...], speed: float) -> tuple[str, float]:
    """Location of the largest stress of a one-piece wheel, and that stress [Pa]."""
    turning, names = TurningRings.of(rings, speed), ["the hub", "the web", "the rim"]
    values = [turning.peak(ring) for ring in range(len(rings))]
    hub, holes = web.hub, web.holes
    if holes is not None:
        names[1] = "the web's holes"
        sizes = (holes.count, holes.circle_radius, holes.hole_radius)
        values = list(holed_peaks(rings, speed, *sizes))
    peaks = dict(zip(names, values, strict=True))
    if hub.bolts:
        peaks["the hub's holes"] = turning.peak_at_hole(0, hub.bolt_circle_radius)
    where = max(peaks, key=lambda name: peaks[name])
    return where, peaks[where]


def yield_margin(device: Device, speed: float) -> tuple[str, float] | None:
    """Location where a wheel's stress is closest to yield, and yield strength over that stress.

    A shrink fit's stress is the largest up to `OVERSPEED`; that of a rim on massless spokes is the
    hoop stress of a ring. None where material data are unknown.

    Args:
        device: device with the wheel. speed: of the wheel [rad/s].
    """
    wheel = device.flywheel
    rings, web, fit = wheel_rings(wheel), wheel.web, rim_fit(device)
    if rings is None or web is None:
        if wheel.stress_margin is None:
            return None
        return "the rim", wheel.stress_margin * (device.motor.top_speed / speed) ** 2
    peaks = [("the web", fit.stress_web, web.material)] if fit is not None else []
    if fit is not None:
        peaks.append(("the rim", fit.stress_rim, wheel.material))
    elif web.material == wheel.material:
        peaks.append((*_peak(web, rings, speed), wheel.material))
    margins = [
        (where, strength / stress)
        for where, stress, name in peaks
        if (strength := material(name).yield_strength) is not None
    ]
    return min(margins, key=lambda margin: margin[1], default=None)


def rim_fit(device: Device) -> ShrinkFit | None:
    """Shrink fit of a rim on a web of another material; None: one piece, or unknown data."""
    wheel = device.flywheel
    rings = wheel_rings(wheel)
    if wheel.web is None or rings is None or wheel.web.material == wheel.material:
        return None
    names, hub = (wheel.web.material, wheel.material), wheel.web.hub
    web_expansion, rim_expansion = (material(name).thermal_expansion for name in names)
    if web_expansion is None or rim_expansion is None:
        return None
    return shrink_fit(
        rings,
        (web_expansion, rim_expansion),
        OVERSPEED * device.motor.top_speed,
        SERVICE * (device.motor.torque_limit or 0.0),
        holes=hub.bolt_circle_radius if hub.bolts else None,
    )


def bonded_on_shaft(device: Device) -> bool:
    """Whether the wheel's hub is bonded on the motor's shaft."""
    mounting, web = device.motor.mounting, device.flywheel.web
    if mounting is None or web is None or device.motor.gear != DIRECT.name:
        return False
    return mounting.rotor is None and mounting.shaft_diameter is not None


def _shaft_joints(device: Device, web: Web) -> Iterator[Margin]:
    """Margins of the joint between wheel and motor."""
    drive, mounting = device.motor, device.motor.mounting
    torque = SERVICE * (drive.torque_limit or 0.0)
    against = f"against {SERVICE:g} x peak torque"
    capacity: float | None = None
    reserve: float | None = None
    if drive.gear != DIRECT.name:
        note = "how a wheel is mounted on this gear is not in the catalogue"
    elif mounting is not None and mounting.rotor is not None:
        circle, capacity = mounting.rotor, hub_joint(mounting, 0.0)
        bolt = screw(circle.thread)
        share = circle.preload_share
        tight = format_quantity(share * tightening_torque(bolt, circle.screws), "N m", digits=2)
        note = (
            f"friction under {circle}, class {circle.screws}, tightened with {tight} to "
            f"{share * joint_preload(bolt, circle.screws):,.0f} N, {against}"
        )
        if share < 1.0:
            depth = format_quantity(circle.deepest, "mm", digits=2)
            note += (
                f"; {share:.0%} of their usual preload, as they reach only {depth} into the rotor"
            )
        reserve = shear_torque(bolt, circle.bolts, circle.radius, circle.screws)
    elif mounting is not None and mounting.shaft_diameter is not None:
        front = motor_front(device.mount, device.flywheel.height)
        length = bond_length(mounting, web.hub.height, web.hub.chamfer, front)
        capacity = hub_joint(mounting, length)
        across = format_quantity(mounting.shaft_diameter, "mm")
        note = (
            f"bonded with a retaining compound on the {across} shaft, over "
            f"{format_quantity(length, 'mm', digits=3)} of its length in the hub, counted at half "
            f"of its 25 MPa, {against}; the fit alone carries nothing"
        )
    else:
        note = "the shaft and the rotor's threads are not in the catalogue"
    yield Margin(SHAFT_JOINT, torque, capacity, "N m", note=note)
    if reserve is not None:
        note = "only if the faces slip; the design does not rely on it"
        yield Margin("shaft joint, screws in shear", torque, reserve, "N m", note=note)


def _bell_joints(device: Device) -> Iterator[Margin]:
    """Margins of a ring around its motor's bell: stress, and bond under torque and speed."""
    wheel, speed = device.flywheel, OVERSPEED * device.motor.top_speed
    metal, bond_strength = recorded_material(wheel.material), BOND_SHARE * EPOXY_STRENGTH
    elastic = _elastic(metal)
    if metal is None or elastic is None or metal.thermal_expansion is None:
        unknown = f"elastic figures or expansion of {wheel.material} are not known"
        yield Margin(WHEEL_STRESS, 0.0, None, "Pa", note=unknown)
    else:
        ring = Ring(wheel.inner_radius, wheel.outer_radius, wheel.height, wheel.density, *elastic)
        stress = TurningRings.of((ring,), speed).peak(0)
        note = f"a ring by itself at {OVERSPEED:g} x top speed, against yield"
        yield Margin(WHEEL_STRESS, stress, metal.yield_strength, "Pa", note=note)
        tension = bell_bond_tension(
            ring.inner,
            ring.outer,
            density=ring.density,
            elastic_modulus=ring.elastic_modulus,
            poisson_ratio=ring.poisson_ratio,
            expansion=metal.thermal_expansion,
            speed=speed,
        )
        note = (
            f"bonded around the bell with {EPOXY}; the ring would grow off a rigid bell at "
            f"{OVERSPEED:g} x top speed, {COLDEST:g} to {HOTTEST:g} deg C, against "
            f"{BOND_SHARE:.0%} of its {1e-6 * EPOXY_STRENGTH:g} MPa at {HOTTEST:g} deg C"
        )
        name = "rim joint, pull on the bond"
        yield Margin(name, float(tension), bond_strength, "Pa", note=note)
    diameter, bonded = 2.0 * wheel.inner_radius, wheel.height - 2.0 * wheel.cuts.chamfer
    capacity = cylinder_torque(diameter, bonded, bond_strength)
    note = (
        f"bonded around the bell with {EPOXY}, at {BOND_SHARE:.0%} of its "
        f"{1e-6 * EPOXY_STRENGTH:g} MPa at {HOTTEST:g} deg C, against {SERVICE:g} x peak torque"
    )
    torque = SERVICE * (device.motor.torque_limit or 0.0)
    yield Margin(SHAFT_JOINT, torque, capacity, "N m", note=note)


@dataclass(frozen=True)
class WheelBalance:
    """Balancing of one wheel, assembled on its motor with the eccentricity left by its mounting.

    Attributes:
        eccentricity: permissible at top speed, e = G / w [m].
        unbalance: permissible, m e [kg m].
        off_centre: eccentricity due to turning and centring [m]; None: nothing centres it.
        centred_by: what centres it.
        shifted: whether only screws do, so that it is shifted on them until it runs true.
        correction: holes in the rim's faces that remove an unbalance.
    """

    eccentricity: float
    unbalance: float
    off_centre: float | None
    centred_by: str
    shifted: bool
    correction: Correction


def permissible_eccentricity(speed: float) -> float:
    """Permissible eccentricity, e_per = G / w [m], at a speed [rad/s]."""
    return 1e-3 * GRADE / speed


def balance_of(device: Device) -> WheelBalance:
    """Balance of one wheel at the highest speed of its drive."""
    wheel = device.flywheel
    eccentricity = permissible_eccentricity(device.motor.top_speed)
    rim = wheel.inner_radius, wheel.outer_radius, wheel.height, wheel.density
    mounting = device.motor.mounting
    off_centre: float | None = None
    centred_by, shifted = "a seat that is not designed", False
    if device.on_bell:
        off_centre, centred_by = GLUE_GAP, "its glue gap, which the fixture evens out"
    elif mounting is not None and mounting.shaft_diameter is not None:
        off_centre = slip_fit_eccentricity(mounting.shaft_diameter)
        centred_by = "its bore on the shaft, H7/h6"
    elif mounting is not None and mounting.rotor is not None:
        # In clearance holes it may initially be farther off centre.
        off_centre, shifted = RUN_OUT / 2.0, True
        centred_by = f"its screws, once it is shifted until it runs true to {2e3 * RUN_OUT:g} mm"
    return WheelBalance(
        eccentricity=eccentricity,
        unbalance=eccentricity * wheel.mass,
        off_centre=None if off_centre is None else RUN_OUT / 2.0 + off_centre,
        centred_by=centred_by,
        shifted=shifted,
        correction=correction(*rim, chamfer=wheel.cuts.chamfer, ligament=LIGAMENT),
    )
