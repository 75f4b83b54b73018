/* bake_viewpoint.c - the atlas of textures as they look from the place of one photo [Colburn 2014, 4.5].
 *
 * Overview.
 *   1. The viewpoint's own views say which faces it sees, and how large: tiles and their texels follow
 *      (view_tiles.c), those that an edit would reveal among them
 *   2. sources_choose() picks the other views that show these faces
 *   3. each source is read, its pixels become candidates of the texels that it shows, and it is released again
 *   4. gains bring the sources to one exposure, each texel gets its best candidate, and a composite in the gradient
 *      domain removes seams (bake_atlas.h)
 *   5. pages are written, then the list of make dependencies, and atlas.txt last
 *
 * A texel that an own view shows keeps that view's colour. With [bake_vdta] own_photo = withheld, own views are
 * treated as if they showed nothing: the atlas then predicts the photo from the others, which `evaluate` compares
 * with it.
 *
 * `white`, the radiance at which errors of colour are measured, is the 90th percentile of every seventh own pixel.
 *
 * Views of one photo share an exposure, so they form one group, named by its first view.
 *
 * Memory: the texels of one viewpoint with their candidates, and one source at a time: it does not grow with the
 * number of views. Time is linear in the pixels of the sources; bake_estimate.c has measured constants. */
#include "stages/bake_vdta/bake_viewpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/make_deps.h"
#include "common/base/progress.h"
#include "common/capture/photo_camera.h"
#include "common/capture/photo_quality.h"
#include "common/image/luminance.h"
#include "common/product/product.h"
#include "stages/bake_vdta/sources.h"
#include "stages/bake_vdta/view_tiles.h"

enum { MAX_OWN = 16 };                 /* views of one photo */
enum { SAMPLE = 7 };                   /* every SAMPLE-th pixel counts for the level of white */
static const double WHITE_SHARE = 0.9; /* of the viewpoint's pixels are below white */

struct work {
    struct bake_scene *scene;
    const char *photo, *deps;
    struct provenance *prov;
    int own[MAX_OWN]; /* views of the photo, in order of name */
    int own_count;
    int *views; /* that are sources, own ones among them, in order of name */
    int view_count;
    struct bake bake;
};

static enum status find_own_views(struct work *w, struct err *err)
{
    const struct bake_scene *s = w->scene;
    for (int i = 0; i < s->in.set.view_count; i++) {
        const struct lens *lens = photo_lens_of_view(&s->in.set, &s->in.lenses, i);
        if (!lens || strcmp(lens->photo, w->photo)) continue;
        if (w->own_count == MAX_OWN)
            return err_set(err, ST_DATA, "photo %s has more than %d views.", w->photo, MAX_OWN);
        w->own[w->own_count++] = i;
    }
    if (w->own_count) return ST_OK;
    return err_set(err, ST_USAGE,
                   "there is no photo %s in %s/lenses.txt, where the second word of each line is a photo.", w->photo,
                   s->from.views);
}

static int compare_floats(const void *a, const void *b)
{
    const float p = *(const float *)a, q = *(const float *)b;
    return p < q ? -1 : p > q;
}

/* Adds luminances of a view's pixels to a list. */
static enum status add_levels(float **levels, size_t *count, size_t *room, const struct source_view *v, struct err *err)
{
    const size_t pixels = (size_t)v->camera.width * (size_t)v->camera.height;
    if (array_reserve(levels, room, *count + pixels / SAMPLE + 1, sizeof **levels, "pixels", err)) return err->status;
    for (size_t i = 0; i < pixels; i += SAMPLE) {
        const float *p = v->levels[0].rgba + 4 * i;
        if (p[3] > 0) (*levels)[(*count)++] = luminance_of(p);
    }
    return ST_OK;
}

/* The radiance below which WHITE_SHARE of the viewpoint's pixels lie; 1 if all are black. */
static double white_of(float *levels, size_t count)
{
    if (!count) return 1;
    qsort(levels, count, sizeof *levels, compare_floats);
    const double white = levels[(size_t)(WHITE_SHARE * (double)(count - 1))];
    return white > 0 ? white : 1;
}

static bool is_withheld(const struct bake_scene *s) { return !strcmp(s->params->own_photo, "withheld"); }

