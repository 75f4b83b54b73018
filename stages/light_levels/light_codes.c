/* light_codes.c - see light_codes.h. */
#include "stages/light_levels/light_codes.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/base64.h"

enum { LEVELS = 65535, MIDDLE = 32768, RUN_BYTES = 10 };
static const double SPAN = 1e7; /* of light: what is less counts as none */

double light_codes_low(double high) { return high / SPAN; }

double light_codes_highest(const float *values, size_t count)
{
    double high = 0;
    for (size_t i = 0; i < count; i++) high = fmax(high, (double)values[i]);
    return high;
}

double light_codes_most(const float *values, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++) most = fmax(most, fabs((double)values[i]));
    return most;
}

static enum status put(FILE *to, const float *values, size_t count, double scale, int is_signed, struct err *err)
{
    unsigned char *bytes = malloc(2 * count + 1);
    const double low = light_codes_low(scale);
    if (!bytes) return err_nomem(err, "light", 2 * count);
    for (size_t i = 0; i < count; i++) {
        const double v = (double)values[i];
        long n = v > low ? 1 + lround((LEVELS - 1) * log(v / low) / log(SPAN)) : 0;
        if (is_signed) n = MIDDLE + (scale > 0 ? lround((MIDDLE - 1) * v / scale) : 0);
        bytes[2 * i] = (unsigned char)(n & 255);
        bytes[2 * i + 1] = (unsigned char)(n >> 8);
    }
    base64_write(to, bytes, 2 * count);
    free(bytes);
    return ST_OK;
}

enum status light_codes_put(FILE *to, const float *values, size_t count, double high, struct err *err)
{
    return put(to, values, count, high, 0, err);
}

enum status light_codes_put_signed(FILE *to, const float *values, size_t count, double most, struct err *err)
{
    return put(to, values, count, most, 1, err);
}

void light_codes_take(float *values, const unsigned char *bytes, size_t count, double high)
{
    for (size_t i = 0; i < count; i++) {
        const int n = bytes[2 * i] + 256 * bytes[2 * i + 1];
        values[i] = n ? (float)(light_codes_low(high) * exp(log(SPAN) * (n - 1) / (LEVELS - 1))) : 0;
    }
}

void light_codes_take_signed(float *values, const unsigned char *bytes, size_t count, double most)
{
    for (size_t i = 0; i < count; i++)
        values[i] = (float)(most * (bytes[2 * i] + 256 * bytes[2 * i + 1] - MIDDLE) / (MIDDLE - 1));
}

/* ------------------------------------------------------------------------------------------------------------- runs */

static size_t put_number(unsigned char *to, unsigned number)
{
    size_t used = 0;
    for (; number > 127; number >>= 7) to[used++] = (unsigned char)(128 | (number & 127));
    to[used++] = (unsigned char)number;
    return used;
}

enum status light_codes_put_runs(FILE *to, const int *values, size_t count, struct err *err)
{
    unsigned char *bytes = malloc(RUN_BYTES * count + 1);
    size_t used = 0;
    if (!bytes) return err_nomem(err, "pixels", RUN_BYTES * count);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && values[end] == values[i];) end++;
        used += put_number(bytes + used, (unsigned)(end - i));
        used += put_number(bytes + used, (unsigned)values[i]);
    }
    base64_write(to, bytes, used);
    free(bytes);
    return ST_OK;
}

static size_t take_number(unsigned *number, const unsigned char *bytes, size_t at, size_t size)
{
    *number = 0;
    for (int shift = 0; at < size && shift < 32; shift += 7) {
        *number |= (unsigned)(bytes[at] & 127) << shift;
        if (bytes[at++] < 128) return at;
    }
    return 0;
}

int light_codes_take_runs(int *values, const unsigned char *bytes, size_t size, size_t count)
{
    size_t filled = 0, at = 0;
    while (at < size) {
        unsigned run, value;
        if (!(at = take_number(&run, bytes, at, size)) || !(at = take_number(&value, bytes, at, size))) return 0;
        if (run > count - filled || value > 0x7fffffff) return 0;
        for (unsigned k = 0; k < run; k++) values[filled++] = (int)value;
    }
    return filled == count;
}
