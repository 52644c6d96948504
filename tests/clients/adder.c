// A component in C: adds up the readings that it gets; its last message is the negative sum. It offers its sum as a
// service, and asks another component for one.

#define FWK_IMPLEMENTATION
#include "fwk.h"
#include "core_answer_t.h"
#include "walk_ask_t.h"
#include "walk_step_t.h"
#include "walk_told_t.h"

int main(void)
{
    fwk_t *fwk = fwk_open();
    int step = fwk_reads(fwk, "step"), sum = fwk_writes(fwk, "sum");
    int asked = fwk_reads(fwk, "ask"), told = fwk_writes(fwk, "ask");
    int other = fwk_writes(fwk, "other"), answers = fwk_reads(fwk, "other");
    walk_step_t total = {.header = {.writer = ""}};
    walk_told_t reply = {.header = {.writer = ""}, .answer = {.sender = "", .reason = "negative"}};
    walk_ask_t own = {.header = {.writer = ""}};

    printf("%s, %s, %lld us\n", fwk_name(fwk), fwk_settings(fwk), (long long)fwk_period_us(fwk));
    fflush(stdout);
    while (fwk_next(fwk)) {
        for (int i = 0; i < fwk_count(fwk, step); i++) {
            walk_step_t seen;
            if (!FWK_GET(fwk, walk_step_t, step, i, &seen))
                return 1;
            total.x += seen.x;
            walk_step_t_decode_cleanup(&seen);
        }
        for (int i = 0; i < fwk_count(fwk, asked); i++) {
            walk_ask_t request;
            if (!FWK_GET(fwk, walk_ask_t, asked, i, &request))
                return 1;
            reply.x = total.x + request.x;
            FWK_ANSWER(fwk, walk_told_t, told, &request, &reply,
                       request.x < 0 ? CORE_ANSWER_T_REJECTED : CORE_ANSWER_T_DONE);
            walk_ask_t_decode_cleanup(&request);
        }
        for (int i = 0; i < fwk_count(fwk, answers); i++) {
            walk_told_t answer;
            if (!FWK_GET(fwk, walk_told_t, answers, i, &answer))
                return 1;
            printf("call %lld: state %d, %g, %s\n", (long long)answer.answer.sequence, answer.answer.state, answer.x,
                   answer.answer.reason);
            fflush(stdout);
            walk_told_t_decode_cleanup(&answer);
        }
        if (!fwk_is_final(fwk) && fwk_tick(fwk) % 5 == 0) {
            own.x = 10 - (double)fwk_tick(fwk);
            FWK_PUT(fwk, walk_ask_t, other, &own);
        }
        if (fwk_is_final(fwk))
            total.x = -total.x;
        FWK_PUT(fwk, walk_step_t, sum, &total);
    }
    return fwk_close(fwk);
}
