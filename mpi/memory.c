/* The memory limit.
 *
 * Links and patches grow; clusters are there from the beginning. Before a level is split,
 * the number of links after it is known within a factor: each link to be split becomes
 * four at most (of a cluster with itself, ten), and is there itself until the end of the
 * level; a patch can get four children only once. Whether there is room is decided from
 * counts over all ranks, so all decide alike, and a limit given by the user means the
 * same on any number of ranks: it is held against one copy of the patches and clusters,
 * though each rank has its own patches. The default limit promises no equal results, but
 * an end before the system's: it counts every copy, over all machines.
 *
 * Rejected: the memory really held by processes, which depends on the system and the
 * ranks; a limit for links alone, since half of the memory is in small patches. */
#include "mpi/memory.h"

#include "geom/alloc.h"
#include "geom/hash.h"

/* Bytes: a link with its share of the spare room in lists; a patch with all arrays beside
 * the forest (ranges, vectors of the solver, caps) and the same. */
enum { BYTES_PER_LINK = 36, BYTES_PER_PATCH = 560, BYTES_PER_CLUSTER = 290 };

/* Of a row of the final gather: three quarters of the patches are leaves; rays with an
 * end on the same leaf have one term of 20 bytes, and three more where B rises over the
 * leaf. This makes 1.6 terms for each patch and ray in the Cornell box, 2.6 to 3 in rooms
 * and corridors, and 4.9 where most leaves look through an opening. */
enum { BYTES_PER_RAY = 60 };

/* The part of the machines' memory for links, patches and clusters. */
static const double SHARE = 0.8;

/* The memory of a rank, as told to the others; no padding. */
struct machine {
    uint64_t name;       /* hash */
    int64_t bytes, room; /* of the machine, of the rank; 0: unknown, no limit */
};

/* Bytes of all machines, each counted once, or of all ranks, if each may take no more
 * than the rank with the least room; 0 if a machine is unknown. Of an address space a
 * half is for the unused room of grown lists. */
static int64_t machines_together(const struct comm *comm, int64_t bytes, int64_t room)
{
    char name[MPI_MAX_PROCESSOR_NAME] = "";
    int length = 0;
    MPI_Get_processor_name(name, &length);
    struct machine own = {hash_bytes(HASH_START, name, (size_t)length), bytes, room};
    struct machine *all = comm_gather_each(comm, &own, sizeof own);
    int64_t sum = 0, least = 0;
    bool known = true;
    for (int r = 0; r < comm->size; r++) {
        bool again = false;
        for (int before = 0; before < r && !again; before++)
            again = all[before].name == all[r].name;
        sum += again ? 0 : all[r].bytes;
        known = known && all[r].bytes > 0;
        if (all[r].room > 0 && (least == 0 || all[r].room < least))
            least = all[r].room;
    }
    alloc_free(all);
    least = (least + 1) / 2;
    bool narrow = least > 0 && (!known || least < sum / comm->size);
    return narrow ? least * comm->size : known ? sum : 0;
}

int64_t memory_needed(const struct memory *memory, int copies, int64_t links,
                      int64_t patches)
{
    return BYTES_PER_LINK * links + BYTES_PER_RAY * memory->rays * patches +
           copies * (BYTES_PER_PATCH * patches + BYTES_PER_CLUSTER * memory->clusters);
}

void memory_watch(struct memory *memory, const struct comm *comm, int64_t roots,
                  int64_t limit, int64_t machine, int64_t room)
{
    int64_t least = memory_needed(memory, 1, 0, roots) / 8 * 9;
    memory->limit = least > limit ? least : limit;
    memory->copies = 1;
    if (limit > 0)
        return;
    memory->limit = (int64_t)(SHARE * (double)machines_together(comm, machine, room));
    memory->copies = comm->size;
}

bool memory_has_room(const struct memory *memory, int64_t links, int64_t prolific,
                     int64_t patches)
{
    int64_t made = 4 * (prolific < patches ? prolific : patches);
    return memory->limit == 0 ||
           memory_needed(memory, memory->copies, links, patches + made) <= memory->limit;
}
