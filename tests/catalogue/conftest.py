"""Reading of users' catalogue files."""

import pytest

from ocs_design.catalogue.motors import load_motors


@pytest.fixture
def load(tmp_path):
    """A function that reads a text as a file with this suffix, by default of motors."""

    def write_and_load(text, suffix=".toml", read=load_motors):
        path = tmp_path / f"mine{suffix}"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read(path)

    return write_and_load
