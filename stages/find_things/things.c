/* things.c - from depth to things; see things.h.
 *
 * Overview. All views are fused into one volume (fuse_views.c). Its connected surfaces that stand before the model are
 * the things; marks of a user name, join and split them (components.c). Each thing then grows by a margin, since depth
 * at outlines is off, and the pixels of the views get the things that their points lie in (thing_views.c).
 *
 * Source: volumetric fusion [Curless 1996]; the rest is new. */
#include "stages/find_things/things.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/progress.h"
#include "common/capture/view_image.h"
#include "common/product/product.h"
#include "stages/find_things/components.h"
#include "stages/find_things/contact_sheet.h"
#include "stages/find_things/flat_marks.h"
#include "stages/find_things/flat_things.h"
#include "stages/find_things/legs.h"
#include "stages/find_things/support.h"
#include "stages/find_things/thing_views.h"
#include "stages/find_things/things_plan.h"

#define SUPPORT_REACH 0.04 /* of the model's height */
#define MARK_SLACK    3    /* voxels beside a surface at which a mark still finds it */
#define FLAT_SLACK    0.5  /* voxels: what is so near to a face lies on it */

enum { SURFACE_STEPS = 3 }; /* voxels beside those of a surface in which the distance from it is kept */

struct finder {
    const struct things_job *job;
    double height; /* of the model, model units */
    struct thing_volume volume;
    struct surface_voxel *surface; /* of all things; owned */
    size_t surface_count;
    struct surface_voxel *legs; /* those of them that are legs without depth; owned */
    size_t leg_count;
    struct flat_things flats;   /* the last of the things */
    struct thing *things;       /* being described; owned */
    struct thing_sight *sights; /* owned */
    struct sheet_tile *tiles;   /* owned */
    int count;
    bool *is_pane; /* of each id of a face; owned */
};

/* ------------------------------------------------------------------------------------------------------------- grid */

