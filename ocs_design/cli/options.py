"""Options shared by commands, each declared once, and the specification made from options."""

import functools
import inspect
import shlex
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ocs_design.cli import completion
from ocs_design.common.errors import UsageError

if TYPE_CHECKING:
    from ocs_design.requirement.specification import Specification

Command: TypeAlias = Callable[..., None]


def with_options(shared: Mapping[str, object]) -> Callable[[Command], Command]:
    """Add these options to a command, before its own and all optional.

    They are not passed to the command: `specified_by_command` reads them from its context, the
    first parameter.
    """

    def declared(command: Command) -> Command:
        @functools.wraps(command)
        def run(**values: object) -> None:
            command(**{name: value for name, value in values.items() if name not in shared})

        context, *of_command = inspect.signature(command).parameters.values()
        redeclare(run, [context, *parameters(shared, default=None), *of_command])
        return run

    return declared


def parameters(options: Mapping[str, object], *, default: object) -> list[inspect.Parameter]:
    """Parameters of a command, one for each option."""
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    return [
        inspect.Parameter(name, kind, default=default, annotation=option)
        for name, option in options.items()
    ]


def redeclare(command: Command, parameters: list[inspect.Parameter]) -> None:
    """Replace the declared parameters of a command, from which Typer makes options."""
    command.__dict__["__signature__"] = inspect.Signature(parameters)
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}


Text: TypeAlias = str | None
Texts: TypeAlias = list[str] | None


def option(
    names: str, metavar: str, help_text: str, complete: Callable[..., list[str]] | None = None
) -> object:
    """An option with a value; by default it is named after its parameter, with dashes."""
    return typer.Option(*names.split(), metavar=metavar, help=help_text, autocompletion=complete)


def _text(metavar: str, help_text: str, complete: completion.Completer | None = None) -> object:
    """An option with one text."""
    return Annotated[Text, option("", metavar, help_text, complete)]


def _texts(metavar: str, help_text: str, complete: completion.Completer | None = None) -> object:
    """A repeatable option with one text each time."""
    return Annotated[Texts, option("", metavar, help_text, complete)]


def flag(names: str, help_text: str) -> object:
    """An option without a value; a name made by Typer would come with `--no-...`."""
    return typer.Option(*names.split(), help=help_text)


def _flag(name: str, help_text: str) -> object:
    """The type of an option without a value."""
    return Annotated[bool, flag(name, help_text)]


RobotFile: TypeAlias = Annotated[
    str | None,
    typer.Argument(
        autocompletion=completion.files(*completion.ROBOTS),
        metavar="ROBOT",
        help="URDF, xacro or MJCF file, may be gzipped; - reads standard input. "
        "Without a file: --mass and --inertia.",
    ),
]
Spec: TypeAlias = Annotated[
    Path | None, option("--spec", "FILE", "Specification file (TOML).", completion.files(".toml"))
]
PackagePaths: TypeAlias = Annotated[
    list[str] | None, option("--package-path", "NAME=DIR", "Folder of package://NAME; repeatable.")
]
Survives: TypeAlias = Annotated[
    Text,
    option(
        "--survives",
        "one",
        "Land within tolerance even if any one drive fails in flight.",
        completion.one_of("one", "none"),
    ),
]
Detection: TypeAlias = Annotated[
    Text, option("--detection", "TIME", "Time until a failed drive is detected; 20ms by default.")
]
GearsFile: TypeAlias = Annotated[
    Text,
    option(
        "--gears",
        "FILE",
        "Your own gears, in addition to the catalogue; CSV or TOML.",
        completion.files(".csv", ".toml"),
    ),
]
Ballistic: TypeAlias = Annotated[
    bool, flag("--ballistic", "Start jumps at lift-off: no push-off by the legs.")
]
Reality: TypeAlias = Annotated[
    Text,
    option(
        "--reality",
        "FILE",
        "TOML file whose [reality] table replaces the default distributions.",
        completion.files(".toml"),
    ),
]
Certify: TypeAlias = Annotated[
    bool, flag("--certify", "Fly sampled robots until it is certain whether enough of them pass.")
]
Seed: TypeAlias = Annotated[int | None, option("--seed", "N", "Seed of all random numbers.")]
Force: TypeAlias = Annotated[
    bool, flag("--force", "Replace an existing folder once the new one is complete.")
]
AsJson: TypeAlias = Annotated[bool, flag("--json", "Print one JSON document on standard output.")]
Strict: TypeAlias = Annotated[bool, flag("--strict", "Treat warnings as errors.")]
Quiet: TypeAlias = Annotated[bool, flag("-q --quiet", "Print only errors.")]
NoColor: TypeAlias = Annotated[bool, flag("--no-color", "No colour; NO_COLOR=1 does the same.")]

