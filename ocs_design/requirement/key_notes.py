"""What a specification to start from says of each key beyond its summary: why one would state it.

What a key is and how it is read is in `specification`; what holds where it is not stated is in
`defaults`. Here is only what people need besides.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class KeyNote:
    """Of one key.

    Attributes:
        why: one line, when to state it.
        default: what holds where nothing is stated, in words; empty: the value says it all.
        example: a value as it is written in TOML, where there is no default to show.
    """

    why: str
    default: str = ""
    example: str = ""


KEY_NOTES: Mapping[str, KeyNote] = MappingProxyType(
    {
        "robot.file": KeyNote(
            "Mass, inertia and legs are read from it; from the folder of this file.",
            "the robot on the command line",
            '"robot.urdf"',
        ),
        "robot.name": KeyNote(
            "Names the output folder of a robot by hand.", "the file's own", '"robot"'
        ),
        "robot.trunk": KeyNote(
            "State it where the wrong link was found to carry the legs.", "found", '"trunk"'
        ),
        "robot.posture": KeyNote(
            "The inertia, and with it all else, is that of this posture.",
            "stand where legs are found",
            '"stand"',
        ),
        "robot.joints": KeyNote(
            "For a posture that has no name.", "none", '{ "FL_HFE" = "45deg", "FL_KFE" = "-90deg" }'
        ),
        "robot.mass": KeyNote("In place of a file, with the inertia.", "read", '"2.5 kg"'),
        "robot.inertia": KeyNote(
            "In place of a file, with the mass.", "read", "[0.032, 0.055, 0.070]"
        ),
        "robot.weighed": KeyNote(
            "Tells when the parts in the file do not add up to it.", "not checked", '"2.5 kg"'
        ),
        "requirement.rate_change": KeyNote(
            "The paper's requirement: asked of either axis, on top of the maneuvers.",
            "not asked",
            '"2 rad/s"',
        ),
        "requirement.wheel_speed_max": KeyNote(
            "What bearings and balance stand, if less than the motor can do.",
            "the motor's own; 7200 rpm without a motor",
            '"7200 rpm"',
        ),
        "requirement.spin_inertia": KeyNote(
            "For a wheel that you have already; nothing else is then asked.",
            "found",
            '"7.11e-5 kg m2"',
        ),
        "requirement.gravity": KeyNote("1.62 m/s2 is the Moon's."),
        "requirement.maneuvers": KeyNote(
            "none where the bound alone is asked for; leave it out where you state your own."
        ),
        "ocs.alpha": KeyNote(
            "Where mounts for one angle exist already.", "by the criterion below", '"40 deg"'
        ),
        "ocs.alpha_criterion": KeyNote(
            "equal-rate is the paper's: the same change of rate about either axis.",
            "lightest; without a motor equal-rate",
        ),
        "ocs.position": KeyNote(
            "In the trunk's frame; the right wheel is mirrored in y.",
            "found, free of the robot's own parts",
            '["0 mm", "50 mm", "70 mm"]',
        ),
        "ocs.mass_max": KeyNote(
            "What the robot may carry: if the lightest device is heavier, there is none.",
            "not limited",
            '"1 kg"',
        ),
        "ocs.co_design": KeyNote("A few per cent lighter at best, and slower to find."),
        "flywheel.r_max": KeyNote(
            "Of the rim: its housing adds 3.6 mm all around. The wider the rim, the lighter."
        ),
        "flywheel.r_min": KeyNote("Room for the motor's shaft or can inside the rim."),
        "flywheel.h_max": KeyNote("The room along the spin axis."),
        "flywheel.h_min": KeyNote("What your lathe or printer still makes well."),
        "flywheel.wall_min": KeyNote("The same across the rim."),
        "flywheel.wheel_mass_max": KeyNote("What the trunk may carry on each side."),
        "flywheel.material": KeyNote(
            "One that you can get: see `ocs-design catalogue materials`.",
        ),
        "flywheel.web": KeyNote("none is the paper's: spokes that weigh nothing."),
        "flywheel.stress_safety": KeyNote("More where a burst rim could hurt someone."),
        "flywheel.chamfer": KeyNote("What your workshop breaks edges by; it is counted."),
        "flywheel.balancing_holes": KeyNote(
            "At least three, where weights are to balance the wheel; its wall grows to fit them."
        ),
        "flywheel.balancing_hole_diameter": KeyNote("1.6 mm is the core hole of M2."),
        "flywheel.balancing_hole_depth": KeyNote(
            "A thread of M2 wants 2 mm; both faces have them, so that the rim grows too."
        ),
        "motor.name": KeyNote(
            "One that you have: see `ocs-design catalogue motors`; none: the bound alone."
        ),
        "motor.bus_voltage": KeyNote("Your robot's battery under load, not its nameplate."),
        "motor.gear": KeyNote(
            "direct where backlash or noise forbid one: see `ocs-design catalogue gears`."
        ),
        "motor.motors": KeyNote(
            "To choose from as well; from the folder of this file.", "none", '"my_motors.csv"'
        ),
        "motor.gears": KeyNote(
            "To choose from as well; from the folder of this file.", "none", '"my_gears.csv"'
        ),
        "motor.torque_max": KeyNote(
            "What your motor controller gives, at the wheel.", "the motor's own", '"1 N m"'
        ),
        "validation.enabled": KeyNote("false: size and export only, in half the time."),
        "validation.projection": KeyNote("transpose is the paper's, which scales the gains."),
        "validation.kp": KeyNote("Higher: quicker, and more torque."),
        "validation.kd": KeyNote("2 sqrt(kp) damps critically."),
        "validation.ballistic": KeyNote("true: the legs need not make the jumps."),
        "validation.seed": KeyNote("The same seed gives the same figures."),
        "validation.video": KeyNote("true: each maneuver as a film, with the device and without."),
        "validation.control_period": KeyNote("That of your controller; longer ones fly worse."),
        "validation.desaturate": KeyNote("true: wheels let go of their momentum after landing."),
        "reality.mass_error": KeyNote("After weighing the robot: the balance's error."),
        "reality.inertia_error": KeyNote("From CAD 5 % is common, from a pendulum 1 %."),
        "reality.com_error": KeyNote("Batteries and cables are seldom where CAD has them."),
        "reality.incidence_error": KeyNote("Play and tolerance of the mounts."),
        "reality.torque_constant_error": KeyNote("Makers state 5 to 10 % at most."),
        "reality.resistance_error": KeyNote("A warm winding has 0.4 % more for each degree."),
        "reality.bus_voltage_error": KeyNote("From a full battery to one that is to be charged."),
        "reality.coulomb_friction": KeyNote(
            "Measure it: run the wheel down.", "half of the motor's no-load torque", '"5 mN m"'
        ),
        "reality.viscous_friction": KeyNote(
            "The same at speed.", "the other half at the speed it is stated for", '"3 uN m s/rad"'
        ),
        "reality.air_drag": KeyNote("0: a vacuum, as on the Moon."),
        "reality.torque_delay": KeyNote("Bus, filters and the motor's own controller."),
        "reality.attitude_noise": KeyNote("The data sheet of your inertial sensor has it."),
        "reality.attitude_bias": KeyNote("Most of what a flight is off level by."),
        "reality.gyro_noise": KeyNote("Noise density times the root of the bandwidth."),
        "reality.gyro_bias": KeyNote("What is left after it was calibrated."),
        "reality.contact_friction": KeyNote("Of your feet on your floor."),
    }
)
"""By the path of the key, as in `flywheel.r_max`."""

MANEUVER_NOTES: Mapping[str, str] = MappingProxyType(
    {
        "disturbance": "A jump in which something hits the trunk; to stay level until touchdown.",
        "shove": "A torque on the trunk of a robot that stands or trots; to be at rest soon.",
        "drop": "A fall from rest with the trunk tilted; to be level before touchdown.",
        "flip": "A turn in pitch during a vertical jump; a back-flip is negative.",
    }
)
"""What each kind of maneuver is."""

FIELD_NOTES: Mapping[str, str] = MappingProxyType(
    {
        "name": "yours, of each maneuver another",
        "gravity": "if not that of [requirement]",
        "incidence": "if the modules are turned by hand for it",
        "takeoff_velocity": "forward, up",
        "torque": "on the trunk, about its x (forward), y (left) and z",
        "onset": "after lift-off",
        "duration": "of the torque",
        "flip.duration": "of the turn, from lift-off",
        "settling": "from the end of the torque to rest",
        "stride": "of a trot on the spot; 0: the robot stands",
        "height": "of the trunk over the ground",
        "roll": "at release",
        "pitch": "at release",
        "jump_height": "of the centre of mass",
        "angle": "of pitch",
    }
)
"""What each field of a `[[maneuver]]` is; by `kind.field`, of that kind alone."""


def field_note(kind: str, field: str) -> str:
    """Of a field of a kind of maneuver."""
    return FIELD_NOTES.get(f"{kind}.{field}") or FIELD_NOTES[field]
