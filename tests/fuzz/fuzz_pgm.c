/* SPDX-License-Identifier: BSD-3-Clause */
/* Any bytes may come as an image. One that is accepted has as many pixels as its bytes can hold, none beyond white. */
#include "pgm.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    image picture;
    char fault[IMAGE_FAULT] = "";
    const image_status status = pgm_parse(&picture, fault, (const char *)data, size);
    if (status == IMAGE_READ) {
        if (picture.width * picture.height > size) abort();
        for (size_t k = 0; k < picture.width * picture.height; k++)
            if (picture.grey[k] > picture.white) abort();
    } else if (picture.grey != NULL || strchr(fault, ':') == NULL) {
        abort();
    }
    image_free(&picture);
    return 0;
}
