/* SPDX-License-Identifier: BSD-3-Clause */
#include "image.h"

#include <stdlib.h>

bool image_create(image *out)
{
    out->grey = calloc(out->width * out->height, sizeof *out->grey);
    return out->grey != NULL;
}

void image_free(image *picture)
{
    free(picture->grey);
    *picture = (image){0};
}
