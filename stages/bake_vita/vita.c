/* vita.c - the atlas of textures without a viewpoint: every face once, from the views that show it best.
 *
 * Overview. Tiles are orthographic (ortho_tiles.c). The side of a texel is the height of the model over [bake_vita]
 * texels. Faces are baked in batches of consecutive surfaces, cut where their texels would exceed `batch` millions:
 * that bounds the memory, whatever the size of the model. A face that no view shows gets texels 16 times as wide, in
 * the default colour.
 *
 * Views of a batch. The index of faces lists the views of each, best first. The best view of every face is taken,
 * then the second best of every face, and so on, until a batch has 250 views: so no face of a large batch is left
 * without its best ones. A view that several batches need is read by each.
 *
 * A batch goes through the same steps as a viewpoint of bake_vdta: candidates, gains, the choice, the composite
 * (bake_atlas.h). This atlas belongs to no photo, so no texel is original. What no view shows is filled here for all
 * viewpoints (filled_atlas.h).
 *
 * Sources are listed before the first batch is baked, because pages name them by their number in the list of the
 * whole atlas.
 *
 * `white`, the radiance at which errors of colour are measured, is the 90th percentile of the first candidates of
 * every 17th texel of the batch. */
#include "stages/bake_vita/vita.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/progress.h"
#include "common/capture/photo_camera.h"
#include "common/capture/photo_quality.h"
#include "common/image/luminance.h"
#include "common/math/weighted.h"
#include "stages/bake_vita/ortho_tiles.h"

enum { UNSEEN = 16 }; /* times the side of a texel, for faces that no view shows */
enum { MAX_BATCH_VIEWS = 250 };
enum { SAMPLE = 17 };                  /* every SAMPLE-th texel counts for the level of white */
static const double WHITE_SHARE = 0.9; /* of the texels are below white */

struct work {
    const struct vita_scene *scene;
    struct provenance *prov;
    double side;
    struct atlas atlas;
    int *source_of_view; /* among the atlas's sources; -1: none yet */
    struct progress progress;
    struct bake_totals totals;
    size_t texels;
    uint64_t bytes;
};

/* ---------------------------------------------------------------------------------------------------- which views */

/* The best views of a face, at most max_sources. */
static int views_of(const struct vita_scene *s, int surface, const struct face_views **f)
{
    *f = &s->shown_by[surface];
    return (*f)->count < s->params->texture.max_sources ? (*f)->count : s->params->texture.max_sources;
}

static bool is_seen(const struct vita_scene *s, int surface)
{
    const struct face_views *f;
    return views_of(s, surface, &f) > 0;
}

/* Marks the views of a batch's faces: of each face the best first, until there are enough. */
static void choose_views(bool *taken, const struct vita_scene *s, int first, int last)
{
    int count = 0;
    memset(taken, 0, (size_t)s->in.set.view_count * sizeof *taken);
    for (int rank = 0; rank < s->params->texture.max_sources; rank++)
        for (int i = first; i < last; i++) {
            const struct face_views *f;
            if (rank >= views_of(s, i, &f)) continue;
            const int view = camera_set_find(&s->in.set, f->views[rank].name);
            if (view < 0 || taken[view] || count == MAX_BATCH_VIEWS) continue;
            taken[view] = true;
            count++;
        }
}

