/* made_layers.c - synthetic layered depth maps of any number and size, to measure the cost of rendering them.
 *
 *   made_layers --out DIR [--views N] [--width W --height H] [--side S]
 *
 * The cameras are on a grid, five per row, with parallel axes, in front of a wavy wall z = 4 + sin(2 x) cos(2 y) /
 * 2. The segments of a view are squares of S px, each in a plane that is tangent to the wall; where two meet, one
 * column or row of pixels belongs to both by half. Writes DIR/views/{cameras,images,points3D}.txt,
 * DIR/depth/VIEW.exr and VIEW.txt, and DIR/cameras with one camera between the views, of their size. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/cli.h"
#include "common/layers/layered_depth.h"

#define ACROSS  5
#define SPACING 0.3

struct made {
    const char *out;
    int views, width, height, side;
};

/* 1/z of the wall at the pixel (u, v) of a camera at (x, y, 0). */
static double inverse_depth(const struct view *view, double u, double v)
{
    double z = 4;
    for (int i = 0; i < 50; i++)
        z = 4 + 0.5 * sin(2 * (view->center.x + (u - view->cx) / view->fx * z)) *
                    cos(2 * (view->center.y + (v - view->cy) / view->fy * z));
    return 1 / z;
}

static void put(struct layer *l, size_t i, const struct depth_segment *s, double u, double v, float alpha)
{
    const double inverse_z = s->plane[0] * u + s->plane[1] * v + s->plane[2];
    for (int c = 0; c < 3; c++) l->rgba[4 * i + (size_t)c] = alpha * (float)(0.2 + 0.1 * ((s->id >> c) % 4));
    l->rgba[4 * i + 3] = alpha;
    l->z[i] = (float)(1 / inverse_z);
    l->id[i] = s->id;
}

static enum status make_depth(struct layered_depth *d, const struct view *view, int side, struct err *err)
{
    const int across = (view->width + side - 1) / side, down = (view->height + side - 1) / side;

    if (layered_depth_init(d, view->width, view->height, err)) return err->status;
    d->segments = calloc((size_t)across * (size_t)down, sizeof *d->segments);
    if (!d->segments) return err_nomem(err, "segments", (size_t)across * (size_t)down);
    d->segment_count = across * down;
    for (int k = 0; k < d->segment_count; k++) {
        struct depth_segment *s = &d->segments[k];
        const double u = (k % across + 0.5) * side, v = (k / across + 0.5) * side;
        const double a = inverse_depth(view, u + 0.5, v) - inverse_depth(view, u - 0.5, v);
        const double b = inverse_depth(view, u, v + 0.5) - inverse_depth(view, u, v - 0.5);
        *s = (struct depth_segment){(uint32_t)k + 1, 0, {a, b, inverse_depth(view, u, v) - a * u - b * v}, 0.002, 1, 0};
    }
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            const size_t i = (size_t)y * (size_t)view->width + (size_t)x;
            const int k = y / side * across + x / side;
            const bool right = x % side == side - 1 && x + 1 < view->width;
            const bool below = !right && y % side == side - 1 && y + 1 < view->height;
            const float alpha = right || below ? 0.5f : 1;
            put(&d->interior, i, &d->segments[k], x + 0.5, y + 0.5, alpha);
            d->segments[k].pixels++;
            if (alpha < 1) put(&d->boundary, i, &d->segments[right ? k + 1 : k + across], x + 0.5, y + 0.5, 1 - alpha);
        }
    return ST_OK;
}

/* Writes cameras on the grid, the first at (column, row). */
static enum status write_cameras(const struct made *m, const char *name, int count, double column, double row,
                                 char folder[4096], struct err *err)
{
    static const char *const files[] = {"cameras.txt", "images.txt", "points3D.txt"};
    if (snprintf(folder, 4096, "%s/%s", m->out, name) >= 4096)
        return err_set(err, ST_IO, "the path %s/%s is too long.", m->out, name);
    if (mkdir(folder, 0777) && errno != EEXIST) return err_errno(err, "make", folder);
    for (int k = 0; k < 3; k++) {
        char path[4200];
        snprintf(path, sizeof path, "%s/%s", folder, files[k]);
        FILE *to = fopen(path, "w");
        if (!to) return err_errno(err, "write", path);
        if (k == 0)
            fprintf(to, "1 PINHOLE %d %d %d %d %.17g %.17g\n", m->width, m->height, m->width, m->width, 0.5 * m->width,
                    0.5 * m->height);
        for (int i = 0; k == 1 && i < count; i++)
            fprintf(to, "%d 1 0 0 0 %.17g %.17g 0 1 v%02d.exr\n\n", i + 1, -SPACING * (i % ACROSS + column),
                    -SPACING * (i / ACROSS + row), i);
        if (fclose(to)) return err_errno(err, "write", path);
    }
    return ST_OK;
}

static enum status make(const struct made *m, const struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    char folder[4096], depth[4096];

    if (m->views < 1 || m->views > 99 || m->width < 1 || m->height < 1 || m->side < 1)
        return err_set(err, ST_USAGE,
                       "--views %d --width %d --height %d --side %d: wanted 1 to 99 views, sizes from 1.", m->views,
                       m->width, m->height, m->side);
    if (mkdir(m->out, 0777) && errno != EEXIST) err_errno(err, "make", m->out);
    if (!err->status)
        write_cameras(m, "cameras", 1, (ACROSS - 1) / 2.0 + 0.4, (m->views - 1) / ACROSS / 2.0 + 0.4, folder, err);
    if (!err->status) write_cameras(m, "views", m->views, 0, 0, folder, err);
    if (!err->status) camera_set_read(&set, folder, NULL, err);
    snprintf(depth, sizeof depth, "%.4000s/depth", m->out);
    for (int i = 0; !err->status && i < set.view_count; i++) {
        struct layered_depth d = {0};
        char path[4300];
        snprintf(path, sizeof path, "%s/%s.exr", depth, set.views[i].name);
        make_depth(&d, &set.views[i], m->side, err);
        if (!err->status) layered_depth_write(&d, &set.views[i], path, prov, err);
        layered_depth_release(&d);
    }
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct made m = {.views = 15, .width = 1224, .height = 817, .side = 11};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes synthetic layered depth maps of any number and size."),
        CLI_STR("out", &m.out, CLI_REQUIRED, "folder to write"),
        CLI_INT("views", &m.views, CLI_OPTIONAL, "number of views"),
        CLI_INT("width", &m.width, CLI_OPTIONAL, "width of a view, px"),
        CLI_INT("height", &m.height, CLI_OPTIONAL, "height of a view, px"),
        CLI_INT("side", &m.side, CLI_OPTIONAL, "side of a segment, px"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "made_layers", opts, &prov, &err) == CLI_RUN) make(&m, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
