/* Radiosity in one file: chapter 3 of the course.
 *
 *     radiosity SCENE.obj SIZE [PATCHES]
 *
 * Faces are cut into triangles of edges no longer than SIZE, the patches. On each the
 * radiosity B is taken to be constant: one equation for each patch i,
 *
 *     B_i = E_i + rho_i (F_i1 B_1 + F_i2 B_2 + ... + F_in B_n).
 *
 * F_ij, the form factor, is the part of the view from patch i that patch j fills. It is
 * taken at the middle of i: Lambert's formula for the whole of j, times the share of four
 * segments from there to j that no face blocks. All n x n factors are kept, and the
 * equations are evaluated again and again, as Jacobi does, until B no longer changes.
 *
 * Printed are the means of the objects; the file PATCHES receives all patches. Of OBJ it
 * knows v, f (3 or 4 corners), o, mtllib, usemtl, of MTL newmtl, and grey Kd and Ke. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- vectors and triangles --- */

struct vec {
    double x, y, z;
};

struct triangle {
    struct vec a, b, c; /* m; counter-clockwise as seen from the front */
};

/* a + s b */
static struct vec add(struct vec a, double s, struct vec b)
{
    return (struct vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static struct vec from_to(struct vec a, struct vec b)
{
    return add(b, -1.0, a);
}

static double dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct vec cross(struct vec a, struct vec b)
{
    return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                        a.x * b.y - a.y * b.x};
}

static double length(struct vec a)
{
    return sqrt(dot(a, a));
}

static struct vec middle(struct triangle t)
{
    return add(add(t.a, 1.0 / 3.0, from_to(t.a, t.b)), 1.0 / 3.0, from_to(t.a, t.c));
}

/* Four triangles of half the size: three at the corners, one between them. */
static void quarter(struct triangle t, struct triangle parts[4])
{
    struct vec ab = add(t.a, 0.5, from_to(t.a, t.b));
    struct vec bc = add(t.b, 0.5, from_to(t.b, t.c));
    struct vec ca = add(t.c, 0.5, from_to(t.c, t.a));
    parts[0] = (struct triangle){t.a, ab, ca};
    parts[1] = (struct triangle){ab, t.b, bc};
    parts[2] = (struct triangle){ca, bc, t.c};
    parts[3] = (struct triangle){bc, ca, ab};
}

/* --- the scene --- */

enum { MOST = 1024 }; /* of each kind of thing */

struct named {
    char name[64];
    double rho, emission; /* 1, W/m^2; of a material */
};

struct face {
    struct triangle triangle;
    const struct named *material, *object;
};

static struct vec vertices[MOST];
static struct named materials[MOST], objects[MOST];
static struct face faces[MOST];
static int vertex_count, material_count, object_count, face_count;

static void fail(const char *text)
{
    fprintf(stderr, "radiosity: %s\n", text);
    exit(2);
}

/* The place of one thing more. */
static int next(int *count)
{
    if (*count == MOST - 1)
        fail("the scene is too large");
    return (*count)++;
}

static struct vec vertex(int number)
{
    if (number < 1 || number > vertex_count)
        fail("a face has a vertex that is not there");
    return vertices[number - 1];
}

/* Reads a scene or, as no word means two things, its library. */
static void read_file(const char *path)
{
    FILE *file = fopen(path, "r");
    char line[512], name[64], library[512];
    const char *slash = strrchr(path, '/'); /* the library lies beside the scene */
    int folder = slash ? (int)(slash - path) + 1 : 0, c[4];
    struct named *material = materials;
    struct vec v;
    if (!file)
        fail("a file cannot be opened");
    while (fgets(line, sizeof line, file)) {
        if (sscanf(line, "newmtl %63s", name) == 1)
            strcpy((material = &materials[next(&material_count)])->name, name);
        sscanf(line, "Kd %lf", &material->rho);
        sscanf(line, "Ke %lf", &material->emission);
        if (sscanf(line, "o %63s", name) == 1)
            strcpy(objects[next(&object_count)].name, name);
        if (sscanf(line, "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3)
            vertices[next(&vertex_count)] = v;
        if (sscanf(line, "usemtl %63s", name) == 1)
            for (material = materials; strcmp(material->name, name) != 0; material++)
                if (material == &materials[material_count])
                    fail("a material is missing");
        int corners = sscanf(line, "f %d %d %d %d", &c[0], &c[1], &c[2], &c[3]);
        for (int k = 2; k < corners && object_count > 0; k++)
            faces[next(&face_count)] = (struct face){
                {vertex(c[0]), vertex(c[k - 1]), vertex(c[k])}, material,
                &objects[object_count - 1]};
        if (sscanf(line, "mtllib %63s", name) == 1) {
            snprintf(library, sizeof library, "%.*s%s", folder, path, name);
            read_file(library);
        }
    }
    fclose(file);
}

/* --- patches --- */

struct patch {
    struct triangle triangle;
    struct vec middle, normal; /* the length of the normal is twice the area */
    double radiosity, next;    /* W/m^2: B, and that of the next iteration */
    const struct face *face;
};

static struct patch *patches;
static size_t patch_count;

/* Cuts a triangle until no edge is longer than `size`. */
static void add_patches(struct triangle t, const struct face *face, double size)
{
    struct vec ab = from_to(t.a, t.b), bc = from_to(t.b, t.c), ca = from_to(t.c, t.a);
    if (fmax(length(ab), fmax(length(bc), length(ca))) > size) {
        struct triangle parts[4];
        quarter(t, parts);
        for (int k = 0; k < 4; k++)
            add_patches(parts[k], face, size);
        return;
    }
    patches = realloc(patches, (patch_count + 1) * sizeof *patches);
    if (!patches)
        fail("no memory");
    patches[patch_count++] = (struct patch){t, middle(t), cross(ab, bc), 0.0, 0.0, face};
}

/* --- form factors --- */

/* True if the triangle stands between x and y (Moeller and Trumbore, 1997). */
static int blocks(struct triangle t, struct vec x, struct vec y)
{
    struct vec d = from_to(x, y), e = from_to(t.a, t.b), g = from_to(t.a, t.c);
    struct vec p = cross(d, g), s = from_to(t.a, x), q = cross(s, e);
    double det = dot(e, p);
    double u = dot(s, p) / det, v = dot(d, q) / det, at = dot(g, q) / det;
    return det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0 && at < 1.0;
}

/* Share of the segments from the middle of one patch to the quarters of another that is
 * free. Brute force: each is held against all faces. */
static double visibility(const struct patch *from, const struct patch *to)
{
    struct triangle parts[4];
    int free_count = 0;
    quarter(to->triangle, parts);
    for (int k = 0; k < 4; k++) {
        const struct face *face = faces, *end = faces + face_count;
        while (face < end && (face == from->face || face == to->face ||
                              !blocks(face->triangle, from->middle, middle(parts[k]))))
            face++;
        free_count += face == end;
    }
    return 0.25 * free_count;
}

/* Lambert's formula (1760): each edge of the polygon that is seen, as an arc around the
 * receiver, adds its angle times the cosine between the receiver's normal and the arc's.
 * Of a patch that sinks below the receiver's horizon, the part above it counts. */
static double form_factor(const struct patch *to, const struct patch *from)
{
    struct triangle t = from->triangle;
    struct vec x = to->middle, p[3] = {from_to(x, t.a), from_to(x, t.b), from_to(x, t.c)};
    struct vec corner[4];
    double sum = 0.0, two_pi = 6.283185307179586;
    int corners = 0;
    if (to->face == from->face || dot(from->normal, p[0]) >= 0.0)
        return 0.0; /* it shows its edge or its back */
    for (int k = 0; k < 3; k++) {
        struct vec this = p[k], then = p[(k + 1) % 3];
        double height = dot(this, to->normal), later = dot(then, to->normal);
        if (height >= 0.0)
            corner[corners++] = this;
        if ((height < 0.0) != (later < 0.0))
            corner[corners++] = add(this, height / (height - later), from_to(this, then));
    }
    for (int k = 0; k < corners; k++) {
        struct vec r = corner[(k + 1) % corners], s = corner[k], arc = cross(r, s);
        if (length(arc) > 0.0)
            sum += atan2(length(arc), dot(r, s)) * dot(arc, to->normal) / length(arc);
    }
    sum /= two_pi * length(to->normal);
    return sum > 0.0 ? sum * visibility(to, from) : 0.0;
}

/* --- the solution --- */

/* One step of Jacobi's: new radiosities from the old ones. Returns the largest change. */
static double bounce(const double *factors)
{
    double change = 0.0;
    for (size_t i = 0; i < patch_count; i++) {
        const struct named *material = patches[i].face->material;
        double irradiance = 0.0;
        for (size_t j = 0; j < patch_count; j++)
            irradiance += factors[i * patch_count + j] * patches[j].radiosity;
        patches[i].next = material->emission + material->rho * irradiance;
        change = fmax(change, fabs(patches[i].next - patches[i].radiosity));
    }
    for (size_t i = 0; i < patch_count; i++)
        patches[i].radiosity = patches[i].next;
    return change;
}

/* Prints the means of the objects; to the file go face, B and corners of the patches. */
static void print_light(FILE *file)
{
    for (int o = 0; o < object_count; o++) {
        double weight = 0.0, power = 0.0;
        for (size_t i = 0; i < patch_count; i++) {
            int is_own = patches[i].face->object == &objects[o];
            double own = is_own ? length(patches[i].normal) : 0.0;
            weight += own;
            power += own * patches[i].radiosity;
        }
        printf("%-10s %8.3f\n", objects[o].name, power / weight);
    }
    for (size_t i = 0; file && i < patch_count; i++) {
        struct triangle t = patches[i].triangle;
        fprintf(file, "%d %.4f  %.4f %.4f %.4f  %.4f %.4f %.4f  %.4f %.4f %.4f\n",
                (int)(patches[i].face - faces), patches[i].radiosity, t.a.x, t.a.y, t.a.z,
                t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z);
    }
}

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 4 || atof(argv[2]) <= 0.0)
        fail("usage: radiosity SCENE.obj SIZE [PATCHES]");
    read_file(argv[1]);
    for (int f = 0; f < face_count; f++)
        add_patches(faces[f].triangle, &faces[f], atof(argv[2]));
    double *factors = malloc(patch_count * patch_count * sizeof *factors);
    FILE *file = argc == 4 ? fopen(argv[3], "w") : NULL;
    if (!factors || (argc == 4 && !file))
        fail("no memory, or no room for PATCHES");
    for (size_t i = 0; i < patch_count * patch_count; i++)
        factors[i] = form_factor(&patches[i / patch_count], &patches[i % patch_count]);
    int iterations = 1;
    while (bounce(factors) > 1e-6)
        iterations++;
    printf("%d patches, %d iterations\n", (int)patch_count, iterations);
    print_light(file);
    return file && fclose(file) != 0;
}
