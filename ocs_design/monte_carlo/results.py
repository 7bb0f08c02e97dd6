"""The folder of a finished campaign: a table of all samples, the worst cases and the record."""

from pathlib import Path

import msgspec

from ocs_design.device.answers import RESULT_FILE, MonteCarloRecord
from ocs_design.export.folder import output_error
from ocs_design.export.staging import clear_leftovers, staging_beside
from ocs_design.monte_carlo.campaign import Campaign, case_of, write_case
from ocs_design.monte_carlo.outcomes import Outcomes, write_tables

WORST_FOLDER = "worst"


def write_results(
    campaign: Campaign, outcomes: Outcomes, record: MonteCarloRecord, folder: Path, *, design: str
) -> tuple[Path, ...]:
    """Write what a campaign came to, in place of earlier results.

    Args:
        campaign: that was flown. outcomes: of its samples. record: what they say together.
        folder: to write to.
        design: hash of the design, for the cases.

    Returns:
        The files, the record last.

    Raises:
        OutputError: the folder cannot be written.
    """
    try:
        clear_leftovers(folder / RESULT_FILE)
        with staging_beside(folder / RESULT_FILE) as staging:
            write_tables(outcomes, [each.maneuver.name for each in campaign.flights], staging)
            worst = staging / WORST_FOLDER
            worst.mkdir()
            rows = {sample: row for row, sample in enumerate(outcomes.index.tolist())}
            for number, scenario in enumerate(record.scenarios):
                for sample in scenario.worst:
                    write_case(case_of(campaign, outcomes, rows[sample], number, design), worst)
            text = msgspec.json.format(msgspec.json.encode(record), indent=2) + b"\n"
            (staging / RESULT_FILE).write_bytes(text)
            # The record comes last: it is gone while the others are not of one run.
            (folder / RESULT_FILE).unlink(missing_ok=True)
            (folder / WORST_FOLDER).mkdir(exist_ok=True)
            for old in (folder / WORST_FOLDER).glob("*.json"):
                old.unlink()
            files = [path.relative_to(staging) for path in staging.rglob("*") if path.is_file()]
            files.sort(key=lambda file: (file.name == RESULT_FILE, file))
            return tuple((staging / file).replace(folder / file) for file in files)
    except OSError as error:
        raise output_error(error, folder) from error
