// A component in C: adds up the readings that it gets; its last message is the negative sum.

#define FWK_IMPLEMENTATION
#include "fwk.h"
#include "walk_step_t.h"

int main(void)
{
    fwk_t *fwk = fwk_open();
    int step = fwk_reads(fwk, "step"), sum = fwk_writes(fwk, "sum");
    walk_step_t total = {.header = {.writer = ""}};

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
        if (fwk_is_final(fwk))
            total.x = -total.x;
        FWK_PUT(fwk, walk_step_t, sum, &total);
    }
    return fwk_close(fwk);
}
