// A device that has spoken LCM long before there was a framework: it sends JOYSTICK and obeys MOTORS.
//
//   device URL COUNT     sends joysticks 1 to COUNT, the next when the motors show that the last one was obeyed
//   device URL           prints what it hears

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include <lcm/lcm.h>

#include "devices_joy_t.h"
#include "devices_motor_t.h"

static int64_t obeyed;

static void on_motor(const lcm_recv_buf_t *received, const char *channel, const devices_motor_t *motor, void *print)
{
    (void)received;
    obeyed = motor->utime;
    if (print) {
        printf("%s %" PRId64 ": %.2f %.2f\n", channel, motor->utime, motor->power[0], motor->power[1]);
        fflush(stdout);
    }
}

static void on_joy(const lcm_recv_buf_t *received, const char *channel, const devices_joy_t *joy, void *user)
{
    (void)received;
    (void)user;
    printf("%s %" PRId64 ": %d axes, %s\n", channel, joy->utime, joy->n_axes, joy->name);
    fflush(stdout);
}

static void send(lcm_t *bus, int64_t number)
{
    double axes[] = {0.5, 0.25 * number, -1.0};
    devices_joy_t joy = {.utime = number, .n_axes = 3, .axes = axes, .trigger = number % 2, .name = "stick"};

    devices_joy_t_publish(bus, "JOYSTICK", &joy);
}

int main(int argc, char **argv)
{
    int64_t count = argc > 2 ? atoll(argv[2]) : 0;
    lcm_t *bus = argc > 1 ? lcm_create(argv[1]) : NULL;

    if (!bus || !devices_motor_t_subscribe(bus, "MOTORS", on_motor, count ? NULL : bus))
        return 1;
    if (!count && !devices_joy_t_subscribe(bus, "JOYSTICK", on_joy, NULL))
        return 1;
    while (!count || obeyed < count) {
        if (count)
            send(bus, obeyed + 1);
        if (lcm_handle_timeout(bus, 100) < 0)
            return 1;
    }
    printf("obeyed %" PRId64 "\n", obeyed);
    lcm_destroy(bus);
    return 0;
}
