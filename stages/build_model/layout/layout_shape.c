/* layout_shape.c - collects the half-spaces of one solid with their names. */
#include "stages/build_model/layout/layout_shape.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void shape_release(struct shape *s)
{
    free(s->h);
    free(s->names);
    *s = (struct shape){0};
}

void shape_add_side(struct shape *s, double x, double y, double z, double offset, const char *fmt, ...)
{
    va_list args;
    if (s->count == s->capacity) {
        const int capacity = 2 * s->capacity + 8;
        struct half_space *h = realloc(s->h, (size_t)capacity * sizeof *h);
        if (h) s->h = h;
        char(*names)[NAME_SIZE] = h ? realloc(s->names, (size_t)capacity * sizeof *names) : NULL;
        if (names) s->names = names;
        s->no_memory |= !names;
        if (!names) return;
        s->capacity = capacity;
    }
    va_start(args, fmt);
    vsnprintf(s->names[s->count], NAME_SIZE, fmt, args);
    va_end(args);
    s->h[s->count++] = (struct half_space){{x, y, z}, offset, NULL};
}

enum status shape_add(struct solid_list *list, const char *body, struct shape *s, struct err *err)
{
    for (int i = 0; i < s->count; i++) s->h[i].name = s->names[i];
    if (s->no_memory)
        err_nomem(err, "a solid", (size_t)s->capacity * sizeof *s->names);
    else
        solid_list_add(list, body, s->h, s->count, err);
    shape_release(s);
    return err->status;
}

const char *shape_reveal_side(const struct plan_wall *w, int upper_bound_of_hole)
{
    return (w->sign > 0) == (upper_bound_of_hole == 1) ? "right" : "left";
}