static bool is_own(const struct work *w, int view)
{
    for (int k = 0; k < w->own_count; k++)
        if (w->own[k] == view) return true;
    return false;
}

/* The tiles of all own views, and the level of white. */
static enum status add_tiles(struct work *w, struct err *err)
{
    const struct bake_scene *s = w->scene;
    float *levels = NULL;
    size_t count = 0, room = 0;
    for (int k = 0; !err->status && k < w->own_count; k++) {
        struct own_view own = {0};
        const struct view *camera = &s->in.set.views[w->own[k]];
        if (!own_view_read(&own, &s->from, s->reveal, camera, s->in.axes.scale, &s->params->texture, w->prov, err))
            add_levels(&levels, &count, &room, &own.view, err);
        if (!err->status && is_withheld(s))
            memset(own.view.own, SOURCE_NONE, (size_t)camera->width * (size_t)camera->height);
        if (!err->status) view_tiles_add(&w->bake, &own, k, !strcmp(s->params->reveal, "all"), err);
        own_view_release(&own);
    }
    w->bake.white = white_of(levels, count);
    free(levels);
    return err->status;
}

/* Sources, and own texels made from them. */
static enum status set_sources(struct work *w, struct err *err)
{
    const struct bake_scene *s = w->scene;
    const size_t n = (size_t)w->view_count;
    const char **names = malloc(n * sizeof *names);
    int *groups = malloc(n * sizeof *groups);
    bool *own = calloc(n, sizeof *own);
    uint32_t made[MAX_OWN] = {0};
    if (!names || !groups || !own) err_nomem(err, "sources", n * sizeof *names);
    for (int i = 0; !err->status && i < w->view_count; i++) {
        names[i] = s->in.set.views[w->views[i]].name;
        groups[i] = photo_of_view(&s->in.set, &s->in.lenses, w->views[i]);
        for (int k = 0; k < w->own_count; k++)
            if (w->own[k] == w->views[i]) own[i] = true, made[k] = (uint32_t)i, w->bake.own_group = groups[i];
    }
    if (!err->status) bake_set_sources(&w->bake, names, groups, own, w->view_count, err);
    for (size_t i = 0; !err->status && i < w->bake.texel_count; i++)
        if (w->bake.made[i] >= ATLAS_VIEWS) w->bake.made[i] = ATLAS_VIEWS + made[w->bake.made[i] - ATLAS_VIEWS];
    free(names);
    free(groups);
    free(own);
    return err->status;
}

