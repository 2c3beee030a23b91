/* SPDX-License-Identifier: BSD-3-Clause */
/* Feeds every file of a folder to a fuzz target, without a fuzzer. */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int replay(const char *path)
{
    enum { capacity = 1 << 21 };
    FILE *file = fopen(path, "rb");
    uint8_t *data = malloc(capacity);
    if (file == NULL || data == NULL) {
        (void)fprintf(stderr, "%s cannot be read\n", path);
        return 1;
    }
    const size_t size = fread(data, 1, capacity, file);
    (void)fclose(file);
    (void)LLVMFuzzerTestOneInput(data, size);
    free(data);
    return 0;
}

int main(int argc, char **argv)
{
    DIR *folder = argc == 2 ? opendir(argv[1]) : NULL;
    int inputs = 0, failed = 0;
    if (folder == NULL) {
        (void)fprintf(stderr, "usage: replay FOLDER\n");
        return 2;
    }
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        char path[4096];
        if (entry->d_name[0] == '.') continue;
        (void)snprintf(path, sizeof path, "%s/%s", argv[1], entry->d_name);
        failed += replay(path);
        inputs++;
    }
    (void)closedir(folder);
    (void)printf("%d inputs\n", inputs);
    return failed > 0 || inputs == 0;
}
