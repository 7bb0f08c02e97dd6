"""Scripts outside of the package, loaded as modules; modules that an import loads."""

import importlib.util
import subprocess
import sys

HEAVY = ("numpy", "scipy", "mujoco", "cvxpy", "trimesh", "casadi", "matplotlib", "pydantic")


def script_at(path):
    """The module of a file, registered under its name."""
    name = f"script_{path.stem}"
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module


def modules_loaded_by(statement):
    """Top-level names in sys.modules of a fresh interpreter after `statement`."""
    code = (
        f"{statement}\nimport sys\nprint(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())
