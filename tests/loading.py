"""What an import brings with it."""

import subprocess
import sys

HEAVY = ("numpy", "scipy", "mujoco", "cvxpy", "trimesh", "casadi", "matplotlib", "pydantic")


def modules_loaded_by(statement):
    """Top-level names in sys.modules of a fresh interpreter after `statement`."""
    code = (
        f"{statement}\nimport sys\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())