static enum status choose_grid(struct voxel_grid *g, struct finder *f, struct err *err)
{
    struct vec3 low, high;
    model_rays_bounds(f->job->model, &low, &high);
    const double sides[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
    double voxels = 1;
    f->height = sides[2];
    if (!(f->height > 0)) return err_set(err, ST_DATA, "the model has no height, so it can hold no things.");
    g->voxel = f->job->params->voxel * f->height;
    for (int k = 0; k < 3; k++) voxels *= ceil(sides[k] / g->voxel);
    const double most = 1e6 * f->job->params->max_voxels;
    if (voxels > most) {
        const double larger = cbrt(voxels / most);
        log_warn("voxels are %.2f times as large as asked for, because there would be %.0f million; the most are %d "
                 "(max_voxels).",
                 larger, voxels / 1e6, f->job->params->max_voxels);
        g->voxel *= larger;
    }
    for (int k = 0; k < 3; k++) g->size[k] = (int)ceil(sides[k] / g->voxel);
    g->origin = low;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ views */

struct view_data {
    struct view camera; /* model frame */
    struct layered_depth depth;
    struct view_ids ids;
};

static enum status view_data_read(struct view_data *d, const struct things_job *job, int i, struct err *err)
{
    const struct view *view = &job->in->set.views[i];
    const struct product_key key = {.view = view->name};
    char path[FILE_PATH];
    *d = (struct view_data){.camera = model_from_world_view(&job->in->axes, view)};
    if (!product_path_in(path, job->depth, PRODUCT_DEPTH, &key, err) &&
        !layered_depth_read_interior(&d->depth, path, job->prov, err) &&
        !product_path_in(path, job->ids, PRODUCT_IDS, &key, err))
        view_ids_read(&d->ids, view, path, job->prov, err);
    return err->status;
}

static void view_data_release(struct view_data *d)
{
    layered_depth_release(&d->depth);
    view_ids_release(&d->ids);
}

static enum status find_panes(struct finder *f, struct err *err)
{
    const struct model_rays *m = f->job->model;
    if (!(f->is_pane = calloc((size_t)m->ids + 1, sizeof *f->is_pane)))
        return err_nomem(err, "panes of glass", (size_t)m->ids);
    for (int k = 0; k < m->mesh.face_count; k++)
        f->is_pane[solid_face_id(&m->mesh, k)] |= solid_face_is_pane(&m->mesh, k);
    return ST_OK;
}

static enum status fuse_all(struct fused_volume *fused, const struct finder *f, struct err *err)
{
    const struct things_job *job = f->job;
    struct progress progress;
    progress_start(&progress, "fusing", job->in->set.view_count, "views");
    for (int i = 0; !err->status && i < job->in->set.view_count; i++) {
        struct view_data d;
        if (!view_data_read(&d, job, i, err)) {
            const struct fused_view view = {d.camera,   &d.depth,        &d.ids,
                                            f->is_pane, job->model->ids, job->in->axes.scale};
            fuse_volume_add(fused, &view, err);
        }
        view_data_release(&d);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ marks */

/* The first voxel of a surface that a mark's ray meets, or passes within MARK_SLACK voxels; -1: none. */
static int64_t meet_surface(const struct thing_volume *grown, const struct thing_volume *surfaces,
                            const struct things_job *job, const struct thing_mark *mark)
{
    const struct voxel_grid *g = &grown->grid;
    const struct vec3 from = model_from_world_point(&job->in->axes, mark->origin),
                      direction = model_from_world_direction(&job->in->axes, mark->direction);
    const double step = 0.5 * g->voxel, far = g->voxel * (g->size[0] + g->size[1] + g->size[2]);
    uint32_t met = 0;
    int64_t nearest = -1;
    double least = INFINITY;
    for (double t = 0; t < far; t += step) {
        const struct vec3 p = vec3_add(from, vec3_scale(direction, t));
        const uint32_t id = thing_volume_at(grown, p);
        if (met && id != met) break;
        if (!id) continue;
        met = id;
        for (int dz = -MARK_SLACK; dz <= MARK_SLACK; dz++)
            for (int dy = -MARK_SLACK; dy <= MARK_SLACK; dy++)
                for (int dx = -MARK_SLACK; dx <= MARK_SLACK; dx++) {
                    const int64_t at = thing_voxel_at(g, vec3_add(p, vec3_scale(vec3_make(dx, dy, dz), g->voxel)));
                    const double away = dx * dx + dy * dy + dz * dz;
                    if (at < 0 || surfaces->id[at] != id || !(away < least)) continue;
                    least = away;
                    nearest = at;
                }
    }
    return nearest;
}

/* Finds the surfaces that the marks are on, and lets these name, join and split the things. */
static enum status apply_marks(uint32_t *named, struct finder *f, struct err *err)
{
    const struct thing_marks *marks = f->job->marks;
    const size_t voxels = voxel_count(&f->volume.grid);
    struct thing_volume grown = {f->volume.grid, malloc(voxels * sizeof *grown.id), NULL};
    struct thing_seed *seeds = calloc((size_t)marks->mark_count + 1, sizeof *seeds);
    if (!grown.id || !seeds) err_nomem(err, "a volume of voxels", voxels * sizeof *grown.id);
    if (!err->status) {
        memcpy(grown.id, f->volume.id, voxels * sizeof *grown.id);
        components_grow(grown.id, &grown.grid, MARK_SLACK, err);
    }
    for (int k = 0; k < marks->mark_count && seeds; k++) seeds[k] = (struct thing_seed){marks->marks[k].name, -1};
    for (int k = 0; !err->status && k < marks->mark_count; k++) {
        const struct thing_mark *m = &marks->marks[k];
        if (marks->flat[m->name]) continue;
        seeds[k] = (struct thing_seed){m->name, meet_surface(&grown, &f->volume, f->job, m)};
        if (seeds[k].at < 0)
            log_warn("things.txt:%d: nothing stands before the model at %.6g %.6g of %s, so this mark of %s is left "
                     "out; make things shows what was found.",
                     m->line, m->u, m->v, m->view, marks->names[m->name]);
    }
    if (!err->status)
        components_mark(f->volume.id, &f->count, &f->volume.grid, seeds, marks->mark_count, named, marks->name_count,
                        err);
    for (int n = 0; !err->status && n < marks->name_count; n++) {
        bool met = false;
        for (int k = 0; k < marks->mark_count; k++) met |= seeds[k].name == n && seeds[k].at >= 0;
        if (met && !named[n])
            log_warn("things.txt:%d: all marks of %s are where another thing is marked, so it is left out.",
                     marks->lines[n], marks->names[n]);
    }
    free(seeds);
    free(grown.id);
    return err->status;
}

static bool is_named(const struct thing_marks *marks, const char *name)
{
    for (int k = 0; k < marks->name_count; k++)
        if (!strcmp(marks->names[k], name)) return true;
    return false;
}

/* Names the things: as users did, the others by numbers that no user took. */
static enum status name_things(struct finder *f, const uint32_t *named, struct err *err)
{
    const struct thing_marks *marks = f->job->marks;
    char text[32];
    for (int k = 0; k < marks->name_count; k++)
        if (named[k] && !(f->things[named[k] - 1].name = strdup(marks->names[k])))
            return err_nomem(err, "a name", sizeof text);
    for (int k = 0, number = 0; k < f->count; k++) {
        if (f->things[k].name) continue;
        do snprintf(text, sizeof text, "thing%d", ++number);
        while (is_named(marks, text));
        if (!(f->things[k].name = strdup(text))) return err_nomem(err, "a name", sizeof text);
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------- legs */

/* The things that stand on the floor; returns their number. */
static int list_standing(struct legged *list, const struct finder *f)
{
    int count = 0;
    for (int k = 0; k < f->count; k++) {
        const struct thing *t = &f->things[k];
        const struct vec3 middle = vec3_scale(vec3_add(t->low, t->high), 0.5);
        const double below = support_below(f->job->model, middle);
        if (t->support != THING_ON_FLOOR || !isfinite(below)) continue;
        list[count++] = (struct legged){(uint32_t)k + 1, t->low, t->high, middle.z - below};
    }
    return count;
}

/* Shows all views to the search for legs; learn: they teach it the floor. */
static enum status show_views(struct legs *l, const struct finder *f, bool learn, struct err *err)
{
    const struct things_job *job = f->job;
    for (int i = 0; !err->status && i < job->in->set.view_count; i++) {
        struct view_data d;
        struct image photo = {0};
        if (!view_data_read(&d, job, i, err) &&
            !view_image_read(&photo, job->views, &job->in->set.views[i], job->prov, err)) {
            const struct legs_view view = {d.camera, &d.depth, &d.ids, &photo, job->in->axes.scale};
            if (learn)
                legs_learn_floor(l, &view);
            else
                legs_look(l, &view);
        }
        view_data_release(&d);
        image_release(&photo);
    }
    return err->status;
}

static enum status keep_legs(struct finder *f, const int64_t *voxels, size_t count, struct err *err)
{
    if (!(f->legs = malloc((count + 1) * sizeof *f->legs))) return err_nomem(err, "legs", count * sizeof *f->legs);
    for (size_t i = 0; i < count; i++)
        f->legs[i] = (struct surface_voxel){thing_voxel_centre(&f->volume.grid, voxels[i]), f->volume.id[voxels[i]]};
    f->leg_count = count;
    for (int k = 0; k < f->count; k++) f->things[k].voxels = 0; /* boxes are measured again */
    things_measure(f->things, f->count, &f->volume, f->job->model, SUPPORT_REACH * f->height);
    return ST_OK;
}

/* Adds the legs of standing things to their surfaces. */
static enum status add_legs(struct finder *f, struct err *err)
{
    struct legs legs = {0};
    struct legged *list = malloc(((size_t)f->count + 1) * sizeof *list);
    int64_t *voxels = NULL;
    size_t count;
    if (!list) return err_nomem(err, "things on legs", (size_t)f->count * sizeof *list);
    if (!legs_init(&legs, &f->volume, list, list_standing(list, f), err) && legs.count &&
        !show_views(&legs, f, true, err)) {
        legs_settle(&legs);
        if (!show_views(&legs, f, false, err) && !legs_take(&voxels, &count, &legs, &f->volume, err))
            keep_legs(f, voxels, count, err);
    }
    legs_release(&legs);
    free(voxels);
    free(list);
    return err->status;
}

static enum status list_surface(struct finder *f, struct err *err)
{
    const size_t voxels = voxel_count(&f->volume.grid);
    size_t count = 0;
    for (size_t i = 0; i < voxels; i++) count += f->volume.id[i] != 0;
    if (!(f->surface = malloc((count + 1) * sizeof *f->surface)))
        return err_nomem(err, "the surfaces of things", count * sizeof *f->surface);
    for (size_t i = 0; i < voxels; i++)
        if (f->volume.id[i])
            f->surface[f->surface_count++] =
                (struct surface_voxel){thing_voxel_centre(&f->volume.grid, (int64_t)i), f->volume.id[i]};
    return ST_OK;
}

/* Distances behind the model's own surfaces do not count; known: where there are such, and where things are. */
static void leave_model(uint8_t *known, struct thing_volume *v)
{
    for (size_t i = 0; i < voxel_count(&v->grid); i++) {
        known[i] = v->id[i] || v->distance[i] <= 0;
        if (!v->id[i] && v->distance[i] <= 0) v->distance[i] = THING_UNSEEN;
    }
}

/* Fills the columns below things that stand on the floor. What no view looks through is solid there, as in a visual
 * hull: the end of a bed that no view shows, legs in the dark. The floor that views show below a table is none of it.
 * */
static enum status stand(struct finder *f, const uint8_t *known, struct err *err)
{
    struct thing_volume *v = &f->volume;
    const size_t voxels = voxel_count(&v->grid), slice = (size_t)v->grid.size[0] * (size_t)v->grid.size[1];
    int *lowest = malloc(((size_t)f->count + 1) * sizeof *lowest);
    if (!lowest) err_nomem(err, "things", voxels);
    for (int k = 0; !err->status && k < f->count; k++) {
        const struct thing *t = &f->things[k];
        const struct vec3 middle = vec3_scale(vec3_add(t->low, t->high), 0.5);
        const double below = support_below(f->job->model, middle);
        const bool stands = t->support == THING_ON_FLOOR && isfinite(below);
        lowest[k + 1] = stands ? (int)fmax(0, floor((middle.z - below - v->grid.origin.z) / v->grid.voxel)) : -1;
    }
    if (!err->status) components_stand(v->id, &v->grid, lowest);
    for (size_t i = voxels; !err->status && i-- > 0;) {
        const uint32_t id = v->id[i];
        if (!id || v->distance[i] != THING_UNSEEN) continue;
        const size_t above = i + slice; /* it is done already; what grew below a surface is solid, too */
        const bool goes_on = above < voxels && v->id[above] == id && v->distance[above] <= 0;
        if (!known[i] || (goes_on && lowest[id] >= 0 && (int)(i / slice) >= lowest[id])) v->distance[i] = -1;
    }
    free(lowest);
    return err->status;
}

/* What is around a surface, and below one that stands on the floor, belongs to the thing. */
static enum status grow(struct finder *f, struct err *err)
{
    struct thing_volume *v = &f->volume;
    const int margin = (int)ceil(f->job->params->margin * f->height / v->grid.voxel);
    if (components_grow(v->id, &v->grid, SURFACE_STEPS, err)) return err->status;
    uint8_t *known = malloc(voxel_count(&v->grid) + 1);
    if (!known) return err_nomem(err, "things", voxel_count(&v->grid));
    leave_model(known, v);
    stand(f, known, err);
    free(known);
    if (err->status) return err->status;
    return components_grow(v->id, &v->grid, margin > SURFACE_STEPS ? margin - SURFACE_STEPS : 1, err);
}

/* Adds what lies flat on faces, as the last of the things. */
static enum status add_flats(struct finder *f, struct err *err)
{
    for (int i = 0; !err->status && i < f->flats.count; i++) {
        struct thing *t = &f->things[f->count];
        f->flats.list[i].id = (uint32_t)++f->count;
        if (!(t->name = strdup(f->job->marks->names[f->flats.list[i].name]))) err_nomem(err, "a name", 1);
    }
    flat_things_fill(&f->flats, &f->volume);
    for (int i = 0; !err->status && i < f->flats.count; i++)
        flat_thing_measure(&f->things[f->flats.list[i].id - 1], &f->flats.list[i], &f->volume, err);
    return err->status;
}

static enum status place_flats(struct finder *f, struct err *err)
{
    const struct things_job *job = f->job;
    const double slack = FLAT_SLACK * f->volume.grid.voxel;
    const struct flat_pictures pictures = {job->views, job->ids, job->in, job->model, job->prov};
    struct thing_marks all = {0};
    if (!flat_marks_complete(&all, job->marks, &pictures, slack, err))
        flat_things_place(&f->flats, &all, &job->in->axes, job->model, slack, err);
    flat_marks_release(&all);
    return err->status;
}

static enum status find_surfaces(struct finder *f, struct err *err)
{
    const struct thing_marks *marks = f->job->marks;
    struct fused_volume fused = {0};
    uint32_t *named = calloc((size_t)marks->name_count + 1, sizeof *named);
    if (!named) err_nomem(err, "names", (size_t)marks->name_count * sizeof *named);
    if (!err->status && !find_panes(f, err) && !choose_grid(&f->volume.grid, f, err) &&
        !fuse_volume_init(&fused, &f->volume.grid, err) && !fuse_all(&fused, f, err) &&
        !(f->volume.id = malloc(voxel_count(&f->volume.grid) * sizeof *f->volume.id)))
        err_nomem(err, "a volume of voxels", voxel_count(&f->volume.grid));
    if (!err->status)
        components_find(f->volume.id, &f->count, &fused, f->job->params, f->height, f->job->in->set.view_count, err);
    for (size_t i = 0; !err->status && i < voxel_count(&f->volume.grid); i++) /* takes the place of the sum */
        fused.sum[i] = fused.weight[i] > 0 ? fused.sum[i] / fused.weight[i] : THING_UNSEEN;
    if (!err->status) {
        f->volume.distance = fused.sum;
        fused.sum = NULL;
    }
    fuse_volume_release(&fused);
    if (!err->status && !apply_marks(named, f, err) && !place_flats(f, err)) {
        const size_t n = (size_t)f->count + (size_t)f->flats.count + 1;
        f->things = calloc(n, sizeof *f->things);
        f->sights = calloc(n, sizeof *f->sights);
        f->tiles = calloc(n, sizeof *f->tiles);
        if (!f->things || !f->sights || !f->tiles) err_nomem(err, "things", n * sizeof *f->things);
    }
    if (!err->status && !name_things(f, named, err)) {
        things_measure(f->things, f->count, &f->volume, f->job->model, SUPPORT_REACH * f->height);
        if (!add_legs(f, err) && !list_surface(f, err) && !grow(f, err)) add_flats(f, err);
    }
    free(named);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------ descriptions
 * */

static enum status see_view(struct finder *f, int i, struct err *err)
{
    const struct things_job *job = f->job;
    const struct view *view = &job->in->set.views[i];
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct view_data d = {0};
    struct thing_mask mask = {0};
    struct image photo = {0};
    char path[FILE_PATH];
    float *nearest = malloc((pixels + 1) * sizeof *nearest);
    if (!nearest) err_nomem(err, "the depth of a view", pixels * sizeof *nearest);
    if (!err->status && !thing_mask_init(&mask, view, err) && !view_data_read(&d, job, i, err) &&
        !thing_shows_find(mask.shows, &f->volume, &d.camera, &d.depth, &d.ids, job->in->axes.scale, err)) {
        const double voxel = f->volume.grid.voxel, scale = job->in->axes.scale;
        const struct thing_geometry geometry = {&f->volume, &d.camera, d.depth.interior.z, scale};
        thing_meets_find(mask.meets, f->legs, f->leg_count, voxel, &d.camera, &d.ids, scale, nearest);
        for (size_t p = 0; p < pixels; p++) /* a leg's own depth is that of the floor */
            if (!mask.shows[p] && mask.meets[p] && scale * (double)d.depth.interior.z[p] > (double)nearest[p] - voxel)
                mask.shows[p] = mask.meets[p];
        thing_meets_find(mask.meets, f->surface, f->surface_count, voxel, &d.camera, &d.ids, scale, nearest);
        flat_things_see(&mask, &f->flats, &d.camera, &d.ids, d.depth.interior.z, FLAT_SLACK * voxel, scale);
        if (!product_path_in(path, job->out, PRODUCT_THING_MASK, &(struct product_key){.view = view->name}, err) &&
            !thing_mask_write(&mask, view, path, job->prov, err))
            thing_sights_add(f->sights, f->count, mask.shows, view, i, err);
        if (!err->status && !view_image_read(&photo, job->views, view, job->prov, err))
            thing_sights_add_radiance(f->sights, mask.shows, &photo, &geometry);
    }
    view_data_release(&d);
    thing_mask_release(&mask);
    image_release(&photo);
    free(nearest);
    return err->status;
}

/* Cuts the pictures of the things that view i shows best. */
static enum status cut_tiles(struct finder *f, int i, struct err *err)
{
    const struct things_job *job = f->job;
    const struct view *view = &job->in->set.views[i];
    struct image photo = {0};
    struct thing_mask mask = {0};
    char path[FILE_PATH];
    for (int k = 0; !err->status && k < f->count; k++) {
        if (!(f->sights[k].score > 0) || f->sights[k].best != i) continue;
        if (!mask.shows &&
            !product_path_in(path, job->out, PRODUCT_THING_MASK, &(struct product_key){.view = view->name}, err) &&
            !thing_mask_read(&mask, view, path, (uint32_t)f->count, NULL, err))
            view_image_read(&photo, job->views, view, job->prov, err);
        if (!err->status) sheet_tile_make(&f->tiles[k], &photo, mask.shows, (uint32_t)k + 1, f->things[k].rect, err);
    }
    image_release(&photo);
    thing_mask_release(&mask);
    return err->status;
}

/* Gives each thing the view that shows it best. */
static enum status describe(struct finder *f, struct err *err)
{
    const struct camera_set *set = &f->job->in->set;
    for (int i = 0; !err->status && i < set->view_count; i++) see_view(f, i, err);
    for (int k = 0; !err->status && k < f->count; k++) {
        const struct thing_sight *s = &f->sights[k];
        struct thing *t = &f->things[k];
        t->views = s->views;
        thing_sight_radiance(t, s);
        if (!(t->view = strdup(s->score > 0 ? set->views[s->best].name : ""))) err_nomem(err, "a name", 1);
        for (int e = 0; e < 2; e++) {
            t->rect[e] = s->low[e];
            t->rect[e + 2] = s->score > 0 ? s->high[e] + 1 : 0;
        }
    }
    for (int i = 0; !err->status && i < set->view_count; i++) cut_tiles(f, i, err);
    return err->status;
}

static enum status write_all(struct finder *f, struct err *err)
{
    const struct things_job *job = f->job;
    const char *unit = job->in->axes.metric ? "m" : "";
    struct thing_list list = {.things = f->things, .count = f->count};
    char path[FILE_PATH];
    if (!product_path_in(path, job->out, PRODUCT_THING_VOLUME, NULL, err) &&
        !thing_volume_write(&f->volume, path, job->prov, err) &&
        !product_path_in(path, job->out, PRODUCT_THING_SHEET, NULL, err) &&
        !contact_sheet_write(&list, f->tiles, unit, path, err) &&
        !product_path_in(path, job->out, PRODUCT_THING_PLAN, NULL, err) &&
        !things_plan_write(&list, &job->in->plan, path, err) &&
        !product_path_in(path, job->out, PRODUCT_THINGS, NULL, err))
        thing_list_write(&list, path, job->prov, err);
    for (int k = 0; !err->status && k < f->count; k++) {
        const struct thing *t = &f->things[k];
        log_note("%s: %.2f x %.2f x %.2f%s%s at %.2f %.2f, support %s, in %d views, best in %s", t->name,
                 t->high.x - t->low.x, t->high.y - t->low.y, t->high.z - t->low.z, *unit ? " " : "", unit,
                 0.5 * (t->low.x + t->high.x), 0.5 * (t->low.y + t->high.y), thing_support_word(t->support), t->views,
                 t->view);
    }
    return err->status;
}

enum status things_find(const struct things_job *job, struct err *err)
{
    struct finder f = {.job = job};
    if (!find_surfaces(&f, err) && !describe(&f, err)) write_all(&f, err);
    for (int k = 0; k < f.count; k++) {
        if (f.tiles) sheet_tile_release(&f.tiles[k]);
        if (f.things) free(f.things[k].name);
        if (f.things) free(f.things[k].view);
        if (f.things) flat_outline_release(&f.things[k].outline);
    }
    free(f.things);
    free(f.sights);
    free(f.tiles);
    free(f.is_pane);
    free(f.surface);
    free(f.legs);
    flat_things_release(&f.flats);
    thing_volume_release(&f.volume);
    return err->status;
}
