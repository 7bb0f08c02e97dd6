"""The whole robot with its device as a MJCF model."""

from pathlib import Path, PurePath

from ocs_design.export.mjcf_precision import precise_xml
from ocs_design.export.robot_model import RobotModel
from ocs_design.export.urdf import WHEEL_MESH

_MESHES = PurePath(WHEEL_MESH).parent


def export_robot_mjcf(model: RobotModel, path: Path) -> Path:
    """Write the robot with both flywheels on its trunk, its meshes and textures beside it.

    The model refers to nothing outside its folder, which can be moved. It has no floor.

    Args:
        model: to write.
        path: of the MJCF.
    """
    text = precise_xml(model.spec, model.compiled, assets=str(_MESHES))
    path.write_bytes(text.encode("utf-8"))
    folder = path.parent / _MESHES
    for name, content in model.spec.assets.items():
        folder.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    return path
