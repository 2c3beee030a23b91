/* SPDX-License-Identifier: BSD-3-Clause */
#include "image_file.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "pgm.h"
#include "png.h"

static const size_t most = (size_t)1 << 30; /* bytes of a file */

image_status image_file_read(image *out, char *fault, const char *path)
{
    char *bytes, why[FILE_WHY], what[IMAGE_FAULT - 2];
    size_t size;
    const file_status status = file_read(&bytes, &size, path, most, why);
    if (status == FILE_REFUSED) (void)snprintf(fault, IMAGE_FAULT, " %s", why);
    if (status != FILE_READ) return status == FILE_MEMORY ? IMAGE_MEMORY : IMAGE_REFUSED;
    image_status result = IMAGE_REFUSED;
    if (png_begins(bytes, size)) {
        result = png_parse(out, what, bytes, size);
        if (result == IMAGE_REFUSED) (void)snprintf(fault, IMAGE_FAULT, " %s", what);
    } else if (pgm_begins(bytes, size)) {
        result = pgm_parse(out, fault, bytes, size);
    } else {
        (void)snprintf(fault, IMAGE_FAULT, " neither a PGM image (P2, P5) nor a PNG image");
    }
    free(bytes);
    return result;
}

bool image_file_measure(double size[2], const char *path, double scale)
{
    char bytes[4096];
    image sides = {0};
    const size_t n = file_begin(bytes, sizeof bytes, path);
    const bool known = png_begins(bytes, n) ? png_measure(&sides, bytes, n) : pgm_measure(&sides, bytes, n);
    size[0] = (double)sides.width * scale;
    size[1] = (double)sides.height * scale;
    return known;
}
