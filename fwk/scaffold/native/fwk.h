/*
 * fwk.h: a C or C++ program as a component of a plan.
 *
 * The launch file names the program, its ports and its stage:
 *
 *     robot/follower:
 *       command: [./follower]
 *       config: {coding: lcm}
 *       stage: act
 *       reads: {ball: play.ball_t}
 *       writes: {motor: drive.motor_t}
 *
 * The program reads its inputs and writes its outputs, iteration by iteration:
 *
 *     #define FWK_IMPLEMENTATION
 *     #include "fwk.h"
 *     #include "play_ball_t.h"
 *     #include "drive_motor_t.h"
 *
 *     int main(void)
 *     {
 *         fwk_t *fwk = fwk_open();
 *         int ball = fwk_reads(fwk, "ball"), motor = fwk_writes(fwk, "motor");
 *         drive_motor_t command = {.header = {.writer = ""}};  // every string of a message has to be set
 *
 *         while (fwk_next(fwk)) {
 *             for (int i = 0; i < fwk_count(fwk, ball); i++) {
 *                 play_ball_t seen;
 *                 if (FWK_GET(fwk, play_ball_t, ball, i, &seen)) {
 *                     command.power = seen.x_m;
 *                     play_ball_t_decode_cleanup(&seen);
 *                 }
 *             }
 *             FWK_PUT(fwk, drive_motor_t, motor, &command);
 *         }
 *         return fwk_close(fwk);
 *     }
 *
 * The framework does the rest: it waits for messages up to the marks, repeats nothing, stamps the headers, answers
 * fetches, starts the program and starts it again. `fwk types --lang c DIR` writes this file and the types; nothing
 * has to be linked. Standard output goes to the log, as standard error does.
 */
#ifndef FWK_H
#define FWK_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fwk fwk_t;

/* Begins. Ends the process with a message if it was not started by fwk. */
fwk_t *fwk_open(void);

/* Number of a port of the launch file. Ends the process with a message if there is no such port. */
int fwk_reads(fwk_t *fwk, const char *port);
int fwk_writes(fwk_t *fwk, const char *port);

/* Full name of the component, such as "robot/follower", and its settings as JSON. Valid until fwk_close. */
const char *fwk_name(const fwk_t *fwk);
const char *fwk_settings(const fwk_t *fwk);

/* Sends what was written and waits for the next iteration. 0: there is none, the program should end. */
int fwk_next(fwk_t *fwk);

/* Tick and logical time of this iteration, and the time from one to the next. In the last one, `fwk_is_final`,
 * actuators are to be stopped. */
int64_t fwk_tick(const fwk_t *fwk);
int64_t fwk_time_us(const fwk_t *fwk);
int64_t fwk_period_us(const fwk_t *fwk);
int fwk_is_final(const fwk_t *fwk);

/* Number of messages of a port since the last iteration, and one of them, encoded; the oldest is number 0. */
int fwk_count(const fwk_t *fwk, int port);
const void *fwk_message(const fwk_t *fwk, int port, int number, int *size);

/* Room for an encoded message of `size` bytes, which is sent at the end of the iteration. */
void *fwk_write(fwk_t *fwk, int port, int size);

/* Sends what was written last and ends. Returns 0, the exit code of main. */
int fwk_close(fwk_t *fwk);

/* The same with types of lcm-gen: decode message `number` into *value (1: done, 0: it cannot be decoded) ... */
#define FWK_GET(fwk, type, port, number, value) fwk_get_((fwk), (port), (number), (value), (fwk_decode_t)type##_decode)
/* ... and encode *value. */
#define FWK_PUT(fwk, type, port, value) \
    ((void)type##_encode(fwk_write((fwk), (port), type##_encoded_size(value)), 0, type##_encoded_size(value), (value)))

/*
 * Services of the launch file (`serves: {ask: [walk.ask_t, walk.told_t]}`, likewise `calls`) are ports that are read
 * and written. Of a service that the program offers it reads requests, and answers each, perhaps later, with its reply;
 * `state` is CORE_ANSWER_T_ACCEPTED, _DONE, _REJECTED or _FAILED, and reply->answer.reason says why. Of a service that
 * it uses it writes requests, which count from 1 in a life of the program, and reads replies: answer.sequence is the
 * number of the request, answer.state its state, CORE_ANSWER_T_EXPIRED also when no answer came in time.
 */
#define FWK_ANSWER(fwk, type, port, request, reply, how) \
    ((reply)->answer.sequence = (request)->header.sequence, (reply)->answer.state = (how), FWK_PUT(fwk, type, port, reply))

typedef int (*fwk_decode_t)(const void *data, int offset, int size, void *value);
int fwk_get_(const fwk_t *fwk, int port, int number, void *value, fwk_decode_t decode);

#ifdef __cplusplus
}
#endif
#endif

