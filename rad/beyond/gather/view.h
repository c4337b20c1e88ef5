/* The view from a root: the roots that it faces, and whether nothing is in the way. */
#ifndef RAD_BEYOND_GATHER_VIEW_H
#define RAD_BEYOND_GATHER_VIEW_H

#include "rad/beyond/node.h"

/* A root and the roots that it faces. */
struct gather_view {
    const struct model *model; /* borrowed */
    int64_t most;      /* roots faced by an open root, at most; below 0: none is open */
    int32_t root;      /* -1: none yet */
    bool open;         /* proved: nothing stands between the root and any of `faced` */
    int32_t *faced;    /* [count], roots */
    int64_t count, capacity;
    uint8_t *overlapped; /* [roots] 2: by another root in the plane; 1: by none; 0:
                            unknown */
    struct octree_counts counts; /* of all proofs, made by each rank with a leaf of the
                                    root */
};

/* Borrows the model, which has clusters. */
struct gather_view *view_create(const struct model *model, int64_t most);
void view_destroy(struct gather_view *view);

/* True if proofs show that nothing stands between a root and the roots that it faces:
 * then its leaves may have exact rows. Without `proof`: if no segment finds a blocker. */
bool view_is_open(struct gather_view *view, int32_t root, bool proof);

#endif
