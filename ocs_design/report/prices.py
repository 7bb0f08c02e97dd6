"""What one more of each limit would buy, and where the choice of the drive may jump."""

from collections.abc import Iterator

from ocs_design.report.selection import best_drives, drive_name
from ocs_design.selection_record import PriceRecord, SelectionRecord
from ocs_design.sizing.limits import LIMITS, TIME

COLUMNS = ("limit", "change", "both modules")

_NOTHING = 5e-6
"""[kg], less than is shown."""


def price_cells(price: PriceRecord) -> tuple[str, str, str]:
    """In the columns of `COLUMNS`."""
    return LIMITS[price.limit].label, _change(price), _bought(price)


def what_buys(selection: SelectionRecord) -> str:
    """Every change that makes the device lighter, on one line; empty where no price is known."""
    worth = sorted(filter(_is_worth, selection.prices), key=lambda price: price.mass_change)
    told = (": ".join((" ".join(price_cells(each)[:2]), _bought(each))) for each in worth)
    return "; ".join(told) or ("no single limit" if selection.prices else "")


def price_notes(selection: SelectionRecord) -> Iterator[str]:
    """What the prices hold for."""
    chosen, *others = best_drives(selection.ranking)
    yield f"Each change alone, the device sized anew with {drive_name(chosen)} and its material."
    if others:
        apart = 1e3 * (others[0].mass - chosen.mass)
        yield (
            f"The next lightest drive, {drive_name(others[0])}, is {apart:.1f} g heavier: where a "
            "change makes another the lightest the mass jumps, and falls by more than is told here."
        )


def _is_worth(price: PriceRecord) -> bool:
    return price.mass_change < -_NOTHING


def _change(price: PriceRecord) -> str:
    limit = LIMITS[price.limit]
    if limit is TIME:
        return f"{price.changed - price.value:+.0%}"
    before, after = (f"{value * limit.per_si:.4g}" for value in (price.value, price.changed))
    return f"{before} to {after} {limit.unit}".rstrip()


def _bought(price: PriceRecord) -> str:
    return f"{1e3 * price.mass_change:+.2f} g" if _is_worth(price) else "no change"
