/* Flywheels of @name in flight: from what the trunk's sensors say to the torque of each motor.
 *
 * SI units and radians. Frame B is the trunk's: x forward, y left, z up. No allocation, no state, no
 * loop without a bound: the same call gives the same answer. README.md says how to use it.
 */
#ifndef OCS_CONTROLLER_H
#define OCS_CONTROLLER_H

#ifdef __cplusplus
extern "C" {
#endif

#ifndef ocs_real
#define ocs_real double /* -Docs_real=float for single precision */
#endif

#define OCS_WHEELS @wheels
#define OCS_PERIOD @period /* call ocs_step() so often [s]: the torque is held as long */

enum {
@maneuvers    OCS_MANEUVERS /* their number */
};

typedef struct {
    int maneuver;          /* OCS_... above */
    ocs_real time;         /* since lift-off or release [s]; negative: not yet, the wheels wait */
    ocs_real ground_time;  /* on the ground since touchdown [s]; 0: in the air */
    ocs_real attitude[4];  /* of B in the world, unit quaternion w, x, y, z; level: 1, 0, 0, 0 */
    ocs_real rate[3];      /* of the trunk about x, y, z of B [rad/s] */
    ocs_real wheel_speed[OCS_WHEELS]; /* relative to the trunk, about the wheel's own axis [rad/s] */
} ocs_state_t;

typedef struct {
    ocs_real torque[OCS_WHEELS]; /* of the motor on its wheel [N m]; the trunk gets the opposite */
} ocs_command_t;

/* Torques until the next call. All zero for an unknown maneuver and for a state that holds NaN or
 * infinity. */
void ocs_step(const ocs_state_t *state, ocs_command_t *command);

#ifdef __cplusplus
}
#endif

#endif
