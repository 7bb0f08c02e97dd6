"""Searches of masts that take less time."""

from contextlib import contextmanager

import pytest

from ocs_design.sizing.footing import mast


@contextmanager
def coarse_mast_search():
    """Masts are looked for with the thinnest blocks and in the coarser steps alone.

    A search takes longest where it finds none.
    """
    with pytest.MonkeyPatch.context() as patch:
        for name in ("SPACERS", "FORMED_SPACERS", "_STEPS"):
            patch.setattr(mast, name, getattr(mast, name)[:1])
        yield
