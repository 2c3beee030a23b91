/* SPDX-License-Identifier: BSD-3-Clause */
/* Grey images in files, PGM or PNG by their first bytes. */
#ifndef DEM_IMAGE_FILE_H
#define DEM_IMAGE_FILE_H

#include "image.h"

/* \param[out] fault  [IMAGE_FAULT] what is wrong behind "PATH:", with a line where there is one, if IMAGE_REFUSED */
image_status image_file_read(image *out, char *fault, const char *path);

/* Width and height of an image, m, from its first bytes alone; false where they do not have them. */
bool image_file_measure(double size[2], const char *path, double scale);

#endif
