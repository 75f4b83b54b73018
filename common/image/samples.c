/* samples.c - allocates samples of images. */
#include "common/image/samples.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define HUGE_PAGE ((size_t)2 << 20)

void *samples_alloc(size_t bytes)
{
    const size_t unit = bytes < 4 * HUGE_PAGE ? 64 : HUGE_PAGE;
    if (bytes > SIZE_MAX - unit) return NULL;
    const size_t size = bytes ? (bytes + unit - 1) / unit * unit : unit;
    void *data = aligned_alloc(unit, size);
    if (!data) return NULL;
    if (unit == HUGE_PAGE) madvise(data, bytes / unit * unit, MADV_HUGEPAGE); /* on failure pages stay small */
    memset(data, 0, size);
    return data;
}
