"""Scripts that stand outside of the package, loaded as modules."""

import importlib.util
import sys


def script_at(path):
    """The module of a file, which may look itself up by its name."""
    name = f"script_{path.stem}"
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module
