/* fuzz_response.c - response.txt: any input gives a valid curve, or an error that names the file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/image/response.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct response r;
    struct err err = ERR_INIT;
    char path[64];
    int fd = memfd_create("response", 0);

    if (fd < 0 || write(fd, data, size) != (ssize_t)size) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    enum status st = response_read(&r, path, NULL, &err);
    if (st != err.status || (st && (r.table || !strstr(err.text, path)))) abort();
    for (int c = 0; c < 3; c++) {
        float last = 0;
        for (int i = 0; !st && i < RESPONSE_LEVELS; i++) {
            const float light = response_light(&r, c, (float)i / (RESPONSE_LEVELS - 1));
            if (!(light >= last) || !isfinite(light)) abort();
            last = light;
        }
    }
    close(fd);
    return 0;
}
