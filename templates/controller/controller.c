/* See @{name}_ocs_controller.h. Written by ocs-design; change the design, not this file. */
#include "@{name}_ocs_controller.h"

#include <tgmath.h>

/* One row for each maneuver: @legend. */
static const ocs_real constants[OCS_MANEUVERS][@constant_count] = {
@constants};

/* One row every OCS_PERIOD since lift-off, maneuver after maneuver: @target_legend. */
static const ocs_real targets[][@target_count] = {
@targets};

/* First row of each maneuver, and the end of the last. */
static const int first[OCS_MANEUVERS + 1] = {@first};

#define ocs_sq(x) ((x) * (x))
#define ocs_fmin(x, y) fmin(x, y)
#define ocs_fmax(x, y) fmax(x, y)
#define ocs_inf ((ocs_real)INFINITY)

/* The wheel law, traced by CasADi from the one that flew the design: attitude, rate, wheel speeds,
 * time on the ground, row of targets, row of constants -> torques. */
static void ocs_law(const ocs_real **arg, ocs_real **res) {
@body}

void ocs_step(const ocs_state_t *state, ocs_command_t *command) {
    const ocs_real *arg[6];
    ocs_real *res[1], step, sum = state->time + state->ground_time;
    int i, start, last;

    for (i = 0; i < OCS_WHEELS; i++) {
        command->torque[i] = 0;
        sum += state->wheel_speed[i];
    }
    for (i = 0; i < 4; i++) sum += state->attitude[i];
    for (i = 0; i < 3; i++) sum += state->rate[i];
    if (!isfinite(sum) || state->time < 0) return;
    if (state->maneuver < 0 || state->maneuver >= OCS_MANEUVERS) return;
    start = first[state->maneuver];
    last = first[state->maneuver + 1] - 1;
    step = floor(state->time / (ocs_real)OCS_PERIOD + (ocs_real)0.5);
    arg[0] = state->attitude;
    arg[1] = state->rate;
    arg[2] = state->wheel_speed;
    arg[3] = &state->ground_time;
    arg[4] = targets[step < last - start ? start + (int)step : last];
    arg[5] = constants[state->maneuver];
    res[0] = command->torque;
    ocs_law(arg, res);
}
