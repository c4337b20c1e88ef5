/* The rows of a rank, one after the other. */
#include "rad/beyond/gather/rows.h"

int64_t final_gather_terms(const struct final_gather *gather)
{
    return gather->count > 0 ? gather->rows[gather->count - 1].end : 0;
}

struct rgb final_gather_irradiance(const struct final_gather *gather, int64_t row,
                                   const struct rgb *radiosity, bool lamps)
{
    const struct gather_row *at = &gather->rows[row];
    struct rgb h = lamps ? at->source : (struct rgb){{0.0, 0.0, 0.0}};
    for (int64_t i = row > 0 ? at[-1].end : 0; i < at->end; i++)
        for (int c = 0; c < BANDS; c++)
            h.band[c] += (double)gather->terms[i].weight[c] *
                         radiosity[gather->terms[i].place].band[c];
    return h;
}
