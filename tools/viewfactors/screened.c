/* Past few blockers.
 *
 * With F(x) the form factor from a point x of one triangle, the viewer, to the other, the
 * target, and S(x) the form factor to the part of the target visible from x past the
 * screens, known exactly (outlook.h),
 *
 *     G = integral over the viewer of S(x) dA
 *       = G without screens  -  integral over the viewer of (F - S)(x) dA.
 *
 * Whichever is smaller is integrated, by three points, exact to the second degree, and
 * again by three in each quarter; where the two differ by more than the tolerance, each
 * quarter is treated alike. The difference is the error of the coarser sum: the error of
 * the finer one, which is kept, is a part of the difference, so the sum of the
 * differences is an upper limit. S is continuous but for common edges, with kinks along
 * the lines where the edge of a shadow passes an edge of the target, so only parts on
 * these lines are divided deeply.
 *
 * A screen close to the viewer casts its shadow on a small part of the viewer, which
 * points may miss: such a part is divided until its light is worth no more than the
 * tolerance. If all points see nothing, or all of the target, nothing is proved; the
 * caller is told.
 *
 * Rejected: points on both triangles (16 segments, as for light), where a shadow's edge
 * costs digits twice; random points, with a well-known error, but a hundred times as
 * many; the larger triangle as the viewer, whose points are far apart for the distance of
 * the target; the views from both triangles, held against each other: where the two
 * differed, mostly the larger triangle's was wrong. */
#include "tools/viewfactors/screened.h"

#include <math.h>

#include "geom/lambert.h"
#include "tools/viewfactors/outlook.h"
#include "geom/stop.h"

enum { DEEPEST = 7 }; /* quarterings of the viewer at most */

/* The part of the light of a part of the viewer that its points may miss. */
static const double MISSED = 0.03;

/* The part of the error of the integral of S counted for F - S, and the other way
 * round. */
static const double OTHER = 0.25;

/* Numbers different by rounding count as equal, lest a rotated scene gets other parts. */
static const double ROUNDED = 1.0 + 1e-6;

/* The part of a blocker in front of both planes. */
struct screen {
    struct vec3 corner[5]; /* [count] */
    int count;
    struct vec3 centre;    /* of the whole blocker */
    double radius, area;   /* of the whole blocker */
};

struct view {
    const struct facet *viewer, *target;
    const struct screen *screens; /* [count] */
    int count;
    bool full;                    /* some target fell into too many parts */
};

/* Integrals over a part of the viewer. */
struct light {
    double seen, hidden; /* of S, of F - S */
};

/* --- screens --- */

/* Keeps the part of a screen in front of the plane; corners within rounding are on it. No
 * corners are left if nothing is in front. */
static void cut_at(struct screen *screen, const struct plane *plane)
{
    struct screen old = *screen;
    double height[5];
    bool any = false;
    for (int k = 0; k < old.count; k++) {
        double h = plane_distance(plane, old.corner[k]);
        height[k] = fabs(h) > GEOM_ROUNDING ? h : 0.0;
        any = any || height[k] > 0.0;
    }
    screen->count = 0;
    for (int k = 0; k < old.count && any; k++) {
        int next = (k + 1) % old.count;
        struct vec3 along = vec3_sub(old.corner[next], old.corner[k]);
        if (height[k] >= 0.0)
            screen->corner[screen->count++] = old.corner[k];
        if (height[k] * height[next] < 0.0)
            screen->corner[screen->count++] =
                vec3_add(old.corner[k],
                         vec3_scale(along, height[k] / (height[k] - height[next])));
    }
}

static struct screen screen_make(const struct triangle *t, const struct facet *viewer,
                                 const struct facet *target)
{
    struct screen screen = {.count = 3, .area = triangle_area(t),
                            .centre = triangle_centroid(t),
                            .radius = triangle_radius(t)};
    for (int k = 0; k < 3; k++)
        screen.corner[k] = t->corner[k];
    cut_at(&screen, &viewer->plane);
    cut_at(&screen, &target->plane);
    return screen;
}

/* --- points --- */

/* True if a screen is outside of one of the planes through x and an edge of the
 * target. */
static bool is_beside(const struct screen *screen, struct vec3 x,
                      const struct vec3 side[3])
{
    for (int k = 0; k < 3; k++) {
        bool outside = true;
        for (int i = 0; i < screen->count && outside; i++)
            outside = vec3_dot(side[k], vec3_sub(screen->corner[i], x)) >= 0.0;
        if (outside)
            return true;
    }
    return false;
}

/* Returns what the point x of the viewer sees: form factors. */
static struct light look(struct view *view, struct vec3 x)
{
    struct vec3 normal = view->viewer->plane.normal;
    double open = point_triangle_factor(x, normal, &view->target->triangle), seen = 0.0;
    struct outlook outlook;
    struct vec3 side[3]; /* outwards */
    if (!(open > 0.0))
        return (struct light){0.0, 0.0};
    outlook_start(&outlook, x, &view->target->triangle);
    for (int k = 0; k < 3; k++)
        side[k] = vec3_cross(vec3_sub(view->target->triangle.corner[k], x),
                             vec3_sub(view->target->triangle.corner[(k + 1) % 3], x));
    for (int i = 0; i < view->count && outlook.count > 0; i++) {
        if (is_beside(&view->screens[i], x, side))
            continue;
        const struct vec3 *c = view->screens[i].corner;
        for (int k = 1; k + 1 < view->screens[i].count; k++) {
            struct triangle part = {{c[0], c[k], c[k + 1]}};
            view->full = !outlook_hide(&outlook, &part) || view->full;
        }
    }
    for (int i = 0; i < outlook.count; i++)
        seen += point_polygon_factor(x, normal, outlook.piece[i].corner,
                                     outlook.piece[i].count);
    seen = fmin(seen, open);
    return (struct light){seen, open - seen};
}