static enum status read_sources(struct work *w, uint64_t *bytes, struct err *err)
{
    const struct bake_scene *s = w->scene;
    struct progress progress;
    progress_start(&progress, w->photo, w->view_count, "views");
    for (int i = 0; !err->status && i < w->view_count; i++) {
        struct source_view view = {0};
        source_view_read(&view, NULL, &s->from, &s->in.set.views[w->views[i]], &s->params->texture, w->prov, err);
        if (!err->status && !(is_withheld(s) && is_own(w, w->views[i]))) bake_add_view(&w->bake, &view, i);
        *bytes += view.bytes;
        source_view_release(&view);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    return err->status;
}

/* What atlas.txt says beside tiles and pages. */
static enum status describe(struct atlas *a, const struct work *w, struct err *err)
{
    const struct bake_scene *s = w->scene;
    a->views = calloc(MAX_OWN, sizeof *a->views);
    a->sources = calloc((size_t)w->view_count, sizeof *a->sources);
    a->viewpoint = strdup(w->photo);
    if (!a->views || !a->sources || !a->viewpoint) return err_nomem(err, "names", (size_t)w->view_count);
    a->centre = w->bake.centre;
    for (; a->view_count < w->own_count; a->view_count++)
        if (!(a->views[a->view_count] = strdup(s->in.set.views[w->own[a->view_count]].name)))
            return err_nomem(err, "a name", 1);
    for (; a->source_count < w->view_count; a->source_count++)
        if (!(a->sources[a->source_count] = strdup(s->in.set.views[w->views[a->source_count]].name)))
            return err_nomem(err, "a name", 1);
    return ST_OK;
}

/* The views that were read, for make. */
static enum status write_deps(const struct work *w, const char *folder, struct err *err)
{
    const struct bake_scene *s = w->scene;
    const size_t n = (size_t)w->view_count;
    enum { FILES = 3 }; /* of a view */
    const size_t count = (s->from.things ? FILES : FILES - 1) * n;
    char(*paths)[FILE_PATH] = malloc((count + 1) * sizeof *paths);
    const char **files = malloc((count + 1) * sizeof *files);
    if (paths && files)
        product_path_in(paths[count], folder, PRODUCT_ATLAS, NULL, err);
    else
        err_nomem(err, "file names", count * sizeof *paths);
    for (size_t i = 0; !err->status && i < n; i++) {
        const struct product_key key = {.view = s->in.set.views[w->views[i]].name};
        if (!product_path_in(paths[2 * i], s->from.views, PRODUCT_VIEW, &key, err) &&
            !product_path_in(paths[2 * i + 1], s->from.ids, PRODUCT_IDS, &key, err) && s->from.things)
            product_path_in(paths[2 * n + i], s->from.things, PRODUCT_THING_MASK, &key, err);
    }
    for (size_t i = 0; !err->status && i < count; i++) files[i] = paths[i];
    if (!err->status) make_deps_write(w->deps, paths[count], files, (int)count, err);
    free(paths);
    free(files);
    return err->status;
}

static enum status write_all(struct work *w, uint64_t bytes, const struct bake_totals *t, struct err *err)
{
    char folder[FILE_PATH];
    struct atlas a = {0};
    size_t texels = 0;
    if (!file_path(folder, w->scene->out, w->photo, "", err) && !describe(&a, w, err))
        bake_write_pages(&a, &w->bake, NULL, folder, w->prov, &texels, err);
    if (!err->status && w->deps) write_deps(w, folder, err);
    if (!err->status) atlas_write_list(&a, folder, w->prov, err);
    atlas_release(&a);
    if (!err->status)
        log_note(
            "%s: %.2f million texels, %.1f %% original, %.1f %% warped, %.1f %% synthesised, %.1f %% of faces that "
            "no view shows; pages of %.2f million; %d views and %.1f MiB read; largest residual %.1e",
            w->photo, 1e-6 * (double)t->texels, 100.0 * (double)t->original / (double)(t->texels ? t->texels : 1),
            100.0 * (double)t->warped / (double)(t->texels ? t->texels : 1),
            100.0 * (double)t->synthesised / (double)(t->texels ? t->texels : 1),
            100.0 * (double)t->by_default / (double)(t->texels ? t->texels : 1), 1e-6 * (double)texels, w->view_count,
            (double)bytes / (1 << 20), t->residual);
    return err->status;
}

static enum status bake_work(struct work *w, struct err *err)
{
    struct bake_totals totals = {0};
    uint64_t bytes = 0;
    w->bake = (struct bake){.surfaces = &w->scene->surfaces, .params = &w->scene->params->texture, .has_centre = true};
    if (w->scene->fill) w->bake.filled = &w->scene->filled;
    if (!find_own_views(w, err)) w->bake.centre = w->scene->in.set.views[w->own[0]].center;
    if (!err->status && !add_tiles(w, err) &&
        !sources_choose(&w->views, &w->view_count, w->scene, w->own, w->own_count, &w->bake, w->prov, err) &&
        !set_sources(w, err) && !bake_list_texels(&w->bake, err) && !read_sources(w, &bytes, err) &&
        !bake_find_gains(&w->bake, err))
        bake_choose(&w->bake);
    if (!err->status && !bake_composite(&w->bake, &totals, err)) write_all(w, bytes, &totals, err);
    return err->status;
}

enum status viewpoint_bake(struct bake_scene *scene, const char *photo, const char *deps, struct provenance *prov,
                           struct err *err)
{
    struct work w = {.scene = scene, .photo = photo, .deps = deps, .prov = prov};
    const int shared = prov->count;
    bake_work(&w, err);
    /* the next viewpoint has other inputs */
    provenance_keep(prov, shared);
    filled_atlas_spare(&scene->filled);
    free(w.views);
    bake_release(&w.bake);
    return err->status;
}
