/* fuzz_thing_marks.c - names and marks of things: any bytes give names that scripts can use and finite rays, or an
 * error with the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/model/thing_marks.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char name_a[] = "a", name_b[] = "b";
static struct lens lenses[] = {
    {name_a, name_a, {CAMERA_SIMPLE_RADIAL, 40, 30, {30, 20, 15, -0.2}}, {1, 0, 0, 0}},
    {name_b, name_b, {CAMERA_OPENCV_FISHEYE, 40, 30, {12, 12, 20, 15, 0.1, 0, 0, 0}}, {0.8, 0, 0.6, 0}}};
static struct view views[] = {{.name = "a", .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
                              {.name = "b",
                               .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                               .translation = {-1, 0, 0},
                               .center = {1, 0, 0}}};

static void check_names(const struct thing_marks *m)
{
    for (int i = 0; i < m->name_count; i++) {
        if (!m->names[i][0] || strlen(m->names[i]) > 64 || strpbrk(m->names[i], " /\\\"#") || m->lines[i] < 2) abort();
        if (i && m->lines[i] <= m->lines[i - 1]) abort();
        for (int k = 0; k < i && k < 100; k++)
            if (!strcmp(m->names[i], m->names[k])) abort();
    }
}

static void check_marks(const struct thing_marks *m)
{
    for (int i = 0; i < m->mark_count; i++) {
        const struct thing_mark *k = &m->marks[i];
        if (k->name < 0 || k->name >= m->name_count || k->line < m->lines[k->name]) abort();
        if (!(k->u >= 0 && k->u <= 40 && k->v >= 0 && k->v <= 30)) abort();
        if (!(fabs(vec3_length(k->direction) - 1) < 1e-9)) abort();
    }
}

static void is_empty(const struct thing_marks *m, const struct err *err, const char *path)
{
    if (!strstr(err->text, path) || m->names || m->lines || m->marks || m->name_count || m->mark_count) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct lens_list lens_list = {lenses, 2};
    const struct camera_set set = {.views = views, .view_count = 2};
    char path[FUZZ_PATH];
    struct thing_marks names, marks;
    struct err err = ERR_INIT, marks_err = ERR_INIT;

    fuzz_file(path, data, size);
    if (thing_names_read(&names, path, NULL, &err))
        is_empty(&names, &err, path);
    else
        check_names(&names);
    if (thing_marks_read(&marks, path, &set, &lens_list, NULL, &marks_err)) {
        is_empty(&marks, &marks_err, path);
    } else {
        check_names(&marks);
        check_marks(&marks);
        if (err.status || marks.name_count != names.name_count) abort(); /* whoever has cameras refuses more */
    }
    thing_marks_release(&names);
    thing_marks_release(&marks);
    unlink(path);
    return 0;
}