/* Returns the integrals over a part of the viewer by three points. */
static struct light integrate(struct view *view, const struct triangle *part)
{
    struct vec3 x[3];
    struct light sum = {0.0, 0.0};
    double weight = triangle_area(part) / 3.0;
    triangle_three_points(part, x);
    for (int k = 0; k < 3; k++) {
        struct light light = look(view, x[k]);
        sum.seen += weight * light.seen;
        sum.hidden += weight * light.hidden;
    }
    return sum;
}

/* --- parts --- */

/* The integral taken, of S or of F - S. */
struct way {
    struct view *view;
    bool by_hidden; /* F - S is integrated */
    double tolerance;
    double sum, error;
};

/* A part of the viewer. */
struct zone {
    struct triangle triangle;
    struct light light; /* by three points */
    int level; /* quarterings from the whole viewer */
};

/* The parts of a part of the viewer, and their sum. */
struct quarters {
    struct zone part[4];
    struct light sum;
};

static struct quarters quarters_of(struct view *view, const struct zone *part)
{
    struct quarters quarters = {.sum = {0.0, 0.0}};
    for (int k = 0; k < 4; k++) {
        struct zone *child = &quarters.part[k];
        child->triangle = triangle_child(&part->triangle, k);
        child->light = integrate(view, &child->triangle);
        child->level = part->level + 1;
        quarters.sum.seen += child->light.seen;
        quarters.sum.hidden += child->light.hidden;
    }
    return quarters;
}

static double light_of(const struct way *way, struct light light)
{
    return way->by_hidden ? light.hidden : light.seen;
}

/* Returns the limit of the error of a part. The integral not taken has a say, as now and
 * then two sums agree by chance. */
static double error_of(const struct way *way, struct light coarse, struct light fine)
{
    double seen = fabs(fine.seen - coarse.seen),
           hidden = fabs(fine.hidden - coarse.hidden);
    return way->by_hidden ? fmax(hidden, OTHER * seen) : fmax(seen, OTHER * hidden);
}

/* True if a screen is so near to a part of the viewer that its points may miss a shadow
 * worth the tolerance. */
static bool is_near_screen(const struct way *way, const struct zone *part)
{
    const struct view *view = way->view;
    struct vec3 centre = triangle_centroid(&part->triangle);
    double radius = triangle_radius(&part->triangle);
    double area = triangle_area(&part->triangle);
    double worth = MISSED * (part->light.seen + part->light.hidden) / way->tolerance;
    for (int i = 0; i < view->count && worth > 1.0; i++) {
        const struct screen *screen = &view->screens[i];
        double apart = vec3_length(vec3_sub(screen->centre, centre)) - screen->radius;
        if (apart < ROUNDED * radius && worth * screen->area > area)
            return true;
    }
    return false;
}

/* Adds a part of the viewer, by its quarters. */
static void add_part(struct way *way, const struct zone *part,
                     const struct quarters *quarters)
{
    double sum = light_of(way, quarters->sum);
    double error = error_of(way, part->light, quarters->sum);
    if (part->level == DEEPEST || way->view->full || stop_is_asked() ||
        (error <= way->tolerance && !is_near_screen(way, part))) {
        way->sum += sum;
        way->error += error;
        return;
    }
    for (int k = 0; k < 4; k++) {
        struct quarters next = quarters_of(way->view, &quarters->part[k]);
        add_part(way, &quarters->part[k], &next);
    }
}

bool screened_exchange(const struct facet *viewer, const struct facet *target,
                       const struct triangle *triangles, const int32_t *blockers,
                       int32_t count, double open, double tolerance,
                       struct screened *result)
{
    struct screen screens[SCREENS_MAX];
    struct view view = {viewer, target, screens, 0, false};
    for (int32_t i = 0; i < count; i++) {
        screens[view.count] = screen_make(&triangles[blockers[i]], viewer, target);
        view.count += screens[view.count].count >= 3;
    }
    struct zone whole = {viewer->triangle, integrate(&view, &viewer->triangle), 0};
    struct quarters quarters = quarters_of(&view, &whole);
    struct way way = {.view = &view, .tolerance = tolerance};
    way.by_hidden = quarters.sum.hidden < ROUNDED * quarters.sum.seen;
    add_part(&way, &whole, &quarters);
    double exchange = way.by_hidden ? open - way.sum : way.sum;
    result->exchange = fmax(0.0, fmin(open, exchange));
    result->error = way.error;
    result->agreed = quarters.sum.seen + whole.light.seen == 0.0 ||
                     quarters.sum.hidden + whole.light.hidden <= 1e-14 * open;
    return !view.full;
}
