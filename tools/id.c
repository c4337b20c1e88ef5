/* id NUMBER or id ROOT/PATH: takes the ID of a patch apart, bit by bit, as Fig. 1 of the
 * paper does. NUMBER is the hierarchy part, decimal or 0x..., or, with more than 32 bits,
 * root and hierarchy part as one number. */
#include <stdio.h>
#include <stdlib.h>

#include "tools/label.h"

static bool read_number(const char *text, struct patch_id *id)
{
    char *end;
    bool is_number = *text >= '0' && *text <= '9';
    unsigned long long number = strtoull(text, &end, 0);
    *id = (struct patch_id){(uint32_t)(number >> 32), (uint32_t)(number & UINT32_MAX)};
    return is_number && *end == '\0';
}

/* The bits from `first`, the highest being 31, down to before `last`. */
static void print_bits(uint32_t hierarchy, int first, int last)
{
    for (int bit = first; bit > last; bit--)
        putchar(hierarchy >> bit & 1u ? '1' : '0');
}

static void print_id(struct patch_id id)
{
    char name[LABEL_SIZE];
    int level = id_level(id), sentinel = 2 * level;
    printf("patch      %s\n", label_write(id, name));
    printf("number     0x%016llX\n", (unsigned long long)id_number(id));
    printf("root       %lu\n", (unsigned long)id.root);
    printf("hierarchy  0x%08lX\n", (unsigned long)id.hierarchy);
    printf("bits       ");
    print_bits(id.hierarchy, 31, sentinel);
    printf(" [1]"); /* the sentinel */
    for (int step = 0; step < level; step++) {
        putchar(' ');
        print_bits(id.hierarchy, sentinel - 1 - 2 * step, sentinel - 3 - 2 * step);
    }
    printf("\nlevel      %d\n", level);
    printf("path      ");
    for (int step = 0; step < level; step++)
        printf(" %d", id_step(id, step));
    printf(level ? "\n" : " (the root itself)\n");
    struct patch_id parent = {id.root, id.hierarchy >> 2};
    if (level)
        printf("parent     %s\n", label_write(parent, name));
    if (level < ID_MAX_LEVEL)
        printf("child 0    %s\n", label_write(id_child(id, 0), name));
}

int main(int argc, char **argv)
{
    struct patch_id id;
    if (argc != 2 || !(read_number(argv[1], &id) || label_read(argv[1], &id))) {
        fprintf(stderr,
                "usage: id NUMBER | ROOT/PATH   such as 0x1B, 27, 5/023, top/1\n");
        return 2;
    }
    if (!id_is_valid(id)) {
        fprintf(stderr, "id: %s is not the ID of a patch: its sentinel, the highest 1, "
                        "has to be in one of the bits 0, 2, 4, ..., 30\n", argv[1]);
        return 2;
    }
    print_id(id);
    return 0;
}
