/* fuzz_edge_frame.c - readers of the straight edges of a view and of the frame that they give: any bytes give lines of
 * finite ends, or a frame whose walls have a heading; or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/line_list.h"
#include "common/capture/room_frame.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_lines(const char *path)
{
    struct line_list list = {0};
    struct err err = ERR_INIT;

    if (line_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.lines || list.count) abort();
        return;
    }
    for (int i = 0; i < list.count; i++) {
        const struct view_line *l = &list.lines[i];
        if (!isfinite(l->u0 + l->v0 + l->u1 + l->v1) || (l->u0 == l->u1 && l->v0 == l->v1)) abort();
    }
    line_list_release(&list);
}

static void check_frame(const char *path)
{
    struct room_frame f = {0};
    struct err err = ERR_INIT;

    if (room_frame_read(&f, path, NULL, &err)) {
        if (!strstr(err.text, path) || f.headings || f.walls) abort();
        return;
    }
    if (!f.known && (f.heading_count || f.wall_count)) abort();
    for (int i = 0; i < f.heading_count; i++)
        if (!(fabs(vec3_dot(f.headings[i].along, f.up)) < 0.01)) abort();
    for (int i = 0; i < f.wall_count; i++)
        if (f.walls[i].heading < 0 || f.walls[i].heading >= f.heading_count || abs(f.walls[i].side) != 1) abort();
    room_frame_release(&f);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    check_lines(path);
    check_frame(path);
    unlink(path);
    return 0;
}
