/* The paper's way of dealing links.
 *
 * "Sender processors distribute their interactions in a round-robin fashion to the
 * receiver processors": in turn to the rank itself and to the receivers of its transfers,
 * for neighbours in the list tend to be predicted wrong alike. A receiver gets a link as
 * long as at least half of its cost still fits into the planned load; the others stay. */
#include "mpi/balance.h"

#include "geom/alloc.h"
#include "mpi/plan.h"

/* The transfers of a rank; the first is the load kept. Returns their number. */
static int own_transfers(const struct loads *loads, struct transfer *own)
{
    struct transfer *plan = alloc_array(2 * (size_t)loads->ranks, sizeof *plan);
    int planned = plan_transfers(loads->of, loads->ranks, plan), count = 1;
    own[0] = (struct transfer){loads->rank, loads->rank, loads->of[loads->rank]};
    for (int t = 0; t < planned; t++) {
        if (plan[t].from != loads->rank)
            continue;
        own[count++] = plan[t];
        own[0].load -= plan[t].load;
    }
    alloc_free(plan);
    return count;
}

void deal_greedily(struct loads loads, const int64_t *costs, int64_t count,
                   int *destination)
{
    struct transfer *own = alloc_array(2 * (size_t)loads.ranks + 1, sizeof *own);
    int receivers = own_transfers(&loads, own), turn = 0;
    for (int64_t i = 0; i < count; i++) {
        destination[i] = loads.rank;
        for (int tried = 0; tried < receivers; tried++) {
            struct transfer *to = &own[(turn + tried) % receivers];
            if (2 * to->load < costs[i])
                continue;
            destination[i] = to->to;
            to->load -= costs[i];
            turn = (turn + tried + 1) % receivers;
            break;
        }
    }
    alloc_free(own);
}
