/* evaluate_revealed.c - pictures of edited scenes where the edit reveals something: edited.E.revealed*; and where that
 * is furniture: edited.E.revealed_things* */
#include "stages/evaluate/render/render_metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/file_path.h"
#include "stages/evaluate/render/revealed_error.h"
#include "stages/evaluate/scene/renders.h"
#include "stages/evaluate/scene/true_planes.h"
#include "stages/evaluate/truth/true_faces.h"
#include "stages/evaluate/truth/wall_plan.h"

enum { MIN_REVEALED = 200 }; /* pixels of a picture, for a value of its own */

struct mean_square {
    double square, pixels; /* sums over pictures, weighted by their pixels */
};

struct revealed_sums {
    struct mean_square revealed, things;
    size_t all;
    int pictures;
    bool *is_thing; /* of each true id of the edited scene; NULL: not known; owned */
    uint32_t ids;
};

/* Which true ids are furniture: of a described scene. */
static enum status find_things(struct revealed_sums *s, const struct evaluation *e, const char *where, struct err *err)
{
    char faces[FILE_PATH], scene[FILE_PATH], folder[80];
    struct true_faces list = {0};
    struct measured_plan plan = {0};
    snprintf(folder, sizeof folder, "%s/", where);
    if (file_path(faces, e->truth_folder, folder, "faces.txt", err) ||
        file_path(scene, e->truth_folder, folder, "scene.txt", err))
        return err->status;
    if (!path_is_file(faces) || !path_is_file(scene)) return ST_OK;
    if (!true_faces_read(&list, faces, err) && !wall_plan_read(&plan, scene, PLAN_FROM_SCENE, err)) {
        s->ids = (uint32_t)list.count + 1;
        if (!(s->is_thing = calloc(s->ids, sizeof *s->is_thing))) err_nomem(err, "true faces", s->ids);
        for (int i = 0; s->is_thing && i < list.count; i++)
            s->is_thing[i + 1] = list.faces[i].name && wall_plan_has(&plan.furniture, list.faces[i].name);
    }
    wall_plan_release(&plan);
    true_faces_release(&list);
    return err->status;
}

static void add_pixels(struct mean_square *m, double *psnr, size_t pixels, const struct radiance_pixels *p,
                       const uint32_t *ids)
{
    *psnr = NAN;
    if (!pixels || !revealed_psnr(psnr, p, ids)) return;
    m->square += (double)pixels * pow(10, -*psnr / 10);
    m->pixels += (double)pixels;
}

/* Leaves the revealed pixels whose true surface is furniture; returns their number. */
static size_t keep_things(uint8_t *mask, const struct revealed_sums *s, const uint32_t *ids, size_t pixels)
{
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        mask[i] = mask[i] && s->is_thing && ids[i] < s->ids && s->is_thing[ids[i]];
        count += mask[i];
    }
    return count;
}

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
        add_pixels(&s->revealed, &psnr, revealed, &p, planes.ids[1]);
        if (revealed >= MIN_REVEALED && isfinite(psnr))
            evaluation_metric(e, r->name, list->set->prefix, "revealed_psnr", psnr, err);
        add_pixels(&s->things, &psnr, keep_things(mask, s, planes.ids[1], pixels), &p, planes.ids[1]);
    }
    free(mask);
    true_planes_release(&planes);
    image_release(&truth);
    linear_picture_release(&r->picture);
    return err->status;
}

static enum status add_metrics(struct evaluation *e, const char *prefix, const char *share, const char *psnr,
                               const struct mean_square *m, size_t all, struct err *err)
{
    if (evaluation_metric(e, NULL, prefix, share, 100 * m->pixels / (double)all, err) || !(m->pixels > 0))
        return err->status;
    return evaluation_metric(e, NULL, prefix, psnr, -10 * log10(m->square / m->pixels), err);
}

static enum status measure_edit(struct evaluation *e, const char *where, struct err *err)
{
    struct true_set set = {0};
    struct renders list = {0};
    struct revealed_sums s = {0};
    true_set_read(&set, e->truth_folder, where, e->prov, err);
    if (!err->status && set.count) renders_find(&list, e, &set, err);
    if (!err->status && list.count) renders_scale(e, &list, err);
    if (!err->status && list.count) find_things(&s, e, where, err);
    for (int i = 0; !err->status && e->white > 0 && i < list.count; i++) measure(e, &list, &list.list[i], &s, err);
    if (!err->status && s.all) add_metrics(e, set.prefix, "revealed", "revealed_psnr", &s.revealed, s.all, err);
    if (!err->status && s.all && s.is_thing)
        add_metrics(e, set.prefix, "revealed_things", "revealed_things_psnr", &s.things, s.all, err);
    free(s.is_thing);
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
