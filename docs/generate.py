"""Fills in what the docs quote from the program, so that they cannot say what it does not.

    python docs/generate.py            runs everything, writes the pages
    python docs/generate.py --quick    leaves out what must be run, which takes a minute
    python docs/generate.py --check    writes nothing; fails if a quick block is stale

See `blocks`. Kinds:

    help: COMMAND          what `ocs-design COMMAND --help` prints
    keys: SECTION          table of the keys of one section of the specification file
    maneuver keys: KIND    table of the keys of one kind of [[maneuver]]
    run: COMMAND LINE      what the command prints, run in an empty folder that holds `examples/`
    refused: COMMAND LINE  the same for one that no design can satisfy, which is exit code 4
    source: FILE           a script, from the folder of the project
    certificate: ROBOT     what many flights say of its device, from certified.json
    certificates: all      the same of every robot there, as a table
    characteristic: SHARE  how often the sequential test says what, exactly
    distributions: all     table of what samples draw, with the sources
    records: all           tables of the keys of `design.json`, from the docstrings of its records
"""

import argparse
import inspect
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import get_args, get_type_hints

sys.path.insert(0, str(Path(__file__).parent))  # for those who load this file from elsewhere

import blocks
import certified
import typer
from blocks import table
from typer.core import TyperCommand, TyperGroup

from ocs_design.cli.app import app
from ocs_design.device.records.design import OcsDesign
from ocs_design.requirement.keys import keys_of
from ocs_design.requirement.kinds import MANEUVER_KINDS
from ocs_design.requirement.specification import SECTIONS
from ocs_design.requirement.uncertainty import entries, parts_of, spreads
from ocs_design.requirement.values import Choice, Value

ROOT = Path(__file__).resolve().parents[1]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
CLI_PAGE = ROOT / "docs" / "cli.md"
WIDTH = 80

OPTIONS = {"validation.enabled": "--no-validate"}
"""Options that are not named after their key."""


def command_help(name: str) -> str:
    """What `--help` prints; `ocs-design` stands for the program itself."""
    group = typer.main.get_command(app)
    outer = group.context_class(
        group, info_name="ocs-design", max_content_width=WIDTH, **group.context_settings
    )
    if name == "ocs-design":
        return fenced(group.get_help(outer))
    command = commands()[name]
    inner = command.context_class(command, outer, info_name=name, max_content_width=WIDTH)
    return fenced(command.get_help(inner))


def commands() -> Mapping[str, TyperCommand | TyperGroup]:
    """Every command by its name, those of a group as `group command`, in the order of the app."""
    return dict(walk(typer.main.get_command(app), ""))


def walk(
    group: TyperCommand | TyperGroup, prefix: str
) -> Iterator[tuple[str, TyperCommand | TyperGroup]]:
    """Commands below `group`, each after the group that holds it."""
    for name, command in getattr(group, "commands", {}).items():
        yield prefix + name, command
        yield from walk(command, f"{prefix}{name} ")


def section_keys(section: str) -> str:
    """Table of one section's keys, each with its option where there is one.

    An option that `size` does not have is shown with a command that has it.
    """
    places = {
        option: name
        for name, command in commands().items()
        for parameter in command.params
        for option in parameter.opts
    }
    places |= {option: "" for each in commands()["size"].params for option in each.opts}
    rows = []
    for name, key in keys_of(SECTIONS[section]).items():
        option = OPTIONS.get(f"{section}.{name}", f"--{key.option or name.replace('_', '-')}")
        shown = f"`{f'{places[option]} {option}'.strip()}`" if option in places else ""
        rows.append((f"`{name}`", shown, accepts(key.value), key.summary))
    return table(("key", "option", "takes", "meaning"), rows)


def maneuver_keys(kind: str) -> str:
    """Table of the keys of one kind of maneuver."""
    entry = MANEUVER_KINDS[kind]
    rows = [
        (
            f"`{name}`",
            accepts(value),
            "yes" if name in entry.required else "no",
            entry.notes[name],
        )
        for name, value in entry.values.items()
    ]
    return table(("key", "takes", "required", "meaning"), rows)


def accepts(value: Value[object]) -> str:
    """What a key takes, its words marked as code."""
    if isinstance(value, Choice):
        return ", ".join(f"`{word}`" for word in value.words)
    return value.takes.replace("true or false", "`true` or `false`")


def distributions(_which: str) -> str:
    """Table of the package's own distributions."""
    often = {
        ("",): "once",
        ("wheel",): "for each wheel",
        ("x", "y", "z"): "for x, y and z",
        ("roll", "pitch"): "for roll and pitch",
    }
    rows = (
        (
            f"`{name}`",
            entry.words(spreads()[name]),
            often[parts_of(name, ("wheel",))],
            entry.source,
        )
        for name, entry in entries().items()
    )
    return table(("key", "default", "drawn", "what it rests on"), rows)