/* The atlas's sources: every view that any batch reads, in order of name. */
static enum status list_sources(struct work *w, const int *batches, int batch_count, bool *taken, struct err *err)
{
    const struct vita_scene *s = w->scene;
    for (int v = 0; v < s->in.set.view_count; v++) w->source_of_view[v] = -1;
    for (int i = 0; i < batch_count; i++) {
        choose_views(taken, s, batches[i], batches[i + 1]);
        for (int v = 0; v < s->in.set.view_count; v++)
            if (taken[v]) w->source_of_view[v] = 0;
    }
    for (int v = 0; v < s->in.set.view_count; v++) {
        if (w->source_of_view[v] < 0) continue;
        const int n = w->atlas.source_count;
        if (array_append(&w->atlas.sources, (size_t)n, sizeof *w->atlas.sources, "sources", err)) return err->status;
        if (!(w->atlas.sources[n] = strdup(s->in.set.views[v].name))) return err_nomem(err, "a name", 1);
        w->source_of_view[v] = w->atlas.source_count++;
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- one batch */

static enum status set_sources(struct bake *b, const struct vita_scene *s, const bool *taken, int *view_of,
                               struct err *err)
{
    const char *names[MAX_BATCH_VIEWS];
    int groups[MAX_BATCH_VIEWS], count = 0;
    bool own[MAX_BATCH_VIEWS] = {false};
    for (int v = 0; v < s->in.set.view_count; v++)
        if (taken[v]) {
            names[count] = s->in.set.views[v].name;
            groups[count] = photo_of_view(&s->in.set, &s->in.lenses, v);
            view_of[count++] = v;
        }
    b->own_group = -1;
    return bake_set_sources(b, names, groups, own, count, err);
}

static enum status read_views(struct work *w, struct bake *b, const int *view_of, struct err *err)
{
    const struct vita_scene *s = w->scene;
    for (int i = 0; !err->status && i < b->source_count; i++) {
        const struct view *camera = &s->in.set.views[view_of[i]];
        struct source_view view = {0};
        if (!source_view_read(&view, NULL, &s->from, camera, &s->params->texture, w->prov, err))
            bake_add_view(b, &view, i);
        w->bytes += view.bytes;
        source_view_release(&view);
        progress_add(&w->progress, 1);
    }
    return err->status;
}

/* The radiance below which WHITE_SHARE of the texels lie. */
static enum status find_white(struct bake *b, struct err *err)
{
    struct weighted *levels = malloc((b->list_count / SAMPLE + 1) * sizeof *levels);
    size_t count = 0;
    if (!levels) return err_nomem(err, "levels", b->list_count / SAMPLE * sizeof *levels);
    for (size_t i = 0; i < b->list_count; i += SAMPLE)
        if (b->counts[i]) levels[count++] = (struct weighted){luminance_of(b->lists[i][0].rgb), 1};
    b->white = weighted_percentile(levels, count, WHITE_SHARE);
    if (!(b->white > 0)) b->white = 1;
    free(levels);
    return ST_OK;
}

static void add_totals(struct bake_totals *sum, const struct bake_totals *t)
{
    sum->texels += t->texels;
    sum->warped += t->warped;
    sum->synthesised += t->synthesised;
    sum->by_default += t->by_default;
    sum->residual = fmax(sum->residual, t->residual);
}

static enum status bake_batch(struct work *w, int first, int last, bool *taken, struct err *err)
{
    const struct vita_scene *s = w->scene;
    struct bake b = {.surfaces = &s->surfaces, .params = &s->params->texture, .white = 1};
    struct bake_totals totals = {0};
    int view_of[MAX_BATCH_VIEWS], source_of[MAX_BATCH_VIEWS];
    for (int i = first; !err->status && i < last; i++)
        ortho_tiles_add(&b, i, is_seen(s, i) ? w->side : UNSEEN * w->side, err);
    choose_views(taken, s, first, last);
    if (!err->status && !set_sources(&b, s, taken, view_of, err) && !bake_list_texels(&b, err) &&
        !read_views(w, &b, view_of, err) && !find_white(&b, err) && !bake_find_gains(&b, err))
        bake_choose(&b);
    if (!err->status) bake_composite(&b, &totals, err);
    for (int i = 0; i < b.source_count; i++) source_of[i] = w->source_of_view[view_of[i]];
    if (!err->status && !bake_write_pages(&w->atlas, &b, source_of, s->out, w->prov, &w->texels, err))
        add_totals(&w->totals, &totals);
    bake_release(&b);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------- all batches */

/* batches[i] .. batches[i + 1] - 1 are the surfaces of batch i. */
static int cut_batches(int *batches, const struct work *w)
{
    const struct vita_scene *s = w->scene;
    const size_t limit = (size_t)(1e6 * s->params->batch);
    size_t texels = 0;
    int count = 0;
    batches[0] = 0;
    for (int i = 0; i < s->surfaces.count; i++) {
        const size_t more = ortho_texels(&s->surfaces, i, is_seen(s, i) ? w->side : UNSEEN * w->side);
        if (i > batches[count] && texels + more > limit) batches[++count] = i, texels = 0;
        texels += more;
    }
    if (s->surfaces.count) batches[++count] = s->surfaces.count;
    return count;
}

static int64_t count_views(const struct vita_scene *s, const int *batches, int count, bool *taken)
{
    int64_t n = 0;
    for (int i = 0; i < count; i++) {
        choose_views(taken, s, batches[i], batches[i + 1]);
        for (int v = 0; v < s->in.set.view_count; v++) n += taken[v];
    }
    return n;
}

/* The side of a texel: the height of the model over its texels. */
static double texel_side(const struct vita_scene *s)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < s->models[0].vertex_count; i++) {
        low = fmin(low, s->models[0].vertices[i].p.z);
        high = fmax(high, s->models[0].vertices[i].p.z);
    }
    return high > low ? (high - low) / s->params->texels : 1;
}

enum status vita_bake(const struct vita_scene *scene, struct provenance *prov, struct err *err)
{
    const size_t views = (size_t)scene->in.set.view_count;
    struct work w = {.scene = scene, .prov = prov, .side = texel_side(scene)};
    int *batches = malloc(((size_t)scene->surfaces.count + 2) * sizeof *batches);
    bool *taken = malloc((views + 1) * sizeof *taken);
    w.source_of_view = malloc((views + 1) * sizeof *w.source_of_view);
    if (!batches || !taken || !w.source_of_view) err_nomem(err, "views", views * sizeof(int));
    const int count = err->status ? 0 : cut_batches(batches, &w);
    if (!err->status && !list_sources(&w, batches, count, taken, err))
        progress_start(&w.progress, "textures", count_views(scene, batches, count, taken), "views");
    for (int i = 0; !err->status && i < count; i++) bake_batch(&w, batches[i], batches[i + 1], taken, err);
    if (!err->status) progress_end(&w.progress);
    if (!err->status && !atlas_write_list(&w.atlas, scene->out, prov, err)) {
        const double all = w.totals.texels ? (double)w.totals.texels : 1;
        log_note("%.2f million texels of %.3g, %.1f %% from views, %.1f %% synthesised, %.1f %% of faces that no view "
                 "shows; "
                 "pages of %.2f million; %.1f MiB of views read; largest residual %.1e",
                 1e-6 * all, w.side, 100 * (double)w.totals.warped / all, 100 * (double)w.totals.synthesised / all,
                 100 * (double)w.totals.by_default / all, 1e-6 * (double)w.texels, (double)w.bytes / (1 << 20),
                 w.totals.residual);
    }
    atlas_release(&w.atlas);
    free(w.source_of_view);
    free(batches);
    free(taken);
    return err->status;
}
