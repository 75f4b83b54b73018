/* other_light.c - see other_light.h.
 *
 * Overview. Such a photo has a camera like all others, but no part in the textures. A ray through its pixels meets the
 * model; the pixel's luminance over that of the texel there is the light in the photo's state over that of all other
 * photos, whatever the surface reflects, times the photo's exposure. A patch has the mean of its pixels and that of the
 * texels. Pixels count where the photo is neither white nor black, and where photographs show the texel; furniture is
 * left out, which may have moved. */
#include "stages/light_levels/other_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/capture/lens_list.h"
#include "common/capture/view_image.h"
#include "common/image/luminance.h"
#include "common/product/product.h"

enum { STEP = 2, FEWEST = 8, ROWS = 8 }; /* px between rays; pixels of a patch that counts */
static const float INSIDE = 0.999f, DARK = 1e-6f;

void other_light_release(struct other_light *o)
{
    free(o->photos);
    free(o->patches);
    free(o->light);
    free(o->weights);
    *o = (struct other_light){.count = 0};
}

/* ----------------------------------------------------------------------------------------------------------- pixels */

/* Sums of a patch: of the photo's luminance and of that of the texels. */
struct patch_sum {
    double photo, texels;
    int count;
};

struct looking {
    const struct level_light *light;
    const struct view *view; /* in the model's frame */
    struct view_planes planes;
    int *patch; /* of each ray; -1: none */
    float (*seen)[2];
};

static void look_at(const struct looking *l, int x, int y, int at)
{
    const struct light_patches *p = &l->light->patches;
    const struct model_field *f = p->field;
    const size_t i = (size_t)y * (size_t)l->view->width + (size_t)x;
    struct ray_hit hit;
    l->patch[at] = -1;
    if (!(l->planes.channel[VIEW_A][i] > INSIDE) || l->planes.channel[VIEW_CLIPPED][i] > 0) return;
    const struct vec3 ray = vec3_sub(view_unproject(l->view, x + 0.5, y + 0.5, 1), l->view->center);
    if (!ray_scene_hit(&f->model.rays, l->view->center, ray, &hit) || !hit.front ||
        (int)hit.id >= f->model.mesh.face_count)
        return;
    const struct field_texel texel = field_atlas_look(&f->atlas, solid_face_id(&f->model.mesh, (int)hit.id), hit.point);
    const float rgb[3] = {l->planes.channel[VIEW_R][i], l->planes.channel[VIEW_G][i], l->planes.channel[VIEW_B][i]};
    l->seen[at][0] = (float)luminance_precise(rgb);
    l->seen[at][1] = (float)rgb_luminance(texel.radiance);
    if (texel.source == LIGHT_TEXTURE && l->seen[at][0] > DARK && l->seen[at][1] > DARK)
        l->patch[at] = patches_hit(p, &hit);
}

static void look_along(void *ctx, size_t begin, size_t end, int thread)
{
    const struct looking *l = ctx;
    const int columns = l->view->width / STEP;
    (void)thread;
    for (size_t row = begin; row < end; row++)
        for (int column = 0; column < columns; column++)
            look_at(l, STEP * column + STEP / 2, STEP * (int)row + STEP / 2, (int)row * columns + column);
}

static enum status add_view(struct patch_sum *sums, const struct level_light *light, const char *folder,
                            const struct view *view, const struct model_axes *axes, struct provenance *prov,
                            struct err *err)
{
    const struct view model = model_from_world_view(axes, view);
    const size_t rays = (size_t)(view->width / STEP) * (size_t)(view->height / STEP);
    struct looking l = {.light = light, .view = &model};
    l.patch = malloc((rays + 1) * sizeof *l.patch);
    l.seen = malloc((rays + 1) * sizeof *l.seen);
    if (!l.patch || !l.seen)
        err_nomem(err, "a photo", rays * sizeof *l.seen);
    else if (!view_planes_read(&l.planes, folder, view, VIEW_CHANNELS, prov, err))
        parallel_for((size_t)(view->height / STEP), ROWS, look_along, &l);
    for (size_t i = 0; !err->status && i < rays; i++) {
        if (l.patch[i] < 0) continue;
        struct patch_sum *s = &sums[l.patch[i]];
        s->photo += (double)l.seen[i][0];
        s->texels += (double)l.seen[i][1];
        s->count++;
    }
    view_planes_release(&l.planes);
    free(l.patch);
    free(l.seen);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- photos */

struct making {
    struct other_light *o;
    const struct level_light *light;
    const struct state_list *states;
    const struct levels_params *params;
    struct camera_set set;
    struct lens_list lenses;
    struct patch_sum *sums;
    int groups, patches; /* so far */
};

/* Weights of lamps, the rest and windows in a state. */
static enum status find_weights(double *to, const struct making *m, const struct state_photo *p, struct err *err)
{
    const struct light_groups *g = &m->light->groups;
    const struct light_state *state = &m->states->items[p->state];
    struct state_weights w = {0};
    if (!level_weights_make(&w, state, m->states, g, m->params, err) && w.has_absolute)
        err_set(err, ST_DATA,
                "%s:%d: the state %s has a computed sky or a planned lamp, in which no photo was taken; take one with "
                "lamps of lights.txt and the photographed sky alone.",
                m->states->path, p->line, state->name);
    if (!err->status && !w.has_relative)
        err_set(err, ST_DATA,
                "%s:%d: in the state %s no lamp and no window of the photographs shines, so the photo %s tells "
                "nothing; take one in a state with some.",
                m->states->path, p->line, state->name, p->name);
    for (int i = 0; !err->status && i <= g->rest; i++) to[i] = w.relative[i];
    for (int v = 0; !err->status && v < g->windows_count; v++) to[g->rest + 1 + v] = w.relative[g->sky + v];
    level_weights_release(&w);
    return err->status;
}

/* The light of each group at a patch, as photographed. */
static void find_light(double *to, const struct level_light *l, int patch, float *room)
{
    const struct light_groups *g = &l->groups;
    level_patch_groups(room, room + g->patch, l, patch, g->patch);
    for (int i = 0; i <= g->rest; i++) to[i] = (double)room[i];
    for (int v = 0; v < g->windows_count; v++)
        to[g->rest + 1 + v] = (double)room[g->sky + v] + (double)room[g->sun + v];
}

static enum status add_patches(struct making *m, int photo, float *room, struct err *err)
{
    const struct light_patches *p = &m->light->patches;
    const struct state_photo *named = &m->states->photos[photo];
    struct other_light *o = m->o;
    double *weights = o->weights + (size_t)photo * (size_t)m->groups;
    if (find_weights(weights, m, named, err)) return err->status;
    o->photos[photo] = (struct group_photo){.patches = o->patches + m->patches, .known = named->exposed};
    for (int i = 0; i < p->face_patches; i++) {
        const struct patch_sum *s = &m->sums[i];
        double *light = o->light + (size_t)m->patches * (size_t)m->groups;
        if (s->count < FEWEST) continue;
        find_light(light, m->light, i, room);
        o->patches[m->patches++] = (struct group_quotient){light, weights, s->photo / s->texels};
        o->photos[photo].count++;
    }
    if (o->photos[photo].count) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: the photo %s shows no face of the model that other photos show, too.",
                   m->states->path, named->line, named->name);
}