ROBOT_OPTIONS: Mapping[str, object] = {
    "robot": RobotFile,
    "mass": _text("MASS", "Robot without a file: its mass, e.g. 2.5 or 2500g."),
    "inertia": _text(
        "IXX,IYY,IZZ[,IXY,IXZ,IYZ]", "Robot without a file: inertia about the centre of mass."
    ),
    "human": _text(
        "PERSON",
        "A person who wears the device, e.g. '75kg 1.75m with 10kg': mass, height, payload.",
    ),
    "weighed": _text("MASS", "Mass of the robot as weighed, to check its file."),
    "spec": Spec,
    "trunk": _text("LINK", "Link that carries the device. Default: detected."),
    "legs": _text(
        "LINK,...", "Feet, one link per leg; none: the robot has no legs. Default: detected."
    ),
    "posture": _text(
        "NAME",
        "zero, stand, or a keyframe or SRDF state. Default: stand if legs are found.",
        completion.one_of("stand", "zero"),
    ),
    "joint": _texts(
        "NAME=VALUE", "Angle or travel of one joint, on top of the posture; repeatable."
    ),
    "package_path": PackagePaths,
}
"""Options that define a robot, by name of the parameter."""

TASK_OPTIONS: Mapping[str, object] = {
    **ROBOT_OPTIONS,
    "rate_change": _text(
        "RATE", "Change of the trunk's rate that the wheels must make, e.g. 2rad/s."
    ),
    "reliability": _text(
        "SHARE", "Share of sampled robots that must pass. Default: 0.99; 0.5: no reserve."
    ),
    "survives": Survives,
    "detection": Detection,
    "jump_height": _texts(
        "LENGTH",
        "Stay level in a jump of this height, e.g. 0.4m; also for kicks and flips; repeatable.",
    ),
    "kick": _texts(
        "KICK",
        "Impulse on the trunk during a jump, e.g. '12 N s at 0.1,0,0.2' (base frame) or "
        "'12 N s at LINK along left'; repeatable.",
    ),
    "fall": _texts(
        "LENGTH", "Land level when the trunk is dropped from this height, e.g. 1m; repeatable."
    ),
    "tilt": _texts(
        "ANGLE", "Tilt of the dropped trunk: 20deg of pitch, or '20deg roll'; repeatable."
    ),
    "flip": _texts(
        "ANGLE",
        "Turn in pitch during a jump: back, forward, or an angle; repeatable.",
        completion.one_of("back", "forward"),
    ),
    "turn": _texts(
        "TURN", "Turn to an attitude during a jump, e.g. 'yaw 90deg in 2.9s'; repeatable."
    ),
    "catch": _texts(
        "RATES", "Stop a trunk that rotates at lift-off, e.g. 'pitch 45deg/s in 0.5s'; repeatable."
    ),
    "pivot": _text(
        "POINT", "Pivot to balance or stand up on: X,Y,Z, or 'X,Y,Z along left' for an edge."
    ),
    "balance": _texts(
        "UPSET",
        "Recover on the pivot from 'pitch 5deg', or a push, '0.5 N s at 0,0,0.1'; repeatable.",
    ),
    "stand_up": _texts(
        "TILT",
        "Stand up on the pivot, e.g. 'roll 36deg in 0.3s', 'roll 45deg by brake'; repeatable.",
    ),
    "gravity": _text(
        "GRAVITY",
        "earth (default), moon, mars, orbit, or e.g. 3.7m/s2.",
        completion.of_key("requirement.gravity"),
    ),
    "wheel_speed_max": _text(
        "SPEED", "Highest wheel speed. Default: the motor's; 7200rpm without a motor."
    ),
    "torque_max": _text(
        "TORQUE", "Largest wheel torque. Default: the motor's; not limited without a motor."
    ),
    "layout": _text(
        "NAME",
        "Arrangement of the wheels' axes: pair, double-pair or triple-pair (default: the first "
        "for which a motor is strong enough), single (pitch only), triad, orthogonal, pyramid; all "
        "compares them and writes no folder.",
        completion.of_key("ocs.layout"),
    ),
    "alpha": _text("ANGLE", "Incidence angle, e.g. 40deg; elevation of a pyramid."),
    "alpha_criterion": _text(
        "NAME",
        "How the incidence is chosen: equal-rate (default), lightest, weighted, simultaneous, "
        "pitch-only, roll-only.",
        completion.of_key("ocs.alpha_criterion"),
    ),
    "position": _text("X,Y,Z", "Centre of the left wheel in the trunk's frame."),
    "mass_max": _text("MASS", "Largest mass of the device, all modules."),
    "r_max": _text("LENGTH", "Largest outer radius of the rim, e.g. 30mm."),
    "r_min": _text("LENGTH", "Smallest inner radius of the rim."),
    "h_max": _text("LENGTH", "Largest height of the rim, along its axis."),
    "h_min": _text("LENGTH", "Smallest height of the rim."),
    "wall_min": _text("LENGTH", "Smallest wall of the rim, outer less inner radius."),
    "wheel_mass_max": _text("MASS", "Largest mass of one rim."),
    "web": _text(
        "disc|aluminium|none",
        "What joins a rim to its motor. disc (default): a thin disc in one piece with rim and hub; "
        "aluminium: a disc that the rim is shrunk on; none: massless spokes.",
        completion.of_key("flywheel.web"),
    ),
    "guard": _text(
        "fingers|containing",
        "fingers (default): printed housings; containing: also a steel ring in each that holds a "
        "bursting wheel.",
        completion.of_key("ocs.guard"),
    ),
    "wheel": _text(
        "disc|ring",
        "disc (default): a rim on a disc that sits on the motor; ring: a ring bonded around the "
        "motor's bell.",
        completion.of_key("ocs.wheel"),
    ),
    "material": _text(
        "NAME",
        "Material of `ocs-design catalogue materials`. steel (default): the best steel; auto: the "
        "best of all.",
        completion.any_of(completion.materials),
    ),
    "motor": _texts(
        "NAME",
        "Motor of `ocs-design catalogue motors`; repeatable: the best of several. auto (default): "
        "the lightest device; none: the wheels alone, by the paper's bound.",
        completion.any_of(completion.motors),
    ),
    "bus_voltage": _text(
        "VOLTAGE", "Supply of the motors. Default: 24V, above 20 kg 48V, above 60 kg 72V."
    ),
    "bus_current": _text(
        "CURRENT",
        "Largest current of all motors together, drawn or fed back. Default: no limit but power.",
    ),
    "bus_power": _text(
        "POWER",
        "Largest power of all motors together, drawn or fed back. Default: 400 W per kg of robot.",
    ),
    "controllers": _text(
        "MASS",
        "Mass of one motor controller; auto (default): from its current; none: not counted.",
        completion.of_key("supply.controllers"),
    ),
    "gear": _text(
        "NAME",
        "Gear of `ocs-design catalogue gears`. direct (default): no gear; auto: the lightest "
        "device.",
        completion.any_of(completion.gears),
    ),
    "motors_any": _flag(
        "--motors-any",
        "Also allow motors that lack data needed to build, for example their threads.",
    ),
    "motors": _text(
        "FILE",
        "Choose from the motors in this file, CSV or TOML, instead of the catalogue.",
        completion.files(".csv", ".toml"),
    ),
    "with_catalogue": _flag("--with-catalogue", "With --motors: choose from the catalogue too."),
    "gears": GearsFile,
    "reality": Reality,
}
"""Options of a robot, and of its device's requirement and limits."""


