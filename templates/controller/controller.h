/* Flywheels of @name in flight: torque of each motor from attitude, rate and wheel speeds.
 *
 * SI units and radians. Frame B is the trunk's: x forward, y left, z up. No allocation, no state
 * between calls, no unbounded loop. README.md says how to use it.
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
#define OCS_PERIOD @period /* period of the calls of ocs_step() [s]; the torque is held during it */

enum {
@maneuvers    OCS_MANEUVERS /* number of maneuvers */
};

typedef struct {
    int maneuver;          /* OCS_... above */
    ocs_real time;         /* since lift-off or release [s]; negative before: zero torque */
    ocs_real ground_time;  /* on the ground since touchdown [s]; 0: in the air */
    ocs_real attitude[4];  /* of B in the world, unit quaternion w, x, y, z; level: 1, 0, 0, 0 */
    ocs_real rate[3];      /* of the trunk about x, y, z of B [rad/s] */
    ocs_real wheel_speed[OCS_WHEELS]; /* relative to the trunk, about the wheel's own axis [rad/s] */
} ocs_state_t;

typedef struct {
    ocs_real torque[OCS_WHEELS]; /* of the motor on its wheel [N m]; the trunk gets the opposite */
} ocs_command_t;

/* Torques until the next call. All zero for an unknown maneuver and for a state with NaN or
 * infinity. */
void ocs_step(const ocs_state_t *state, ocs_command_t *command);

#ifdef __cplusplus
}
#endif

#endif
