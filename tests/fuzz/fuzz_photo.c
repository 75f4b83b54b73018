/* fuzz_photo.c - photographs: any input gives an image of the size in its header, or an error that names the file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/image/photo.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct photo photo;
    struct photo_info info;
    struct err err = ERR_INIT, info_err = ERR_INIT;
    char path[64];
    int fd = memfd_create("photo", 0);

    if (fd < 0 || write(fd, data, size) != (ssize_t)size) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    enum status info_st = photo_read_info(&info, path, &info_err), st = photo_read(&photo, path, &err);
    if (st != err.status || info_st != info_err.status) abort();
    if (st && (photo.samples || !strstr(err.text, path))) abort();
    if (!st) {
        unsigned sum = 0;
        size_t samples = (size_t)photo.info.width * (size_t)photo.info.height * 3;
        for (size_t i = 0; i < samples; i++) sum |= photo.samples[i];
        if (!samples || (photo.info.bits == 8 && sum > 255)) abort();
        if (info_st || memcmp(&info, &photo.info, sizeof info)) abort();
        if (info.orientation < 1 || info.orientation > 8) abort();
    }
    photo_release(&photo);

    struct err hdr_err = ERR_INIT, hdr_info_err = ERR_INIT; /* with gain maps */
    info_st = photo_read_hdr_info(&info, path, &hdr_info_err);
    st = photo_read_hdr(&photo, path, &hdr_err);
    if (st && (photo.samples || photo.values || !strstr(hdr_err.text, path))) abort();
    if (!st && (info_st || memcmp(&info, &photo.info, sizeof info) || !photo.values != (photo.info.bits != 32)))
        abort();
    for (size_t i = 0; !st && photo.values && i < (size_t)photo.info.width * (size_t)photo.info.height * 3; i++)
        if (!isfinite(photo.values[i])) abort();
    photo_release(&photo);
    close(fd);
    return 0;
}