SIZE_OPTIONS: Mapping[str, object] = {
    **TASK_OPTIONS,
    "lighter_by": _text("MASS", "Also report which changes would save this mass, e.g. 90g."),
    "co_design": _flag(
        "--co-design", "Optimize all dimensions together with the maneuvers, in 3-D."
    ),
    "no_validate": _flag("--no-validate", "Do not simulate the maneuvers."),
    "ballistic": Ballistic,
    "certify": Certify,
    "video": _flag("--video", "Film the flights with and without the device: MP4 or GIF."),
}
"""Options of robot and device, and of everything done for a complete design."""

START_KEYS = ("r_max", "h_max", "motor", "gear", "bus_voltage", "bus_current", "bus_power")

START_OPTIONS: Mapping[str, object] = {
    **ROBOT_OPTIONS,
    **{name: TASK_OPTIONS[name] for name in START_KEYS},
}
"""Options of a robot, and those most often set in a specification to start from."""


def specified_by_command(context: typer.Context) -> "Specification":
    """The file given with `--spec`, overridden by every option of the command that is a key.

    Raises:
        OcsError: the file or an option cannot be read, or an option has no effect.
    """
    # Not for `--help`: reading specifications needs NumPy.
    from ocs_design.requirement.reading import read_specification
    from ocs_design.requirement.specification import (
        Specification,
        all_keys,
        merge,
        specification_from_options,
    )

    file = context.params["spec"]
    base = Specification() if file is None else read_specification(Path(file))
    values: dict[str, object] = {}
    for path, key in all_keys().items():
        option = key.option or path.partition(".")[2]
        # A robot's file is not an option but the command's argument.
        parameter = "robot" if path == "robot.file" else option.replace("-", "_")
        value = context.params.get(parameter)
        if context.params.get(f"no_{parameter}"):
            values[path] = False
        # An option that was not given is None, an empty list or a false flag; 0 is a valid seed,
        # and equals False.
        elif value is not None and value is not False and value not in ((), []):
            values[path] = list(value) if isinstance(value, tuple) else value
    typed = specification_from_options(values)
    merged = merge(base, typed)
    if typed.ocs.alpha is not None and typed.ocs.alpha_criterion is not None:
        raise UsageError(
            "--alpha gives the angle, but --alpha-criterion is for finding it",
            hint="leave one of them out",
        )
    if typed.requirement.detection is not None and merged.requirement.notices is None:
        raise UsageError(
            "--detection has no effect without --survives",
            hint="add --survives one, or leave --detection out",
        )
    return merged


