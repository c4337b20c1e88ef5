/* Pictures in files. Writers go by the format asked for, readers by the first bytes, so
 * that a picture may have any name. */
#include "io/picture/imagefile.h"

#include "geom/alloc.h"
#include "io/picture/hdr.h"
#include "io/picture/png.h"
#include "io/picture/pnm.h"

static const char MAGIC[] = "P #? \x89PNG", KIND[] = "a picture (PFM, PPM, HDR or PNG)";

bool image_write(const struct image *image, const struct tone *tone,
                 const struct target *target, struct error *error)
{
    switch (target->format) {
    case FORMAT_ERROR:
    case FORMAT_PFM: return pfm_write(image, target->path, error);
    case FORMAT_HDR: return hdr_write(image, target->path, error);
    case FORMAT_PNG: return png_write(image, tone, target->path, error);
    default: return ppm_write(image, tone, target->path, error);
    }
}

bool image_read(struct image *image, enum image_kind *kind, struct source *source,
                struct error *error)
{
    struct binary binary;
    *image = (struct image){0};
    if (!binary_read(&binary, source, MAGIC, KIND, error))
        return false;
    bool good = false;
    switch (binary.data[0]) {
    case 'P': good = pnm_read(image, kind, &binary, error); break;
    case '#': good = hdr_read(image, kind, &binary, error); break;
    default: good = png_read(image, kind, &binary, error);
    }
    binary_free(&binary);
    if (!good) {
        alloc_free(image->rgb);
        image->rgb = NULL;
    }
    return good;
}
