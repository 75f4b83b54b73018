/* flatten_depth.c - layered depth maps with segments of constant z, as in [Colburn 2014, 3.5]: the depth of each
 * segment's centroid.
 *
 *   flatten_depth --views DIR --depth DIR --out DIR
 *
 * 1/z is linear over a segment, so its value at the centroid of the segment's pixels is the mean over them. Pixels,
 * colours and ids do not change. */
#include <stdio.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/layers/layered_depth.h"

struct centroid {
    double u, v, weight;
};

/* Adds the pixels of a layer to their segments' centroids, weighted by alpha. */
static void gather(struct centroid *c, const struct layer *l, int width, int height)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t i = (size_t)y * (size_t)width + (size_t)x;
            if (!l->id[i]) continue;
            c[l->id[i] - 1].u += l->rgba[4 * i + 3] * (x + 0.5);
            c[l->id[i] - 1].v += l->rgba[4 * i + 3] * (y + 0.5);
            c[l->id[i] - 1].weight += l->rgba[4 * i + 3];
        }
}

static void set_depth(struct layer *l, const struct depth_segment *segments, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++)
        if (l->id[i]) l->z[i] = (float)(1 / segments[l->id[i] - 1].plane[2]);
}

static enum status flatten(struct layered_depth *d, struct err *err)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height, count = (size_t)d->segment_count + 1;
    struct centroid *c = calloc(count, sizeof *c);

    if (!c) return err_nomem(err, "segments", count * sizeof *c);
    gather(c, &d->interior, d->width, d->height);
    gather(c, &d->boundary, d->width, d->height);
    for (int i = 0; i < d->segment_count; i++) {
        double *plane = d->segments[i].plane;
        if (!(c[i].weight > 0)) continue; /* it has no pixel */
        plane[2] += (plane[0] * c[i].u + plane[1] * c[i].v) / c[i].weight;
        plane[0] = plane[1] = 0;
    }
    set_depth(&d->interior, d->segments, pixels);
    set_depth(&d->boundary, d->segments, pixels);
    free(c);
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *depth = NULL, *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes the segments of depth maps constant in z."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &depth, CLI_REQUIRED, "folder of layered depth maps"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder for the flattened depth maps"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct camera_set set = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "flatten_depth", opts, &prov, &err) == CLI_RUN) camera_set_read(&set, views, NULL, &err);
    for (int i = 0; !err.status && i < set.view_count; i++) {
        struct layered_depth d = {0};
        char from[4096], to[4096];
        if (snprintf(from, sizeof from, "%s/%s.exr", depth, set.views[i].name) >= (int)sizeof from ||
            snprintf(to, sizeof to, "%s/%s.exr", out, set.views[i].name) >= (int)sizeof to)
            err_set(&err, ST_IO, "a file name in %s or %s is too long.", depth, out);
        if (!err.status && !layered_depth_read(&d, from, NULL, &err) && !flatten(&d, &err))
            layered_depth_write(&d, &set.views[i], to, &prov, &err);
        layered_depth_release(&d);
    }
    err_report(&err);
    camera_set_release(&set);
    provenance_release(&prov);
    return err_exit_code(&err);
}
