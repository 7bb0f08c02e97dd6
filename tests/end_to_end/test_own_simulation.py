"""The example that flies an exported robot in a simulation of its own."""

import importlib.util
from pathlib import Path

import numpy as np

SCRIPT = Path(__file__).parents[2] / "examples" / "level_in_mujoco.py"


def test_what_falls_tilted_lands_level(product, capsys):
    specification = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    assert abs(module.main(product.folder)) < 0.2 * module.PITCH
    assert "touches down after 0.3" in capsys.readouterr().out
    module.KP = module.KD = 0.0
    np.testing.assert_allclose(module.main(product.folder), module.PITCH, rtol=0.1)
