import pytest
from wheels import paper_device

from ocs_design.simulation.world_builder import WorldBuilder


@pytest.fixture(scope="session")
def builder(solo12) -> WorldBuilder:
    """Worlds of Solo12 with the paper's device."""
    return WorldBuilder(solo12, paper_device())
