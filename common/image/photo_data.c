/* photo_data.c - photographs in memory. */
#include "common/image/photo_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define MAX_PIXELS (UINT64_C(1) << 28)

void photo_release_pixels(struct photo *p)
{
    free(p->samples);
    free(p->bytes);
    free(p->values);
    p->samples = NULL;
    p->bytes = NULL;
    p->values = NULL;
}

void photo_release(struct photo *p)
{
    if (!p) return;
    photo_release_pixels(p);
    colour_space_release(p->space);
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

double photo_time(const char *date, const char *subseconds)
{
    struct tm t = {0};
    char fraction[16];
    const size_t digits = strspn(subseconds, "0123456789");
    if (sscanf(date, "%4d:%2d:%2d %2d:%2d:%2d", &t.tm_year, &t.tm_mon, &t.tm_mday, &t.tm_hour, &t.tm_min, &t.tm_sec) !=
        6)
        return 0;
    if (t.tm_year < 1970 || t.tm_mon < 1 || t.tm_mon > 12 || t.tm_mday < 1 || t.tm_mday > 31 || t.tm_hour < 0 ||
        t.tm_hour > 24 || t.tm_min < 0 || t.tm_min > 59 || t.tm_sec < 0 || t.tm_sec > 60)
        return 0;
    t.tm_year -= 1900;
    t.tm_mon--;
    snprintf(fraction, sizeof fraction, "0.%.*s", digits < 9 ? (int)digits : 9, subseconds);
    return (double)timegm(&t) + (digits ? strtod(fraction, NULL) : 0);
}
