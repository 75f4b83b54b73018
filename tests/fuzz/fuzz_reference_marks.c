/* fuzz_reference_marks.c - marks in lighting reference images: any bytes give marks with finite positions and lenses
 * that can be used, or an error with the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/hdr_merge/reference_marks.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char wall_a[] = "south", wall_b[] = "oblique", window_a[] = "sunny", window_b[] = "slanted", id[] = "sky";
static struct model_wall walls[] = {{.name = wall_a, .normal = {0, 1}, .offset = 0.15, .thickness = 0.3},
                                    {.name = wall_b, .normal = {0.6, 0.8}, .thickness = 0.3}};
static struct model_opening openings[] = {
    {.name = window_a, .kind = MODEL_WINDOW, .wall = 0, .s = {1.4, 3.4}, .z = {0.75, 2.25}},
    {.name = window_b, .kind = MODEL_WINDOW, .wall = 1, .s = {1, 2}, .z = {0.5, 1}}};
static const struct model_plan plan = {.walls = walls, .openings = openings, .wall_count = 2, .opening_count = 2};
static const struct photo_record image = {.id = id};

static void locate(const struct reference_mark *m, const struct reference_marks *list)
{
    const struct model_wall *wall;
    const bool in_opening = m->kind == REFERENCE_CORNER || m->kind == REFERENCE_WINDOW;
    struct err err = ERR_INIT;
    struct vec3 at;
    if (reference_mark_locate(&at, &wall, m, list, &plan, &err)) {
        if (!strstr(err.text, list->path) || !in_opening) abort();
        return;
    }
    if ((wall != NULL) != in_opening) abort();
    if (!isfinite(at.x) || !isfinite(at.y) || !isfinite(at.z)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct reference_marks list;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (reference_marks_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.marks || list.count) abort();
    } else {
        for (int i = 0; i < list.count; i++) {
            const struct reference_mark *m = &list.marks[i];
            struct err bad = ERR_INIT;
            locate(m, &list);
            if (m->kind == REFERENCE_LENS && camera_check(&m->lens, &bad)) abort();
            if (reference_mark_is_of(m, &image) && strcmp(m->image, id)) abort();
        }
        reference_marks_release(&list);
    }
    unlink(path);
    return 0;
}