def typed_command() -> str:
    """The command as typed, quoted for a shell."""
    return shlex.join(["ocs-design", *sys.argv[1:]])


REPLAY_PARAMETERS = (
    "spec",
    "reality",
    "ballistic",
    "desaturate",
    "survives",
    "detection",
    "robot_file",
    "package_path",
)
"""Parameters of `validate` that decide what a sample is, besides its seed and number."""


def sample_command(context: typer.Context, design: str, seed: int) -> str:
    """Command that flies sample N of a campaign again, quoted for a shell.

    Args:
        context: of the command that flew the campaign.
        design: path of the `design.json`.
        seed: of the campaign.
    """
    options = {parameter.name: parameter.opts[0] for parameter in context.command.params}
    words = ["ocs-design", "validate", design]
    for name in REPLAY_PARAMETERS:
        value = context.params.get(name)
        if value is True:
            words.append(options[name])
        elif value:
            several = value if isinstance(value, list | tuple) else [value]
            words += [word for item in several for word in (options[name], str(item))]
    return shlex.join([*words, "--seed", str(seed), "--sample", "N"])


def package_paths_of_command(context: typer.Context) -> Mapping[str, Path]:
    """`NAME=DIR` pairs of `--package-path`.

    Raises:
        UsageError: a text is not such a pair.
    """
    folders = {}
    for text in context.params["package_path"] or ():
        name, separator, folder = text.partition("=")
        if not (name and separator and folder):
            raise UsageError(
                f"--package-path {text}: expected NAME=DIR",
                hint="as in --package-path my_robot=/opt/my_robot",
            )
        if not Path(folder).is_dir():
            raise UsageError(
                f"--package-path {text}: there is no folder {folder}", hint="check the path"
            )
        folders[name] = Path(folder)
    return folders
