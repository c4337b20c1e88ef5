/* Pictures in files. Writers go by the format that is asked for, readers by the first
 * bytes, so that a picture may have any name. PNG is written only: its codes are those of
 * the PPM, and reading it would take all of deflate. */
#include "io/picture/imagefile.h"

#include "geom/alloc.h"
#include "io/picture/hdr.h"
#include "io/picture/png.h"
#include "io/picture/pnm.h"

static const char KIND[] = "a picture (PFM, PPM or HDR)";

bool image_write(const struct image *image, const struct tone *tone,
                 const struct target *target, struct error *error)
{
    switch (target->format) {
    case FORMAT_PFM: return pfm_write(image, target->path, error);
    case FORMAT_HDR: return hdr_write(image, target->path, error);
    case FORMAT_PNG: return png_write(image, tone, target->path, error);
    default: return ppm_write(image, tone, target->path, error);
    }
}

bool image_of_binary(struct image *image, enum image_kind *kind, struct binary *binary,
                     struct error *error)
{
    *image = (struct image){0};
    bool good = false;
    switch (binary->data[0]) {
    case 'P': good = pnm_read(image, kind, binary, error); break;
    case '#': good = hdr_read(image, kind, binary, error); break;
    default:
        error_set(error, EXIT_USAGE, "%s: PNG is not read; compare .ppm, .pfm or .hdr",
                  binary->path);
    }
    binary_free(binary);
    if (!good) {
        alloc_free(image->rgb);
        image->rgb = NULL;
    }
    return good;
}

bool image_read(struct image *image, enum image_kind *kind, struct source *source,
                struct error *error)
{
    struct binary binary;
    *image = (struct image){0};
    return binary_read(&binary, source, IMAGE_MAGIC, KIND, error) &&
           image_of_binary(image, kind, &binary, error);
}