def records(_which: str) -> str:
    """Tables of the keys below each key of `design.json`."""
    places: dict[type, list[str]] = {}
    for place, record in records_below(OcsDesign, ""):
        places.setdefault(record, []).append(f"`{place}`")
    parts = []
    for record, where in places.items():
        rows = [(f"`{key}`", meaning) for key, meaning in keys_and_meanings(record).items()]
        parts.append(f"## {', '.join(where)}\n\n{table(('key', 'meaning'), rows)}")
    return "\n" + "\n".join(parts) + "\n"


def records_below(record: type, place: str) -> Iterator[tuple[str, type]]:
    """Records in the fields of one, each with its place; `[]` stands for the entries of a list."""
    for name, hint in get_type_hints(record).items():
        inner = f"{place}.{name}".lstrip(".")
        for option in (hint, *get_args(hint)):
            entries_of_list = "[]" if tuple in {hint, getattr(hint, "__origin__", None)} else ""
            if is_dataclass(option) and name in {field.name for field in fields(record)}:
                yield inner + entries_of_list, option
                yield from records_below(option, inner + entries_of_list)


def keys_and_meanings(record: type) -> Mapping[str, str]:
    """Keys of a record, each with its meaning by the docstrings of the class and its bases."""
    names = [field.name for field in fields(record)]
    key, meanings = "|".join(names), {}
    for part in reversed(record.__mro__):
        _, _, listed = (inspect.cleandoc(part.__doc__ or "")).partition("\nAttributes:\n")
        text = " ".join(listed.partition("\n\n")[0].split())
        _, *told = re.split(rf"(?:^|(?<=[.\]] )|(?<=\.\) ))((?:(?:{key})(?:, )?)+): ", text)
        for group, meaning in zip(told[::2], told[1::2], strict=True):
            meanings |= dict.fromkeys(group.split(", "), meaning.strip().replace("None", "null"))
    return {name: meanings[name] for name in names}


@cache  # Two pages show the same one.
def run(command_line: str, exit_code: int = 0) -> str:
    """The output of a command, both streams in order, in an empty folder with the examples."""
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": str(WIDTH),
        "NO_COLOR": "1",
    }
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "examples").symlink_to(ROOT / "examples")
        done = subprocess.run(
            shlex.split(command_line),
            cwd=folder,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
    if done.returncode != exit_code:
        raise SystemExit(f"exit {done.returncode}: {command_line}\n{done.stdout}")
    return fenced(f"$ {command_line}\n{done.stdout}")


def source(file: str) -> str:
    """A script as it is."""
    return fenced((ROOT / file).read_text(encoding="utf-8"), "python")


def fenced(text: str, language: str = "text") -> str:
    """A block of plain text, or of a language."""
    lines = [line.rstrip() for line in text.strip("\n").splitlines()]
    return "\n".join([f"```{language}", *lines, "```\n"])


KINDS: Mapping[str, Callable[[str], str]] = {
    "help": command_help,
    "keys": section_keys,
    "maneuver keys": maneuver_keys,
    "source": source,
    "distributions": distributions,
    "records": records,
    "certificate": certified.sentence,
    "certificates": certified.certificates,
    "characteristic": certified.characteristic,
    "run": run,
    "refused": lambda command_line: run(command_line, exit_code=4),
}
SLOW = ("run", "refused")
QUICK = {kind: make for kind, make in KINDS.items() if kind not in SLOW}


def cli_page() -> str:
    """The command line reference, one section a command, its blocks still empty."""
    intro = CLI_PAGE.read_text().split("\n## ", 1)[0].rstrip()
    sections = [
        f"## `{title}`\n\n<!-- begin help: {name} -->\n<!-- end -->\n"
        for title, name in [("ocs-design", "ocs-design")]
        + [(f"ocs-design {name}", name) for name in commands()]
    ]
    return "\n\n".join([intro, *(section.rstrip() for section in sections)]) + "\n"


def page(path: Path, kinds: Mapping[str, Callable[[str], str]]) -> str:
    """What a page should hold."""
    return blocks.filled(cli_page() if path == CLI_PAGE else path.read_text(), kinds)


def stale_pages() -> list[str]:
    """Pages whose quick blocks are not what the program says."""
    return [str(path.relative_to(ROOT)) for path in PAGES if page(path, QUICK) != path.read_text()]


def main() -> None:
    """Write or check."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="leave what must be run as it is")
    parser.add_argument("--check", action="store_true", help="write nothing, fail on stale pages")
    arguments = parser.parse_args()
    if not arguments.check:
        for path in PAGES:
            path.write_text(page(path, QUICK if arguments.quick else KINDS))
    elif stale := stale_pages():
        raise SystemExit(f"stale: {', '.join(stale)}; run python docs/generate.py")


if __name__ == "__main__":
    main()
