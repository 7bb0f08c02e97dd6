"""Blocks of samples and their outcomes: arrays, pass rates, tables, the folder of a campaign."""

import csv
import math
import shutil
import zipfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TypeAlias

import msgspec
import numpy as np
from numpy.typing import NDArray

from ocs_design.common.arrays import FloatArray, Table
from ocs_design.common.errors import OutputError
from ocs_design.common.files import to_json
from ocs_design.device.answers import CONFIDENCE, RESULT_FILE, Share
from ocs_design.export.folder import output_error, whole_file
from ocs_design.simulation.run import Metrics
from ocs_design.simulation.verdict import Fault, Verdict

BLOCK = 32
"""Samples per block: enough to keep the processors busy, few enough to stop early."""


Block: TypeAlias = range
"""Indices of samples that are flown together."""


def blocks_of(samples: int, size: int = BLOCK, *, first: int = 0) -> tuple[Block, ...]:
    """Blocks of `samples` samples from index `first` on; the last may be smaller."""
    stop = first + samples
    return tuple(range(start, min(start + size, stop)) for start in range(first, stop, size))


METRICS = tuple(field.name for field in fields(Metrics))
"""Every figure of a flight, in order."""

FAULTS = tuple(Fault)
"""A code of n > 0 is the fault n - 1; 0 is a pass."""


@dataclass(frozen=True, eq=False)
class Outcomes(Table):
    """Outcomes of n samples in s scenarios.

    Attributes:
        index: of each sample, shape (n,).
        values: sampled (SI), shape (n, len(names)).
        metrics: in the order of `METRICS`, NaN for none (SI), shape (n, s, len(METRICS)).
        codes: 0 for a pass, otherwise the code of the fault, see `FAULTS`, shape (n, s).
        names: of the values.
    """

    index: NDArray[np.int64]
    values: FloatArray
    metrics: FloatArray
    codes: NDArray[np.int8]
    names: tuple[str, ...]

    @property
    def passed(self) -> NDArray[np.bool_]:
        """Whether each sample passes each scenario, shape (n, s)."""
        return np.asarray(self.codes == 0)

    @property
    def all_passed(self) -> NDArray[np.bool_]:
        """Whether each sample passes all of its scenarios, shape (n,)."""
        return np.asarray(self.passed.all(axis=1))

    def metric(self, name: str) -> FloatArray:
        """One figure of every flight, shape (n, s)."""
        return np.asarray(self.metrics[:, :, METRICS.index(name)])

    def save(self, path: Path) -> None:
        """Write a file that appears complete or not at all."""
        with whole_file(path) as unfinished, unfinished.open("wb") as stream:
            np.savez_compressed(
                stream,
                index=self.index,
                values=self.values,
                metrics=self.metrics,
                codes=self.codes,
                names=np.array(self.names),
            )

    @classmethod
    def load(cls, path: Path) -> "Outcomes":
        """Read a file that `save` wrote."""
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
            columns = {field.name: stored[field.name] for field in fields(cls)}
            return cls(**columns | {"names": tuple(columns["names"].tolist())})


def code_of(verdict: Verdict) -> int:
    """Code of a verdict, see `FAULTS`."""
    return 0 if verdict.fault is None else 1 + FAULTS.index(verdict.fault)


NAME = "samples"


def share(passed: int, flown: int) -> Share:
    """Pass rate in `flown` > 0 trials, with its exact confidence interval at `CONFIDENCE`.

    The interval is that of Clopper and Pearson (Biometrika 26, 1934, 404-413).
    """
    # Importing SciPy's special functions takes a tenth of a second; its statistics module would
    # take a second more.
    from scipy.special import betaincinv  # noqa: PLC0415

    tail = 0.5 * (1.0 - CONFIDENCE)
    low = float(betaincinv(passed, flown - passed + 1, tail)) if passed else 0.0
    high = 1.0
    if passed < flown:
        high = float(betaincinv(passed + 1, flown - passed, 1.0 - tail))
    return Share(passed=passed, flown=flown, estimate=passed / flown, low=low, high=high)


def shares(outcomes: Outcomes) -> tuple[Share, ...]:
    """Pass rate of each scenario."""
    passed = outcomes.passed.sum(axis=0).tolist()
    return tuple(share(count, len(outcomes.index)) for count in passed)


