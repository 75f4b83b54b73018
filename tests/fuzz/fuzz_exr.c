/* fuzz_exr.c - OpenEXR files: any input gives finite samples, or an error that names the file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/image/exr.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"R", "Z"};
    char path[64];
    int fd = memfd_create("exr", 0);

    if (fd < 0 || write(fd, data, size) != (ssize_t)size) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    for (int all = 0; all < 2; all++) {
        struct exr_image im;
        struct err err = ERR_INIT;
        enum status st = exr_read(&im, path, all ? NULL : names, all ? 0 : 2, &err);
        if (st != err.status) abort();
        if (st && (im.planes || !strstr(err.text, path))) abort();
        for (int i = 0; i < im.count; i++)
            for (size_t k = 0; im.planes[i].f && k < (size_t)im.width * (size_t)im.height; k++)
                if (!isfinite(im.planes[i].f[k])) abort();
        exr_image_release(&im);
    }
    close(fd);
    return 0;
}
