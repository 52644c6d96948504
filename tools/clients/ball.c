// Prints the ball as a robot sees it: a C program that knows nothing of the framework but its .lcm files.
//
//   mkdir -p build
//   lcm-gen -c --c-cpath build --c-hpath build lcmtypes/*.lcm
//   cc -Ibuild -o ball tools/clients/ball.c build/*.c -llcm
//   ./ball cyan1
//
// Without an installed liblcm, the one in Python's lcm package does: add -I$P/include -L$P/lib -Wl,-rpath,$P/lib,
// where P is the folder that "python -c 'import lcm; print(lcm.__path__[0] + \"/..\")'" prints.

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include <lcm/lcm.h>

#include "soccer_world_model_t.h"

// LCM's default bus, with a receive buffer that does not overflow in the first busy moment.
static const char *DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

static void on_world_model(const lcm_recv_buf_t *received, const char *channel, const soccer_world_model_t *model,
                           void *user)
{
    long *left = user;
    const soccer_ball_estimate_t *ball = &model->ball;

    (void)received;
    printf("%s tick %" PRId64 ": ", channel, model->header.tick);
    if (ball->known)
        printf("ball at (%.2f, %.2f) m, moving (%.2f, %.2f) m/s, seen %.2f s ago\n", ball->x_m, ball->y_m, ball->vx_m_s,
               ball->vy_m_s, ball->age_s);
    else
        printf("ball unknown\n");
    fflush(stdout);
    if (*left > 0)
        --*left;
}

int main(int argc, char **argv)
{
    char channel[64];
    long left = argc > 3 ? atol(argv[3]) : -1; // negative: for ever
    lcm_t *bus;

    if (argc < 2 || argc > 4) {
        fprintf(stderr, "usage: %s ROBOT [URL [COUNT]], for example: %s cyan1\n", argv[0], argv[0]);
        return 2;
    }
    if (snprintf(channel, sizeof channel, "%s/world_model", argv[1]) >= (int)sizeof channel) {
        fprintf(stderr, "%s: the robot's name is too long\n", argv[1]);
        return 2;
    }
    bus = lcm_create(argc > 2 ? argv[2] : DEFAULT_URL);
    if (!bus || !soccer_world_model_t_subscribe(bus, channel, on_world_model, &left)) {
        fprintf(stderr, "cannot listen to %s; 'fwk doctor' checks multicast\n", channel);
        return 1;
    }
    while (left != 0 && lcm_handle(bus) == 0)
        ;
    lcm_destroy(bus);
    return left > 0;
}
