"""A statement of the paper beside what comes out here."""

from dataclasses import dataclass

HEADER = ("the paper", "stated", "here", "difference", "why")


@dataclass(frozen=True)
class Statement:
    """One line of a table.

    Attributes:
        what: the paper says. stated: as it says it. found: what comes out here.
        difference: of the second from the first; empty: none, or nothing to subtract.
        why: there is one, or what else to know.
    """

    what: str
    stated: str
    found: str
    difference: str = ""
    why: str = ""


def number(what: str, stated: str, found: float, unit: str = "", why: str = "") -> Statement:
    """Of a number that is computed here from something else."""
    share = found / float(stated) - 1.0
    space = "" if unit in {"", "°"} else " "
    here = f"{found:.3e}" if "e" in stated else f"{found:.4g}"
    return Statement(what, f"{stated}{space}{unit}", f"{here}{space}{unit}", f"{share:+.1%}", why)


def taken(what: str, value: str, why: str = "") -> Statement:
    """Of what the paper sets and what is taken over as it is."""
    return Statement(what, value, value, "taken over", why)


def outcome(what: str, stated: str, found: str, *, agrees: bool, why: str = "") -> Statement:
    """Of what happens, in words."""
    return Statement(what, stated, found, "confirmed" if agrees else "not confirmed", why)
