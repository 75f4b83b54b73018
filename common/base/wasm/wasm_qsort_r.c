/* wasm_qsort_r.c - sorts by merging, as the C library of Linux does: equal items keep their order. */
#include <stdlib.h>
#include <string.h>

static void sort(char *items, size_t count, size_t size, int (*compare)(const void *, const void *, void *), void *ctx,
                 char *room)
{
    const size_t half = count / 2;
    char *a = items, *b = items + half * size, *to = room;
    if (count < 2) return;
    sort(items, half, size, compare, ctx, room);
    sort(b, count - half, size, compare, ctx, room);
    while (a < items + half * size && b < items + count * size) {
        char **least = compare(a, b, ctx) <= 0 ? &a : &b;
        memcpy(to, *least, size);
        *least += size;
        to += size;
    }
    /* what is left of the second half is at its place; that of the first goes before it */
    if (a < items + half * size) memmove(items + (to - room), a, (size_t)(items + half * size - a));
    memcpy(items, room, (size_t)(to - room));
}

void qsort_r(void *items, size_t count, size_t size, int (*compare)(const void *, const void *, void *), void *ctx)
{
    char *room = malloc(count * size + 1);
    if (!room) abort();
    sort(items, count, size, compare, ctx, room);
    free(room);
}
