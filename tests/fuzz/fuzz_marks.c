/* fuzz_marks.c - users' marks on photos: any bytes give marks with finite positions, or an error with the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/find_axes/marks.h"
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
static struct cloud_point points[] = {{.position = {0.1, 0.1, 2}, .views = 1}, {.position = {0, 0, 3}, .views = 1}};

static void locate(const struct mark *m, const struct mark_list *list)
{
    const struct lens_list lens_list = {lenses, 2};
    const struct camera_set set = {.views = views, .view_count = 2};
    const struct point_cloud cloud = {points, 2, 0.1};
    const struct mark_scene scene = {&set, &lens_list, &cloud, {0, -1, 0}, -1};
    struct err err = ERR_INIT;
    struct vec3 at;
    if (m->kind != MARK_POINT && m->kind != MARK_CORNER) return;
    if (mark_locate(&at, m->kind, m->name, list, &scene, &err)) {
        if (!strstr(err.text, list->path)) abort();
    } else if (!isfinite(at.x) || !isfinite(at.y) || !isfinite(at.z)) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    for (int file = MARKS_SCALE; file <= MARKS_FIX; file++) {
        struct mark_list list;
        struct err err = ERR_INIT;
        if (mark_list_read(&list, path, (enum mark_file)file, NULL, &err)) {
            if (!strstr(err.text, path) || list.marks || list.count) abort();
            continue;
        }
        for (int i = 0; i < list.count && i < 100; i++) locate(&list.marks[i], &list);
        mark_list_release(&list);
    }
    unlink(path);
    return 0;
}
