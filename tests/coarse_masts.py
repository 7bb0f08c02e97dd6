"""A faster search for masts."""

from contextlib import contextmanager

import pytest

from ocs_design.sizing.footing import mast


@contextmanager
def coarse_mast_search():
    """Search masts with the thinnest blocks and the coarsest steps only.

    A search takes longest where it finds no mast.
    """
    with pytest.MonkeyPatch.context() as patch:
        for name in ("SPACERS", "FORMED_SPACERS", "_STEPS"):
            patch.setattr(mast, name, getattr(mast, name)[:1])
        yield
