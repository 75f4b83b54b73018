/* photo_order.c - photographs in the order in which the camera took them. */
#include "stages/import_photos/photo_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct shot_name {
    const char *lens, *file; /* lens: _cXrY.png of a picture cut out of a photo, otherwise "" */
    double taken;            /* 0 in order of name */
    int photo;
};

static int by_place(const void *a, const void *b)
{
    const struct shot_name *x = a, *y = b;
    int order = strverscmp(x->lens, y->lens);
    if (!order && x->taken != y->taken) return x->taken < y->taken ? -1 : 1;
    if (!order) order = strverscmp(x->file, y->file);
    return order ? order : strcmp(x->file, y->file);
}

/* The last number of a name without its extension, with the beginning before it; digits 0: there is none. */
struct counter {
    size_t before, digits;
    double value;
};

static struct counter counter_of(const char *file)
{
    struct counter c = {0};
    size_t end = photo_stem(file);
    while (end && !(file[end - 1] >= '0' && file[end - 1] <= '9')) end--;
    c.before = end;
    while (c.before && file[c.before - 1] >= '0' && file[c.before - 1] <= '9') c.before--;
    c.digits = end - c.before;
    for (size_t i = c.before; i < end; i++) c.value = 10 * c.value + (file[i] - '0');
    return c;
}

/* Whether a counter wraps between two names that are neighbours in order of name: a leap over more than half of it. */
static bool wraps_between(const struct shot_name *a, const struct shot_name *b)
{
    const struct counter x = counter_of(a->file), y = counter_of(b->file);
    return x.digits >= 2 && x.digits == y.digits && x.before == y.before && !strncmp(a->file, b->file, x.before) &&
           y.value - x.value > pow(10, (double)x.digits) / 2;
}

/* The names a[0..count) have one time and are in order of name: what follows a wrap comes first. */
static void unwrap(struct shot_name *a, int count, struct shot_name *spare)
{
    for (int i = 1; i < count; i++)
        if (wraps_between(&a[i - 1], &a[i])) {
            memcpy(spare, a, (size_t)i * sizeof *a);
            memmove(a, a + i, (size_t)(count - i) * sizeof *a);
            memcpy(a + count - i, spare, (size_t)i * sizeof *a);
            return;
        }
}

/* Sets the times; false: not all are known. */
static bool set_times(struct shot_name *names, int count, const struct photo_scan *scan)
{
    int parts = 0;
    for (int i = 0; i < count; i++) {
        names[i].taken = scan->photos[names[i].photo].record.info.taken;
        if (!(names[i].taken > 0)) return false;
        parts += names[i].taken > floor(names[i].taken);
    }
    for (int i = 0; 2 * parts <= count && i < count; i++) names[i].taken = floor(names[i].taken);
    return true;
}

enum status photo_order_find(int *photos, int *count, const struct photo_scan *scan, enum photo_order order,
                             struct err *err)
{
    const size_t room = (size_t)scan->count + 1;
    struct shot_name *names = calloc(room, sizeof *names), *spare = calloc(room, sizeof *spare);
    int n = 0;
    *count = 0;
    if (!names || !spare) err_nomem(err, "names of photos", room * sizeof *names);
    for (int i = 0; !err->status && i < scan->count; i++)
        if (!scan->photos[i].excluded) {
            const char *file = scan->photos[i].file, *end = scan->cut ? strrchr(file, '_') : NULL;
            names[n++] = (struct shot_name){end ? end : "", file, 0, i};
        }
    if (!err->status && (order == ORDER_BY_NAME || set_times(names, n, scan))) {
        qsort(names, (size_t)n, sizeof *names, by_place);
        for (int begin = 0, end; order == ORDER_BY_TIME && begin < n; begin = end) {
            for (end = begin + 1;
                 end < n && names[end].taken == names[begin].taken && !strcmp(names[end].lens, names[begin].lens);)
                end++;
            unwrap(names + begin, end - begin, spare);
        }
        for (int i = 0; i < n; i++) photos[i] = names[i].photo;
        *count = n;
    }
    free(spare);
    free(names);
    return err->status;
}
