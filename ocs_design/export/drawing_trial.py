"""Draws one box with the way of OpenGL that MUJOCO_GL names, and ends well if it is to be seen.

A program of its own, for a process of its own: see `opengl`.
"""

import sys

import mujoco

from ocs_design.export.camera_views import WHITE, sheet_of_views

BOX = '<mujoco><worldbody><geom type="box" size="1 1 1" rgba="1 0 0 1"/></worldbody></mujoco>'


def main() -> None:
    """Draw and look."""
    model = mujoco.MjModel.from_xml_string(BOX)
    sheet = sheet_of_views(model, model.qpos0)
    middle = sheet[sheet.shape[0] // 4, sheet.shape[1] // 4]
    if min(middle) == WHITE:
        sys.exit("a box was drawn and is not to be seen")


if __name__ == "__main__":
    main()
