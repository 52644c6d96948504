// Counts up by a step in each iteration.

#define FWK_IMPLEMENTATION
#include "fwk.h"
#include "thing_thing_t.h"

static const double STEP = 1.0;

int main(void)
{
    fwk_t *fwk = fwk_open();
    int thing = fwk_writes(fwk, "thing");
    thing_thing_t count = {.header = {.writer = ""}};

    while (fwk_next(fwk) && !fwk_is_final(fwk)) {
        count.value += STEP;
        FWK_PUT(fwk, thing_thing_t, thing, &count);
    }
    return fwk_close(fwk);
}