def write_tables(outcomes: Outcomes, scenarios: Sequence[str], folder: Path) -> tuple[Path, ...]:
    """Write one row per sample and scenario: verdict, figures and sampled values (SI)."""
    samples, count = len(outcomes.index), len(scenarios)
    words = np.array(["pass", *map(str, FAULTS)])
    sampled_values = np.repeat(outcomes.values, count, axis=0)
    figures = outcomes.metrics.reshape(samples * count, len(METRICS))
    columns: Mapping[str, NDArray[np.generic]] = {
        "sample": np.repeat(outcomes.index, count),
        "scenario": np.tile(np.array(scenarios), samples),
        "verdict": words[outcomes.codes.ravel()],
        **dict(zip(METRICS, figures.T, strict=True)),
        **dict(zip(outcomes.names, sampled_values.T, strict=True)),
    }
    # Numbers to six digits; empty cells for missing ones.
    cells = [
        ["" if math.isnan(value) else f"{value:.6g}" for value in values.tolist()]
        if values.dtype.kind == "f"
        else [str(value) for value in values.tolist()]
        for values in columns.values()
    ]
    table = folder / f"{NAME}.csv"
    with table.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(zip(*cells, strict=True))
    if find_spec("pyarrow") is None:
        return (table,)
    # The Parquet file has all digits.
    arrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    all_digits = folder / f"{NAME}.parquet"
    parquet.write_table(arrow.table(dict(columns)), all_digits)
    return (table, all_digits)


CAMPAIGN_FILE = "campaign.json"
BLOCKS = "samples"

_HINT = "choose another folder with -o, or start over with --force"


@dataclass(frozen=True, kw_only=True)
class Identity:
    """Everything that determines a campaign's numbers; campaigns with equal ones share a folder.

    Attributes:
        tool, simulator: versions of this program and of MuJoCo.
        design: SHA-256 of what was designed. robot: SHA-256 of its file.
        reality: the distribution of each key. seed: of all samples.
        hold: physics steps per control step. desaturate: see `Options`.
    """

    schema_version: int
    tool: str
    simulator: str
    design: str
    robot: str
    reality: Mapping[str, str]
    seed: int
    hold: int
    desaturate: bool


class Storage:
    """Blocks in separate files, each complete or absent."""

    def __init__(self, folder: Path, identity: Identity, *, force: bool) -> None:
        """Open or create a folder.

        Args:
            folder: with samples of this campaign, or without any.
            identity: of the campaign.
            force: discard the samples of another campaign.

        Raises:
            OutputError: it holds something else, or cannot be written.
        """
        self.folder = folder
        try:
            recorded = None
            if folder.exists():
                if not folder.is_dir():
                    hint = "choose another name with -o"
                    raise OutputError(f"{folder}: is not a folder", hint=hint)
                with suppress(OSError, msgspec.DecodeError, UnicodeDecodeError, RecursionError):
                    content = (folder / CAMPAIGN_FILE).read_bytes()
                    recorded = msgspec.json.decode(content, type=Identity)
                if recorded is None and any(folder.iterdir()):
                    raise OutputError(
                        f"{folder}: exists, but holds no samples of ocs-design", hint=_HINT
                    )
            if recorded is not None and recorded != identity:
                if not force:
                    different = [
                        name
                        for name in recorded.__dataclass_fields__
                        if getattr(recorded, name) != getattr(identity, name)
                    ]
                    raise OutputError(
                        f"{folder}: holds samples of another campaign; these differ: "
                        f"{', '.join(different)}",
                        hint=_HINT,
                    )
                # Delete the old results first, so that they are never found beside another
                # campaign's samples.
                (folder / RESULT_FILE).unlink(missing_ok=True)
                shutil.rmtree(folder / BLOCKS, ignore_errors=True)
            (folder / BLOCKS).mkdir(parents=True, exist_ok=True)
            with whole_file(folder / CAMPAIGN_FILE) as file:
                file.write_bytes(to_json(identity))
        except OSError as error:
            raise output_error(error, folder) from error

    def load_blocks(self, blocks: Sequence[Block]) -> Mapping[Block, Outcomes]:
        """Blocks that have been flown already."""
        kept = {}
        for block in blocks:
            try:
                outcomes = Outcomes.load(self._path(block))
            except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
                # Missing or damaged: the block is flown again.
                continue
            if outcomes.index.tolist() == list(block):
                kept[block] = outcomes
        return kept

    def save_block(self, block: Block, outcomes: Outcomes) -> None:
        """Write a block.

        Raises:
            OutputError: it cannot be written.
        """
        try:
            outcomes.save(self._path(block))
        except OSError as error:
            raise output_error(error, self._path(block)) from error

    def _path(self, block: Block) -> Path:
        return self.folder / BLOCKS / f"{block.start:07d}.npz"
