/* Push and pull over one quadtree: chapter 7 of the course.
 *
 * The root is a patch of 1 m^2 with rho = 0.5 that emits nothing. Three links have
 * brought flux: 2 W to the root, 1 W to its child 3, 0.1 W to child 2 of that. Printed
 * is each patch, its flux, and after push-pull its irradiance H (of leaves) and
 * radiosity B. */
#include <stdio.h>

enum { PATCHES = 9 };

struct patch {
    const char *path;  /* from the root */
    int children;      /* number of child 0, the others follow; 0: a leaf */
    double area, flux; /* m^2, W */
    double radiosity;  /* W/m^2 */
};

static const double RHO = 0.5;

static struct patch tree[PATCHES] = {
    {"", 1, 1.0, 2.0, 0.0},
    {"0", 0, 0.25, 0.0, 0.0},
    {"1", 0, 0.25, 0.0, 0.0},
    {"2", 0, 0.25, 0.0, 0.0},
    {"3", 5, 0.25, 1.0, 0.0},
    {"30", 0, 0.0625, 0.0, 0.0},
    {"31", 0, 0.0625, 0.0, 0.0},
    {"32", 0, 0.0625, 0.1, 0.0},
    {"33", 0, 0.0625, 0.0, 0.0},
};

/* Irradiance goes down, `above` being that of all patches above; radiosity comes up. */
static double push_pull(struct patch *patch, double above)
{
    double irradiance = above + patch->flux / patch->area;
    if (patch->children == 0)
        return patch->radiosity = RHO * irradiance;
    double sum = 0.0;
    for (int k = 0; k < 4; k++)
        sum += push_pull(&tree[patch->children + k], irradiance);
    return patch->radiosity = sum / 4.0; /* children have equal areas */
}

int main(void)
{
    push_pull(&tree[0], 0.0);
    printf("%-6s %8s %8s %8s\n", "patch", "flux", "H", "B");
    for (int p = 0; p < PATCHES; p++) {
        const struct patch *patch = &tree[p];
        printf("0/%-4s %8.3f", patch->path, patch->flux);
        if (patch->children == 0)
            printf(" %8.3f", patch->radiosity / RHO);
        else
            printf(" %8s", "-");
        printf(" %8.3f\n", patch->radiosity);
    }
    return 0;
}
