"""A few mutated files for every reader; `benchmarks/hostile_input.py` reads thousands."""

import random
from contextlib import suppress

import pytest
from hostile_readers import READERS, mutated

from ocs_design.common.errors import OcsError

CASES = {"xacro": 4}
USUAL = 20


@pytest.mark.parametrize("name", READERS)
def test_original_files_are_read(name, tmp_path):
    if name == "xacro":
        pytest.importorskip("xacro")
    for content in READERS[name].seeds:
        (tmp_path / READERS[name].file).write_bytes(content)
        READERS[name].read(tmp_path / READERS[name].file)
    assert READERS[name].seeds


@pytest.mark.parametrize("name", READERS)
def test_a_mutated_file_is_read_or_refused(name, tmp_path):
    if name == "xacro":
        pytest.importorskip("xacro")
    reader, random_source = READERS[name], random.Random(20261121)
    path = tmp_path / reader.file
    for _ in range(CASES.get(name, USUAL)):
        path.write_bytes(mutated(reader.seeds, reader.words, random_source))
        with suppress(OcsError):
            reader.read(path)
        assert {file.name for file in tmp_path.iterdir()} <= {reader.file, "mesh.urdf"}
