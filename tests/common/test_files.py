import os

import pytest

from ocs_design.common.files import read_plain_file


def test_a_plain_file_is_read_whole(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"1234")
    assert read_plain_file(path, 4) == b"1234"
    with pytest.raises(OSError, match="larger than"):
        read_plain_file(path, 3)


def test_what_never_ends_is_not_begun(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/zero"):
        with pytest.raises(OSError, match="no plain file"):
            read_plain_file(path, 1 << 20)
    with pytest.raises(IsADirectoryError):
        read_plain_file(tmp_path, 1)
    with pytest.raises(FileNotFoundError):
        read_plain_file(tmp_path / "gone", 1)
