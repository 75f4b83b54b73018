/* fuzz_response.c - response.txt: any bytes give a curve that rises, or a sentence naming the file. */
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
    enum status st = response_read(&r, path, &err);
    if (st != err.status || (st && (r.table || !strstr(err.text, path)))) abort();
    for (int c = 0; c < 3; c++)
        for (int i = 0; !st && i < RESPONSE_LEVELS; i++) {
            const float light = response_light(&r, c, (float)i / (RESPONSE_LEVELS - 1));
            const float back = response_sample(&r, c, light);
            if (!(light >= 0) || !isfinite(light) || !(back >= 0 && back <= 1)) abort();
        }
    close(fd);
    return 0;
}
