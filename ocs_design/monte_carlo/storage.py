"""The folder of a campaign: its samples as they come, so that a run that was cut short goes on."""

import hashlib
import shutil
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from ocs_design.exceptions import OutputError
from ocs_design.export.folder import output_error
from ocs_design.export.single_file import whole_file
from ocs_design.monte_carlo.blocks import Block
from ocs_design.monte_carlo.outcomes import Outcomes

CAMPAIGN_FILE = "campaign.json"
BLOCKS = "samples"
RESULT_FILE = "monte_carlo.json"
"""It is written last: a folder without it is not complete, and the same command completes it."""

_HINT = "choose another folder with -o, or start anew with --force"


@dataclass(frozen=True, kw_only=True)
class Identity:
    """What the numbers of a campaign follow from; equal ones may share a folder.

    Attributes:
        tool, simulator: versions of this program and of MuJoCo.
        design: SHA-256 of what was designed. robot: SHA-256 of its file.
        reality: the distribution of each key. seed: of all samples.
        hold: steps of the physics per control step. desaturate: see `Options`.
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

    @property
    def key(self) -> str:
        """One short name for all of it."""
        return hashlib.sha256(msgspec.json.encode(self, order="deterministic")).hexdigest()


class Storage:
    """Blocks in files of their own, each complete or not there."""

    def __init__(self, folder: Path, identity: Identity, *, force: bool) -> None:
        """Open or create a folder.

        Args:
            folder: with the samples of this campaign, or of none.
            identity: of the campaign.
            force: throw away the samples of another one.

        Raises:
            OutputError: it holds something else, or cannot be written.
        """
        self.folder = folder
        try:
            if folder.exists():
                self._check(identity, force=force)
            (folder / BLOCKS).mkdir(parents=True, exist_ok=True)
            record = msgspec.json.format(msgspec.json.encode(identity), indent=2)
            with whole_file(folder / CAMPAIGN_FILE) as file:
                file.write_bytes(record + b"\n")
        except OSError as error:
            raise output_error(error, folder) from error

    def found(self, blocks: Sequence[Block]) -> Mapping[Block, Outcomes]:
        """Those that have been flown already."""
        kept = {block: self._load(block) for block in blocks}
        return {block: outcomes for block, outcomes in kept.items() if outcomes is not None}

    def keep(self, block: Block, outcomes: Outcomes) -> None:
        """Write one.

        Raises:
            OutputError: it cannot be written.
        """
        try:
            outcomes.save(self._path(block))
        except OSError as error:
            raise output_error(error, self._path(block)) from error

    def _check(self, identity: Identity, *, force: bool) -> None:
        """Whether this folder may be added to; other samples are thrown away if that is wanted."""
        folder = self.folder
        if not folder.is_dir():
            raise OutputError(f"{folder}: is not a folder", hint="choose another name with -o")
        recorded = _identity_in(folder)
        if recorded is None and any(folder.iterdir()):
            raise OutputError(f"{folder}: exists, and holds no samples of ocs-design", hint=_HINT)
        if recorded is None or recorded.key == identity.key:
            return
        if not force:
            differs = [
                name
                for name in recorded.__dataclass_fields__
                if getattr(recorded, name) != getattr(identity, name)
            ]
            raise OutputError(
                f"{folder}: holds samples of another campaign; not the same: {', '.join(differs)}",
                hint=_HINT,
            )
        # What was made of the samples goes first: it is not to stand beside those of another.
        (folder / RESULT_FILE).unlink(missing_ok=True)
        shutil.rmtree(folder / BLOCKS, ignore_errors=True)

    def _load(self, block: Block) -> Outcomes | None:
        try:
            outcomes = Outcomes.load(self._path(block))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            # Not there, or spoilt by whatever: it is flown again.
            return None
        return outcomes if outcomes.index.tolist() == list(block.samples) else None

    def _path(self, block: Block) -> Path:
        return self.folder / BLOCKS / f"{block.start:07d}.npz"


def _identity_in(folder: Path) -> Identity | None:
    """Of the campaign that the folder holds; None if it holds none that can be read."""
    try:
        return msgspec.json.decode((folder / CAMPAIGN_FILE).read_bytes(), type=Identity)
    except (OSError, msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None
