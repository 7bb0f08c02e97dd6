"""Test runs are reproducible; `HYPOTHESIS_PROFILE=explore pytest` searches for new cases.

The laws tested by random cases are smooth: 30 cases find a fault, `explore` tries 500.
"""

import os

import pytest
from hypothesis import settings

LONGEST = "test_the_commands_that_the_docs_show_still_print_that", "test_the_notebook_runs"
PRODUCT_TESTS = "test_product.py"

# With threaded BLAS, workers wait for each other on small matrices. NumPy reads this once.
os.environ.setdefault("OMP_NUM_THREADS", "1")

settings.register_profile("reproducible", derandomize=True, deadline=None, max_examples=30)
settings.register_profile("explore", deadline=None, max_examples=500, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "reproducible"))


def pytest_collection_modifyitems(items):
    """Run the longest tests first, so that no worker is left with them at the end.

    Next comes the file that makes the products of `size`: workers that open them would wait.
    """
    items.sort(key=lambda item: (item.name not in LONGEST, item.path.name != PRODUCT_TESTS))


@pytest.fixture(scope="session")
def solo12():
    """Solo12 of example-robot-data, read once per process."""
    from robots import SOLO12

    from ocs_design.robot.reader import read_robot

    return read_robot(SOLO12)


@pytest.fixture(scope="module")
def no_alternatives():
    """`size` skips the search for lighter alternatives, which takes half of its time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "ocs_design.workflows.size.start_alternatives", lambda *_, call: lambda: ((), None)
        )
        yield


@pytest.fixture
def no_files(monkeypatch):
    """`size` writes its design and report only, for tests that open no other file."""
    monkeypatch.setattr("ocs_design.workflows.size.USUAL_FORMATS", ())
