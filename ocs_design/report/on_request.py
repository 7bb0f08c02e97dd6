"""What `export` writes of a design and its flights, beside the formats of a device."""

from collections.abc import Collection
from pathlib import Path

from ocs_design.export.formats import ALL
from ocs_design.exporting import Finish, Order

FIGURES, REPORT = "figures", "report"

ON_DESIGN = (FIGURES, REPORT)
"""Names that users say."""


def finishing(names: Collection[str], command: str) -> Finish | None:
    """What writes them; None where none of them is among the names.

    Args:
        names: as users say them.
        command: that was typed.
    """
    wanted = [name for name in ON_DESIGN if name in names or ALL in names]

    def finish(order: Order, folder: Path) -> tuple[str, ...]:
        """See `Finish`."""
        # It needs the simulator's values, which parts and snippets do without.
        from ocs_design.report.made_again import write_wanted  # noqa: PLC0415

        return write_wanted(wanted, order, folder, command)

    return finish if wanted else None
