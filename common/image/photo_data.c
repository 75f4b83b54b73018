/* photo_data.c - photographs in memory. */
#include "common/image/photo_data.h"

#include <stdlib.h>

#define MAX_PIXELS (UINT64_C(1) << 28)

void photo_release(struct photo *p)
{
    if (!p) return;
    free(p->samples);
    free(p->values);
    *p = (struct photo){0};
}

enum status photo_check_size(const char *path, uint64_t width, uint64_t height, struct err *err)
{
    if (width && height && width * height <= MAX_PIXELS) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s: its header says %llu x %llu pixels, wanted 1 to 2^28 pixels in all; copy the photo again.",
                   path, (unsigned long long)width, (unsigned long long)height);
}

enum status photo_init_samples(struct photo *p, struct err *err)
{
    size_t bytes = (size_t)p->info.width * (size_t)p->info.height * 3 * sizeof *p->samples;
    p->samples = malloc(bytes);
    return p->samples ? ST_OK : err_nomem(err, "a photo", bytes);
}

enum status photo_init_values(struct photo *p, struct err *err)
{
    size_t bytes = (size_t)p->info.width * (size_t)p->info.height * 3 * sizeof *p->values;
    p->values = malloc(bytes);
    return p->values ? ST_OK : err_nomem(err, "a photo", bytes);
}

float photo_find_saturation(const struct photo *p)
{
    const size_t count = (size_t)p->info.width * (size_t)p->info.height * 3, wanted = 8 + count / 10000;
    float max = 0;
    size_t found = 0;
    for (size_t i = 0; i < count; i++) max = p->values[i] > max ? p->values[i] : max;
    for (size_t i = 0; i < count; i++) found += p->values[i] == max;
    return found >= wanted ? max : 0;
}

void photo_keep_text(char *to, size_t size, const char *from, size_t max_length)
{
    size_t n = 0;
    for (size_t i = 0; i < max_length && from[i] && n + 1 < size; i++)
        if (from[i] >= 32 && from[i] < 127 && (n || from[i] != ' ')) to[n++] = from[i];
    while (n && to[n - 1] == ' ') n--;
    to[n] = 0;
}
