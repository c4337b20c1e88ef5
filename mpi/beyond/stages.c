/* Dealing in stages, by counts: factoring (Hummel, Schonberg and Flynn, 1992).
 *
 * Some rows take seven times the work predicted for them, so ranks with the same
 * predicted work differ by some percent. In a stage all items left are dealt. A rank
 * stops after nine tenths of the mean work expected, whatever was predicted for its own
 * items. The rest, few and light, is dealt anew. A stage takes one exchange.
 *
 * Items are done by octaves of predicted work: a heavy one at the end keeps all ranks
 * waiting. Within an octave items keep their order, for leaves of a root share proofs. */
#include "mpi/beyond/stages.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/assign.h"

/* The part of the mean work expected after which a rank stops. */
static const double PART = 0.9;

/* A stage dealing no more than this number of items for each rank is the last one. */
enum { LAST = 32 };

/* Neighbours dealt to a rank together, at most: they share proofs and cuts. */
enum { TOGETHER = 8 };

/* Items and tests of a rank in a stage; no padding. */
struct stint {
    int64_t items, tests;
};

static void list_items(struct stages *s)
{
    int64_t most = 1; /* of the octave of the heaviest */
    for (int64_t i = 0; i < s->count; i++)
        while (s->work[i] >= 2 * most)
            most *= 2;
    for (int64_t least = most; s->left < s->count; least /= 2)
        for (int64_t i = 0; i < s->count; i++)
            if (s->work[i] >= least && s->work[i] < 2 * least)
                s->items[s->left++] = (int32_t)i;
}

/* Deals the items left, some neighbours together. Returns the number of tests after which
 * a rank stops. */
static double deal(struct stages *s)
{
    int ranks = s->solver->comm->size;
    int64_t each = s->left / (LAST * ranks);
    each = each < 1 ? 1 : each > TOGETHER ? TOGETHER : each;
    int64_t count = (s->left + each - 1) / each;
    int *rank_of = alloc_array((size_t)count, sizeof *rank_of);
    int64_t *work = alloc_array((size_t)count, sizeof *work), sum = 0;
    for (int64_t k = 0; k < s->left; k++) {
        work[k / each] += s->work[s->items[k]];
        sum += s->work[s->items[k]];
    }
    s->all = s->left == s->count ? (double)sum : s->all;
    items_deal(work, (int32_t)count, ranks, rank_of);
    for (int64_t k = 0; k < s->left; k++)
        s->rank_of[s->items[k]] = rank_of[k / each];
    alloc_free(work);
    alloc_free(rank_of);
    return s->left > LAST * ranks ? PART * s->ratio * (double)sum / ranks : HUGE_VAL;
}

/* Progress is in predicted work, of which others do about as much as this rank. */
static struct stint do_items(struct stages *s, double most)
{
    struct stint own = {0, 0};
    int64_t before = final_gather_work(s->gather);
    for (int64_t k = 0; k < s->left && (double)own.tests <= most; k++) {
        if (s->rank_of[s->items[k]] != s->solver->comm->rank)
            continue;
        if (!stop_is_asked())
            s->act(s->context, s->items[k]);
        own.items++;
        own.tests = final_gather_work(s->gather) - before;
        s->done += (double)s->work[s->items[k]] * s->solver->comm->size;
        progress_tick(s->solver->progress, s->done / s->all);
    }
    account_work(&s->solver->account, WORK_FINAL_GATHER, own.tests, 0);
    return own;
}

/* Collective. All ranks learn which items are done. */
static void share_stints(struct stages *s, struct stint own)
{
    struct stint *each = comm_gather_each(s->solver->comm, &own, sizeof own);
    int64_t left = 0, tests = 0, predicted = 0;
    for (int r = 0; r < s->solver->comm->size; r++)
        tests += each[r].tests;
    for (int64_t k = 0; k < s->left; k++) {
        int32_t item = s->items[k];
        int rank = s->rank_of[item];
        if (each[rank].items-- <= 0) {
            s->items[left++] = item;
            continue;
        }
        predicted += s->work[item];
        s->place[item] = s->counts[rank]++;
    }
    s->left = left;
    s->ratio = (double)tests / (double)predicted;
    alloc_free(each);
}

void stages_run(struct stages *s)
{
    size_t ranks = (size_t)s->solver->comm->size, count = (size_t)s->count;
    s->counts = alloc_array(ranks, sizeof *s->counts);
    s->at = alloc_array(ranks, sizeof *s->at);
    s->place = alloc_array(count, sizeof *s->place);
    s->rank_of = alloc_array(count, sizeof *s->rank_of);
    s->items = alloc_array(count, sizeof *s->items);
    s->ratio = 1.0;
    list_items(s);
    while (s->left > 0) {
        double most = deal(s);
        share_stints(s, do_items(s, most));
    }
    comm_displacements(s->solver->comm, s->counts, s->at);
    for (int64_t i = 0; i < s->count; i++)
        s->place[i] += s->at[s->rank_of[i]];
}

void stages_free(struct stages *stages)
{
    alloc_free(stages->counts);
    alloc_free(stages->at);
    alloc_free(stages->place);
    alloc_free(stages->rank_of);
    alloc_free(stages->items);
    *stages = (struct stages){.solver = NULL};
}
