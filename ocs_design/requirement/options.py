"""Options of the command line, read by the same table as the specification file's keys."""

from collections.abc import Mapping
from typing import Any

from ocs_design.exceptions import UsageError
from ocs_design.requirement.faults import Faults
from ocs_design.requirement.specification import SECTIONS, Specification, all_keys


def specification_from_options(options: Mapping[str, object]) -> Specification:
    """The specification that options of the command line state, read as the file's keys are.

    Args:
        options: text or flag by the key's path, as in `flywheel.r_max`; None is not stated.

    Raises:
        UsageError: all faults, each with its option.
    """
    faults = Faults()
    sections: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    for path, raw in options.items():
        section, name = path.split(".")
        key = all_keys()[path]
        if raw is not None:
            named = f"--{key.option or name.replace('_', '-')}"
            option = "ROBOT" if path == "robot.file" else named
            sections[section][name] = faults.read(key.value, raw, option)
    if faults:
        raise UsageError("\n".join(faults))
    return Specification(**{name: SECTIONS[name](**found) for name, found in sections.items()})
