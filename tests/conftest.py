"""The same test run gives the same answer; `HYPOTHESIS_PROFILE=explore pytest` seeks new cases.

Laws that are drawn for are smooth: thirty cases find what is wrong with one, `explore` has 500.
"""

import os

import pytest
from hypothesis import settings

LONGEST = "test_the_commands_that_the_docs_show_still_print_that", "test_the_notebook_runs"
OPENED_BY_MANY = "test_product.py"

# Workers whose small matrices have threads of their own wait for each other. NumPy reads it once.
os.environ.setdefault("OMP_NUM_THREADS", "1")

settings.register_profile("reproducible", derandomize=True, deadline=None, max_examples=30)
settings.register_profile("explore", deadline=None, max_examples=500, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "reproducible"))


def pytest_collection_modifyitems(items):
    """The longest tests go first, so that one worker is not left with them when all others end.

    Next comes the file that makes the products of `size`: a worker that comes to another file that
    opens them would wait till they are there.
    """
    items.sort(key=lambda item: (item.name not in LONGEST, item.path.name != OPENED_BY_MANY))


@pytest.fixture(scope="session")
def solo12():
    """Solo12 of example-robot-data, read once in a process that asks for it."""
    from robots import SOLO12

    from ocs_design.robot.reader import read_robot

    return read_robot(SOLO12)


@pytest.fixture(scope="module")
def no_alternatives():
    """`size` looks for nothing lighter: half of its time, where nothing is asked of it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "ocs_design.workflows.size.start_alternatives", lambda *_, call: lambda: ((), None)
        )
        yield


@pytest.fixture
def no_files(monkeypatch):
    """`size` writes its design and its report alone, where no part or robot is opened."""
    monkeypatch.setattr("ocs_design.workflows.size.USUAL_FORMATS", ())
