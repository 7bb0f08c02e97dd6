"""A file that appears whole or not at all."""

import pytest
from commands import everything_in

from ocs_design.common.errors import OutputError
from ocs_design.export.folder import write_whole


def test_it_is_written(tmp_path):
    write_whole(tmp_path / "a.toml", "ä\n", force=False)
    assert (tmp_path / "a.toml").read_bytes() == "ä\n".encode()
    assert everything_in(tmp_path) == ["a.toml"]


def test_what_is_there_stays_without_force(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    with pytest.raises(OutputError, match="exists already"):
        write_whole(file, "new", force=False)
    assert file.read_text() == "mine"
    write_whole(file, "new", force=True)
    assert file.read_text() == "new"


def test_a_folder_is_no_file(tmp_path):
    with pytest.raises(OutputError, match="is not a file"):
        write_whole(tmp_path, "new", force=True)


def test_there_must_be_a_folder_for_it(tmp_path):
    with pytest.raises(OutputError, match="no such folder"):
        write_whole(tmp_path / "none" / "a.toml", "new", force=False)


def test_a_failure_leaves_everything_as_it_was(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("mine")
    # A surrogate has no UTF-8; any failure while writing would do.
    with pytest.raises(UnicodeEncodeError):
        write_whole(file, "half \ud800", force=True)
    assert file.read_text() == "mine"
    assert everything_in(tmp_path) == ["a.toml"]


def test_a_name_that_the_file_system_refuses(tmp_path):
    with pytest.raises(OutputError, match="too long") as refused:
        write_whole(tmp_path / ("a" * 300), "new", force=False)
    assert "shorter" in refused.value.hint