static enum status add_photo(struct making *m, int photo, const char *folder, const struct model_axes *axes,
                             float *room, struct provenance *prov, struct err *err)
{
    const struct state_photo *named = &m->states->photos[photo];
    bool found = false;
    memset(m->sums, 0, ((size_t)m->light->patches.count + 1) * sizeof *m->sums);
    for (int i = 0; !err->status && i < m->lenses.count; i++) {
        const int view = camera_set_find(&m->set, m->lenses.lenses[i].view);
        if (strcmp(m->lenses.lenses[i].photo, named->name) != 0 || view < 0) continue;
        found = true;
        add_view(m->sums, m->light, folder, &m->set.views[view], axes, prov, err);
    }
    if (!err->status && !found)
        return err_set(err, ST_DATA, "%s:%d: found the photo %s, which is not among those that were placed; %s.",
                       m->states->path, named->line, named->name,
                       "wanted the name of a photo, without the file extension");
    return err->status ? err->status : add_patches(m, photo, room, err);
}

static enum status allocate(struct making *m, float **room, struct err *err)
{
    const struct light_groups *g = &m->light->groups;
    const size_t photos = (size_t)m->states->photo_count, most = (size_t)m->light->patches.face_patches * photos;
    struct other_light *o = m->o;
    m->groups = g->rest + 1 + g->windows_count;
    o->count = (int)photos;
    o->photos = calloc(photos + 1, sizeof *o->photos);
    o->patches = calloc(most + 1, sizeof *o->patches);
    o->light = calloc(most * (size_t)m->groups + 1, sizeof *o->light);
    o->weights = calloc(photos * (size_t)m->groups + 1, sizeof *o->weights);
    m->sums = calloc((size_t)m->light->patches.count + 1, sizeof *m->sums);
    *room = calloc(2 * (size_t)g->patch + 1, sizeof **room);
    if (o->photos && o->patches && o->light && o->weights && m->sums && *room) return ST_OK;
    return err_nomem(err, "patches of photos", most * (size_t)m->groups * sizeof *o->light);
}

enum status other_light_make(struct other_light *o, const struct other_light_files *files, const struct level_light *l,
                             const struct state_list *states, const struct model_axes *axes,
                             const struct levels_params *params, struct provenance *prov, struct err *err)
{
    struct making m = {.o = o, .light = l, .states = states, .params = params};
    char lenses[FILE_PATH];
    float *room = NULL;
    *o = (struct other_light){.count = 0};
    if (!states->photo_count) return ST_OK;
    if (!files->views)
        return err_set(err, ST_USAGE, "%s:%d: photos in other light need --held-views, the folder of their views.",
                       states->path, states->photos[0].line);
    if (!camera_set_read_cameras(&m.set, files->views, prov, err) &&
        !product_path_in(lenses, files->views, PRODUCT_LENSES, &(struct product_key){0}, err) &&
        !lens_list_read(&m.lenses, lenses, prov, err))
        allocate(&m, &room, err);
    for (int k = 0; !err->status && k < states->photo_count; k++) add_photo(&m, k, files->views, axes, room, prov, err);
    free(room);
    free(m.sums);
    lens_list_release(&m.lenses);
    camera_set_release(&m.set);
    return err->status;
}
