/* Reading Wavefront OBJ scenes with their MTL materials.
 *
 * Understood: v (three coordinates; three numbers behind them are a colour, one is a
 * weight and skipped), vn (for smooth shading), f (v, v/vt, v//vn, v/vt/vn, negative
 * indices, polygons), usemtl, mtllib, o, g. An o or g line puts the faces up to the next
 * such line into the group named by the rest of the line; faces before any such line, or
 * behind one without a name, are in the group "default". Groups are numbered by their
 * first faces. A face whose corners all have colours has their mean in place of Kd, as a
 * linear reflectance (io/scene/ply.h). Texture coordinates (vt)
 * say which part of a picture counts. Points, lines and settings of programs are
 * skipped. Other keywords, such as those of free-form surfaces, are skipped
 * and counted. Lines may end in LF or CRLF and go on after a backslash. */
#ifndef IO_SCENE_OBJ_H
#define IO_SCENE_OBJ_H

#include <stdint.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/scene/maps.h"
#include "io/scene/text.h"

/* Counts of repairs, for one warning per kind. Starts as {0}, or with the first three. */
struct obj_repairs {
    struct text_names *files;      /* where paths of libraries and pictures go, or NULL */
    struct text_names *names;      /* where names of the scene's materials go, in order,
                                      while these have one; or NULL */
    map_mean *mean_of;             /* finds the colours of a picture; NULL: of none */
    char exporter[80];             /* the first line, if it is a comment; or "" */
    struct text_missing materials; /* names without a definition: neutral grey instead */
    struct text_missing libraries; /* mtllib files that could not be opened */
    int64_t bad_normals;           /* corners whose vn is absent or 0: without a normal */
    int64_t panes;                 /* used materials that let light through */
    int64_t glowing;               /* of these, those with Ke, which is passed over */
    bool all_panes;                /* no face has another material: all are opaque */
    int64_t nameless;              /* newmtl lines without a name, as of usemtl */
    int64_t textured;              /* used materials with pictures: of one colour */
    struct text_missing textures;  /* pictures of these whose mean is not found */
    int64_t passed_count;          /* keywords of materials passed over */
    char passed[200];              /* these keywords */
    int64_t unread;                /* used materials with Kd or Ke as spectral or xyz */
    int64_t unknown_lines;         /* with unknown keywords, or numbers: skipped */
    long first_unknown;            /* number of the first such line */
};

/* Reads an open file, which stays open, and the material libraries of its mtllib lines
 * (relative to its path). Returns a scene before scene_prepare() (positions in input
 * units), or NULL with `error` set to "FILE:LINE: REASON" (EXIT_USAGE).
 * Errors: a file that cannot be read or has no faces (or seems to be of another format);
 * malformed numbers, NaN and infinities, indices out of range, faces with fewer than
 * three corners, negative reflectance or emission. */
struct scene *obj_of_source(struct source *source, struct obj_repairs *repairs,
                            struct error *error);

#endif
