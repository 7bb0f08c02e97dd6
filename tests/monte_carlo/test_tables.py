"""All samples as a table, read by others."""

import csv

import numpy as np
import pyarrow.parquet
from made_outcomes import made_outcomes

from ocs_design.monte_carlo.outcomes import write_tables


def test_csv_and_parquet_hold_the_same_rows(tmp_path):
    outcomes = made_outcomes(range(20), 2)
    outcomes.metrics[0, 0, 0] = np.nan
    text, parquet = write_tables(outcomes, ["a drop, tilted", "flip"], tmp_path)
    with text.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    table = pyarrow.parquet.read_table(parquet).to_pylist()
    assert len(rows) == len(table) == 40
    assert [row["scenario"] for row in rows[:2]] == ["a drop, tilted", "flip"]
    assert rows[0]["touchdown_time"] == ""
    for one, other in zip(rows, table, strict=True):
        assert int(one["sample"]) == other["sample"]
        assert one["verdict"] == other["verdict"]
        np.testing.assert_allclose(float(one["com_error.x"]), other["com_error.x"], rtol=1e-5)
        assert other["mass_error"] == other["touchdown_pitch"]
