/* evaluate_revealed.c - pictures of edited scenes where the edit reveals something: edited.E.revealed* */
#include "stages/evaluate/render/render_metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "stages/evaluate/render/revealed_error.h"
#include "stages/evaluate/scene/renders.h"
#include "stages/evaluate/scene/true_planes.h"

enum { MIN_REVEALED = 200 }; /* pixels of a picture, for a value of its own */

struct revealed_sums {
    double square, pixels; /* sums over pictures, weighted by revealed pixels */
    size_t all;
    int pictures;
};

static enum status measure(struct evaluation *e, const struct renders *list, struct render *r, struct revealed_sums *s,
                           struct err *err)
{
    struct surface_planes planes;
    struct image truth = {0};
    double psnr;
    bool found;
    const size_t pixels = (size_t)r->map.lens.width * (size_t)r->map.lens.height;
    uint8_t *mask = malloc(pixels);
    true_planes_read(&planes, &found, e, list->set, r->of->name, &r->map, err);
    if (!err->status && !mask) err_nomem(err, "a mask", pixels);
    if (!err->status && found && !render_read(e, list, r, &truth, err)) {
        const struct true_surface surface = {{planes.ids[0], planes.ids[1]}, {planes.depths[0], planes.depths[1]}};
        const size_t revealed = revealed_find(mask, &surface, pixels);
        const struct radiance_pixels p = {r->picture.rgb.data, truth.data, mask, pixels, r->scale, e->white};
        s->pictures++;
        s->all += pixels;
        if (revealed && revealed_psnr(&psnr, &p, planes.ids[1])) {
            s->square += (double)revealed * pow(10, -psnr / 10);
            s->pixels += (double)revealed;
            if (revealed >= MIN_REVEALED) evaluation_metric(e, r->name, list->set->prefix, "revealed_psnr", psnr, err);
        }
    }
    free(mask);
    true_planes_release(&planes);
    image_release(&truth);
    linear_picture_release(&r->picture);
    return err->status;
}

static enum status measure_edit(struct evaluation *e, const char *where, struct err *err)
{
    struct true_set set = {0};
    struct renders list = {0};
    struct revealed_sums s = {0};
    true_set_read(&set, e->truth_folder, where, e->prov, err);
    if (!err->status && set.count) renders_find(&list, e, &set, err);
    if (!err->status && list.count) renders_scale(e, &list, err);
    for (int i = 0; !err->status && e->white > 0 && i < list.count; i++) measure(e, &list, &list.list[i], &s, err);
    if (!err->status && s.all) evaluation_metric(e, NULL, set.prefix, "revealed", 100 * s.pixels / (double)s.all, err);
    if (!err->status && s.pixels > 0)
        evaluation_metric(e, NULL, set.prefix, "revealed_psnr", -10 * log10(s.square / s.pixels), err);
    renders_release(&list);
    true_set_release(&set);
    return err->status;
}

enum status evaluate_revealed(struct evaluation *e, struct err *err)
{
    struct true_edits edits = {0};
    true_edits_find(&edits, e->truth_folder, err);
    for (int i = 0; !err->status && i < edits.count; i++) {
        char where[64];
        snprintf(where, sizeof where, "edited-%s", edits.names[i]);
        measure_edit(e, where, err);
    }
    true_edits_release(&edits);
    return err->status;
}
