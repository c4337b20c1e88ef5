/* A picture in memory. */
#ifndef IO_PICTURE_IMAGE_H
#define IO_PICTURE_IMAGE_H

enum { IMAGE_SIDE_MOST = 1 << 24 }; /* pixels along a side of a picture to read */

struct image {
    int width, height;
    float *rgb; /* [height][width][3], top scanline first, W/m^2 */
};

/* Samples of a picture read: linear light; or codes of a screen, as shares of the
 * greatest. */
enum image_kind { IMAGE_LINEAR, IMAGE_CODES };

#endif
