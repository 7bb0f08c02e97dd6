/* Reads states from standard input, one per line, and prints the torques with all digits:
 *
 *     maneuver time ground_time attitude[4] rate[3] wheel_speed[OCS_WHEELS]
 *
 * With an argument N it takes N steps of the last state and prints how long each took [ns].
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "@{name}_ocs_controller.h"

int main(int argc, char **argv) {
    double in[9 + OCS_WHEELS];
    ocs_state_t state = {0};
    ocs_command_t command;
    int i, count;

    while (scanf("%d", &state.maneuver) == 1) {
        for (count = 0; count < 9 + OCS_WHEELS; count++)
            if (scanf("%lf", &in[count]) != 1) return EXIT_FAILURE;
        state.time = (ocs_real)in[0];
        state.ground_time = (ocs_real)in[1];
        for (i = 0; i < 4; i++) state.attitude[i] = (ocs_real)in[2 + i];
        for (i = 0; i < 3; i++) state.rate[i] = (ocs_real)in[6 + i];
        for (i = 0; i < OCS_WHEELS; i++) state.wheel_speed[i] = (ocs_real)in[9 + i];
        ocs_step(&state, &command);
        for (i = 0; i < OCS_WHEELS; i++)
            printf("%.17g%c", (double)command.torque[i], i + 1 < OCS_WHEELS ? ' ' : '\n');
    }
    if (argc > 1) {
        long steps = atol(argv[1]), k;
        double sum = 0.0;
        clock_t begin = clock();
        for (k = 0; k < steps; k++) {
            state.rate[0] += (ocs_real)1e-9; /* a new state, so that no compiler moves the step out of the loop */
            ocs_step(&state, &command);
            sum += (double)command.torque[0];
        }
        printf("%.1f ns a step (%g)\n",
               1e9 * (double)(clock() - begin) / CLOCKS_PER_SEC / (double)steps, sum);
    }
    return EXIT_SUCCESS;
}
