"""Packages: what this one asks for, by its own metadata, and whether it is there and can be used.

What is asked for stands in pyproject.toml and nowhere else.
"""

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import metadata

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from ocs_design.doctor.finding import Finding, State
from ocs_design.doctor.uses import USES, Use

DISTRIBUTION = "ocs-design"

DEVELOPMENT = frozenset({"test", "dev", "docs"})
"""Extras for those who change the code."""

TIME_LIMIT = 120.0
"""To import everything [s]."""

# What a module prints on its own is no answer.
_IMPORTING = """
import importlib, json, os, sys
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
for name in sys.argv[1:]:
    try:
        importlib.import_module(name)
        error = ""
    except BaseException as failure:
        error = f"{type(failure).__name__}: {failure}".splitlines()[0]
    print(json.dumps([name, error]), file=answers, flush=True)
"""


@dataclass(frozen=True)
class Wanted:
    """A package that is asked for.

    Attributes:
        name: of the package. versions: that are allowed, as pip writes them.
        extra: of ours that asks for it; empty: nothing works without it.
    """

    name: str
    versions: str
    extra: str = ""

    @property
    def use(self) -> Use:
        """What it is for."""
        return USES.get(self.name, Use(f"the extra {self.extra}"))

    @property
    def module(self) -> str:
        """To import."""
        return self.use.module or self.name.replace("-", "_")

    def cure(self, state: State) -> str:
        """The command that mends it."""
        if state is State.WORKS:
            return ""
        if state is State.BROKEN:
            return f"pip install --force-reinstall '{self.name}{self.versions}'"
        what = f"{DISTRIBUTION}[{self.extra}]" if self.extra else f"{self.name}{self.versions}"
        return f"pip install '{what}'"


def wanted_packages() -> tuple[Wanted, ...]:
    """Everything that users may want, what is required first.

    Raises:
        importlib.metadata.PackageNotFoundError: this package itself is not installed.
    """
    requirements = [Requirement(line) for line in metadata.requires(DISTRIBUTION) or ()]
    extras = metadata.metadata(DISTRIBUTION).get_all("Provides-Extra") or ()
    required = [_wanted(each) for each in requirements if each.marker is None]
    optional = [
        _wanted(each, extra)
        for extra in extras
        if extra not in DEVELOPMENT
        for each in requirements
        if each.marker is not None and each.marker.evaluate({"extra": extra})
    ]
    return (*sorted(required, key=lambda each: each.name), *optional)


def _wanted(requirement: Requirement, extra: str = "") -> Wanted:
    return Wanted(canonicalize_name(requirement.name), str(requirement.specifier), extra)


def package_findings(wanted: Sequence[Wanted]) -> Iterator[Finding]:
    """How each is; all are imported, in a process of its own."""
    versions = {each.name: _version(each.name) for each in wanted}
    failures = import_failures([each.module for each in wanted if versions[each.name]])
    for each in wanted:
        found = versions[each.name]
        reason = failures.get(each.module, "")
        state = _state(each, found, reason)
        yield Finding(
            name=each.name,
            state=state,
            required=not each.extra,
            found=found,
            wanted=each.versions,
            purpose=each.use.purpose,
            cure=each.cure(state),
            reason=reason,
        )


def import_failures(modules: Sequence[str]) -> Mapping[str, str]:
    """Why each module could not be imported; those that could are not in it."""
    command = [sys.executable, "-c", _IMPORTING, *modules]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, check=False, timeout=TIME_LIMIT
        )
        said, ended = done.stdout, f"the process ended with code {done.returncode}"
    except subprocess.TimeoutExpired as error:
        said = (error.stdout or b"").decode() if isinstance(error.stdout, bytes) else ""
        ended = f"not done within {TIME_LIMIT:g} s"
    told = dict(json.loads(line) for line in said.splitlines())
    return {name: told.get(name, ended) for name in modules if told.get(name, ended)}


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return ""


def _state(wanted: Wanted, found: str, failure: str) -> State:
    if not found:
        return State.MISSING
    if failure:
        return State.BROKEN
    allowed = Requirement(f"{wanted.name}{wanted.versions}").specifier
    return State.WORKS if allowed.contains(found, prereleases=True) else State.UNFIT