#if defined(FWK_IMPLEMENTATION) && !defined(FWK_IMPLEMENTED)
#define FWK_IMPLEMENTED

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef __cplusplus
extern "C" {
#endif

struct fwk {
    int in, out;           /* the request and the answer */
    uint8_t *request;      /* body of the present request */
    uint32_t size;         /* its length */
    uint32_t kind, parts;  /* 0: init, 1: iteration, 2: final; number of messages */
    int64_t tick, time_us, period_us;
    uint8_t *answer;       /* answer so far, with its head */
    size_t written, room;
    uint32_t messages;
    char *name, *settings;
    char **reads, **writes;
    int n_reads, n_writes, answers;
};

enum { FWK_HEAD = 32, FWK_ANSWER_HEAD = 8, FWK_PART = 8 };

static void fwk_fail(const char *reason, const char *detail)
{
    fprintf(stderr, "fwk: %s%s\n", reason, detail);
    exit(2);
}

static void *fwk_room(void *old, size_t size)
{
    void *made = realloc(old, size ? size : 1);
    if (!made)
        fwk_fail("no memory left", "");
    return made;
}

static uint32_t fwk_get32(const uint8_t *data)
{
    return (uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 | data[3];
}

static int64_t fwk_get64(const uint8_t *data)
{
    return (int64_t)((uint64_t)fwk_get32(data) << 32 | fwk_get32(data + 4));
}

static void fwk_put32(uint8_t *data, uint32_t value)
{
    data[0] = (uint8_t)(value >> 24);
    data[1] = (uint8_t)(value >> 16);
    data[2] = (uint8_t)(value >> 8);
    data[3] = (uint8_t)value;
}

/* Reads exactly `size` bytes; 0 at the end of the input. */
static int fwk_fill(fwk_t *fwk, uint8_t *data, size_t size)
{
    while (size) {
        ssize_t n = read(fwk->in, data, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return 0;
        data += n;
        size -= (size_t)n;
    }
    return 1;
}

static int fwk_receive(fwk_t *fwk)
{
    uint8_t head[FWK_HEAD + 4];

    if (!fwk_fill(fwk, head, sizeof head))
        return 0;
    fwk->size = fwk_get32(head) - FWK_HEAD;
    fwk->kind = fwk_get32(head + 4);
    fwk->tick = fwk_get64(head + 8);
    fwk->time_us = fwk_get64(head + 16);
    fwk->period_us = fwk_get64(head + 24);
    fwk->parts = fwk_get32(head + 32);
    fwk->request = (uint8_t *)fwk_room(fwk->request, fwk->size);
    fwk->written = FWK_ANSWER_HEAD;
    fwk->messages = 0;
    fwk->answers = 1;
    return fwk_fill(fwk, fwk->request, fwk->size);
}

static void fwk_send(fwk_t *fwk)
{
    size_t done = 0;

    if (!fwk->answers)
        return;
    fwk->answers = 0;
    fwk_put32(fwk->answer, (uint32_t)(fwk->written - 4));
    fwk_put32(fwk->answer + 4, fwk->messages);
    while (done < fwk->written) {
        ssize_t n = write(fwk->out, fwk->answer + done, fwk->written - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            exit(1); /* the framework is gone */
        done += (size_t)n;
    }
}

/* Message `number` of a port, or of any port if `port` is negative; NULL if there are fewer. */
static const uint8_t *fwk_part(const fwk_t *fwk, int port, int number, int *size, int *found)
{
    const uint8_t *at = fwk->request, *end = fwk->request + fwk->size;

    for (uint32_t i = 0; i < fwk->parts && end - at >= FWK_PART; i++) {
        uint32_t own = fwk_get32(at), length = fwk_get32(at + 4);
        at += FWK_PART;
        if (length > (size_t)(end - at))
            break;
        if ((port < 0 || own == (uint32_t)port) && number-- == 0) {
            *size = (int)length;
            *found = (int)own;
            return at;
        }
        at += length;
    }
    return NULL;
}

fwk_t *fwk_open(void)
{
    fwk_t *fwk = (fwk_t *)calloc(1, sizeof *fwk);
    const uint8_t *text;
    int size, kind;

    if (!fwk)
        fwk_fail("no memory left", "");
    fwk->in = dup(0);
    fwk->out = dup(1);
    if (fwk->in < 0 || fwk->out < 0 || isatty(0) || dup2(2, 1) < 0)
        fwk_fail("this program is started by fwk-launch; name it in a launch file: command: [./program]", "");
    fwk->room = 4096;
    fwk->answer = (uint8_t *)fwk_room(NULL, fwk->room);
    if (!fwk_receive(fwk) || fwk->kind != 0)
        fwk_fail("the first request is not one for fwk.h; add to the launch file: config: {coding: lcm}", "");
    for (int i = 0; (text = fwk_part(fwk, -1, i, &size, &kind)); i++) {
        char *copy = (char *)fwk_room(NULL, (size_t)size + 1);
        memcpy(copy, text, (size_t)size);
        copy[size] = '\0';
        if (kind == 'n') {
            fwk->name = copy;
        } else if (kind == 's') {
            fwk->settings = copy;
        } else {
            char ***names = kind == 'r' ? &fwk->reads : &fwk->writes;
            int *count = kind == 'r' ? &fwk->n_reads : &fwk->n_writes;
            *names = (char **)fwk_room(*names, sizeof(char *) * ((size_t)*count + 1));
            (*names)[(*count)++] = copy;
        }
    }
    return fwk;
}

static int fwk_port(char **names, int count, const char *port, const char *key)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(names[i], port))
            return i;
    fprintf(stderr, "fwk: the launch file names no port '%s' under '%s:'\n", port, key);
    exit(2);
}

int fwk_reads(fwk_t *fwk, const char *port)
{
    return fwk_port(fwk->reads, fwk->n_reads, port, "reads");
}

int fwk_writes(fwk_t *fwk, const char *port)
{
    return fwk_port(fwk->writes, fwk->n_writes, port, "writes");
}

const char *fwk_name(const fwk_t *fwk)
{
    return fwk->name;
}

const char *fwk_settings(const fwk_t *fwk)
{
    return fwk->settings;
}

int fwk_next(fwk_t *fwk)
{
    if (fwk->kind == 2)
        return 0;
    fwk_send(fwk);
    return fwk_receive(fwk);
}

int64_t fwk_tick(const fwk_t *fwk)
{
    return fwk->tick;
}

int64_t fwk_time_us(const fwk_t *fwk)
{
    return fwk->time_us;
}

int64_t fwk_period_us(const fwk_t *fwk)
{
    return fwk->period_us;
}

int fwk_is_final(const fwk_t *fwk)
{
    return fwk->kind == 2;
}

int fwk_count(const fwk_t *fwk, int port)
{
    int count = 0, size, found;

    while (fwk->kind != 0 && fwk_part(fwk, port, count, &size, &found))
        count++;
    return count;
}

const void *fwk_message(const fwk_t *fwk, int port, int number, int *size)
{
    int found;

    return fwk->kind == 0 ? NULL : fwk_part(fwk, port, number, size, &found);
}

int fwk_get_(const fwk_t *fwk, int port, int number, void *value, fwk_decode_t decode)
{
    int size = 0;
    const void *data = fwk_message(fwk, port, number, &size);

    return data && decode(data, 0, size, value) >= 0;
}

void *fwk_write(fwk_t *fwk, int port, int size)
{
    uint8_t *part;

    while (fwk->room - fwk->written < (size_t)size + FWK_PART)
        fwk->answer = (uint8_t *)fwk_room(fwk->answer, fwk->room *= 2);
    part = fwk->answer + fwk->written;
    fwk_put32(part, (uint32_t)port);
    fwk_put32(part + 4, (uint32_t)size);
    fwk->written += FWK_PART + (size_t)size;
    fwk->messages++;
    return part + FWK_PART;
}

int fwk_close(fwk_t *fwk)
{
    fwk_send(fwk);
    for (int i = 0; i < fwk->n_reads; i++)
        free(fwk->reads[i]);
    for (int i = 0; i < fwk->n_writes; i++)
        free(fwk->writes[i]);
    free(fwk->reads);
    free(fwk->writes);
    free(fwk->name);
    free(fwk->settings);
    free(fwk->request);
    free(fwk->answer);
    close(fwk->in);
    close(fwk->out);
    free(fwk);
    return 0;
}

#ifdef __cplusplus
}
#endif
#endif
