/* fuzz_regions.c - drawn rectangles: any bytes give rectangles inside their view, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/film/regions.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char name_a[] = "a", name_b[] = "b";
static struct lens lenses[] = {
    {name_a, name_a, {CAMERA_SIMPLE_RADIAL, 40, 30, {30, 20, 15, -0.2}}, {1, 0, 0, 0}},
    {name_b, name_b, {CAMERA_OPENCV_FISHEYE, 40, 30, {12, 12, 20, 15, 0.1, 0, 0, 0}}, {0.8, 0, 0.6, 0}}};
static struct view views[] = {{.name = "a", .width = 40, .height = 30, .fx = 30, .fy = 30, .cx = 20, .cy = 15},
                              {.name = "b", .width = 30, .height = 20, .fx = 12, .fy = 12, .cx = 15, .cy = 10}};

static void map_to_view(const struct region *r, const char *path)
{
    const struct lens_list list = {lenses, 2};
    const struct camera_set set = {.views = views, .view_count = 2};
    struct subject s = {0};
    struct err err = ERR_INIT;
    int at = -1;
    double part = -1;
    if (!(r->x1 > r->x0) || !(r->y1 > r->y0)) abort();
    if (region_in_view(&s, &at, &part, r, path, &set, &list, &err)) {
        if (!strstr(err.text, path) || s.view) abort();
    } else if (at < 0 || !(part >= 0 && part < 1 + 1e-9) || !(s.x0 >= 0 && s.y0 >= 0 && s.x1 > s.x0 && s.y1 > s.y0) ||
               !(s.x1 <= views[at].width && s.y1 <= views[at].height)) {
        abort();
    }
    subject_release(&s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct region_list list;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (region_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.regions || list.count) abort();
    } else {
        for (int i = 0; i < list.count; i++) map_to_view(&list.regions[i], path);
        region_list_release(&list);
    }
    unlink(path);
    return 0;
}
