"""The designed robot as an environment: `gymnasium.make("ocs_design.gym:OcsFlight-v0")`.

Gymnasium imports the module named before the colon, so this module loads nothing else.
"""

from ocs_design.common.errors import MissingToolError, extra_command

try:
    from gymnasium.envs.registration import register
except ModuleNotFoundError as error:
    raise MissingToolError(
        "the learning environment needs gymnasium, which is not installed",
        hint=extra_command("gym"),
    ) from error

ENVIRONMENT = "OcsFlight-v0"

register(id=ENVIRONMENT, entry_point="ocs_design.gym.environment:OcsFlight")
