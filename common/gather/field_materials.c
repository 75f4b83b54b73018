/* field_materials.c - fitted materials on the surfaces of a field of light; see field_materials.h.
 *
 * Overview. A texel shows a glossy surface as one camera saw it. Towards another viewer V, it has the radiance
 *   L(V) = texel + k_s (I_s(V) - I_s(S)),
 * and never less than 0, where S is the viewpoint of the photograph that the texel comes from, and I_s the integral of
 * light over the lobe (specular.c). What the surface is without gloss, texture included, is in the texel and cancels.
 * Where the view of a texel is unknown, or behind its surface, S is the camera of the region.
 *
 * Depth. I_s is gathered in `plain`, the same field without materials, in which all texels are as they were
 * photographed: one nested gather, never deeper. Its rays are few, since the noise of one look is one of many in a
 * gather. Both integrals use the same random numbers, so that their difference is 0 for a viewer at S, and small near
 * it. The numbers depend on the ray alone: a gather has the same bits whatever thread traces the ray.
 *
 * Grazing. Ward's lobe has no bound as the viewer approaches the surface's plane. A viewer less than GRAZING (the sine
 * of the angle) above it counts as that high; fits use no such angles.
 *
 * Places. What a ray costs must not depend on regions. When the materials are read, each texel of a face that a
 * region's camera can see is projected to the photograph; a cone around the region's rays rejects most of them at once.
 * The texel gets a mark, an index of pairs of material and viewpoint. Of several materials that hold a texel the first
 * counts.
 *
 * Source: [Colburn 2014, 5.3.1, 5.4]. Different here: the difference of two integrals in place of a diffuse part, so
 * that texture stays. */
#include "common/gather/field_materials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/capture/photo_camera.h"
#include "common/gather/specular.h"
#include "common/math/numbers.h"
#include "common/product/product.h"

enum { NESTED_RAYS = 16, MAX_REGIONS = UINT16_MAX };
static const double GRAZING = 0.02;
static const double EDGE_STEP = 8; /* px between the points of a region's border whose rays make its cone */

void field_materials_release(struct field_materials *m)
{
    material_list_release(&m->list);
    free(m->brdfs);
    free(m->texels);
    free(m->marks);
    *m = (struct field_materials){0};
}

/* ------------------------------------------------------------------------------------------------------- reflection */

/* splitmix64's finalizer */
static uint64_t mix(uint64_t h, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    h = (h ^ bits) + 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 27) * 0x94d049bb133111ebu;
    return h ^ h >> 31;
}

static uint64_t mix_vector(uint64_t h, struct vec3 v) { return mix(mix(mix(h, v.x), v.y), v.z); }

static struct vec3 raised(struct vec3 view, struct vec3 normal)
{
    const double sine = vec3_dot(view, normal);
    return sine >= GRAZING ? view : vec3_normalize(vec3_add(view, vec3_scale(normal, GRAZING - sine)));
}

/* k_s I_s */
static struct rgb gloss_towards(const struct light_field *plain, const struct brdf *b, const struct surface_seen *s,
                                struct vec3 view, uint64_t key)
{
    const struct gather_point p = {s->at, s->normal};
    return specular_estimate(plain, p, b, raised(view, s->normal), NESTED_RAYS, key);
}

bool field_materials_reflect(struct rgb *radiance, const struct field_materials *m, const struct light_field *plain,
                             int mark, const struct surface_seen *surface)
{
    const struct brdf *b = &m->brdfs[m->marks[mark].material];
    if (!(b->gloss > 0)) return false;
    const uint64_t key = mix_vector(mix_vector(0, surface->at), surface->to_viewer);
    const struct vec3 source = vec3_normalize(vec3_sub(m->marks[mark].viewpoint, surface->at));
    const struct rgb to = gloss_towards(plain, b, surface, surface->to_viewer, key);
    const struct rgb was = gloss_towards(plain, b, surface, source, key);
    radiance->r = fmax(radiance->r + to.r - was.r, 0);
    radiance->g = fmax(radiance->g + to.g - was.g, 0);
    radiance->b = fmax(radiance->b + to.b - was.b, 0);
    return true;
}

/* ---------------------------------------------------------------------------------------------------------- regions */

/* A region, ready for points of the model. */
struct seen_region {
    const struct material_region *region;
    int material;
    struct photo_camera camera;
    struct vec3 centre; /* model frame, as the cone */
    struct vec3 axis;
    double cosine; /* of the cone's half angle; -1: everywhere */
};

struct finder {
    struct field_materials *materials;
    const struct field_surface *on;
    const struct model_axes *axes;
    struct camera_set set;
    struct lens_list lenses;
    struct seen_region *regions;
    int region_count;
    uint16_t **found; /* of each page's texels: 1 + a region, 0: none */
    int *by_view;     /* 1 + the mark of [material][view of the atlas] */
    int *by_region;   /* 1 + the mark of the region's own camera */
};

static void finder_release(struct finder *d)
{
    for (int i = 0; d->found && i < d->on->atlas->atlas.page_count; i++) free(d->found[i]);
    free(d->found);
    free(d->by_view);
    free(d->by_region);
    free(d->regions);
    lens_list_release(&d->lenses);
    camera_set_release(&d->set);
}

/* Point k of n + 1 on the edge from corner i to the next one. */
static void edge_point(double at[2], const struct material_region *r, int i, int k, int n)
{
    const double *a = r->pixel + 2 * i, *b = r->pixel + 2 * ((i + 1) % r->corners), t = (double)k / n;
    for (int c = 0; c < 2; c++) at[c] = a[c] + t * (b[c] - a[c]);
}

static int edge_steps(const struct material_region *r, int i)
{
    const double *a = r->pixel + 2 * i, *b = r->pixel + 2 * ((i + 1) % r->corners);
    return 1 + (int)fmin(hypot(a[0] - b[0], a[1] - b[1]) / EDGE_STEP, 4096);
}

/* The least cosine between the axis and rays through the region's border, and the sum of these rays. False: a point of
 * the border has no ray. */
static bool follow_border(const struct seen_region *s, const struct model_axes *axes, double *cosine, struct vec3 *sum)
{
    *cosine = 1;
    *sum = vec3_make(0, 0, 0);
    for (int i = 0; i < s->region->corners; i++) {
        const int n = edge_steps(s->region, i);
        for (int k = 0; k < n; k++) {
            double at[2];
            struct vec3 ray;
            edge_point(at, s->region, i, k, n);
            if (!photo_camera_ray(&s->camera, at[0], at[1], &ray)) return false;
            ray = model_from_world_direction(axes, ray);
            *cosine = fmin(*cosine, vec3_dot(s->axis, ray));
            *sum = vec3_add(*sum, ray);
        }
    }
    return true;
}

/* A cone around all rays of the region, with a margin of two steps along its border. */
static void make_cone(struct seen_region *s, const struct model_axes *axes)
{
    double cosine, fx, fy, cx, cy;
    struct vec3 sum;
    s->cosine = -1;
    s->axis = vec3_make(0, 0, 1);
    if (!follow_border(s, axes, &cosine, &sum) || !(vec3_length(sum) > 0)) return;
    s->axis = vec3_normalize(sum);
    follow_border(s, axes, &cosine, &sum);
    camera_focal(&s->camera.lens, &fx, &fy, &cx, &cy);
    const double angle = acos(clamp(cosine, -1, 1)) + 2 * EDGE_STEP / fmin(fx, fy);
    if (angle < 0.45 * PI) s->cosine = cos(angle);
}

static enum status add_region(struct finder *d, int material, const struct material_region *r, const char *path,
                              struct err *err)
{
    struct seen_region *s = &d->regions[d->region_count++];
    *s = (struct seen_region){.region = r, .material = material};
    if (photo_camera_find(&s->camera, r->view, &d->set, &d->lenses, path, r->line, err)) return err->status;
    s->centre = model_from_world_point(d->axes, s->camera.center);
    make_cone(s, d->axes);
    return ST_OK;
}

static enum status add_regions(struct finder *d, const struct material_list *l, const char *path, struct err *err)
{
    size_t count = 0;
    for (int m = 0; m < l->count; m++) count += (size_t)l->items[m].region_count;
    if (count > MAX_REGIONS)
        return err_set(err, ST_DATA, "%s has %zu regions, wanted at most %d; mark fewer and larger ones.", path, count,
                       MAX_REGIONS);
    d->regions = calloc(count + 1, sizeof *d->regions);
    d->by_region = calloc(count + 1, sizeof *d->by_region);
    if (!d->regions || !d->by_region) return err_nomem(err, "regions", count * sizeof *d->regions);
    for (int m = 0; m < l->count; m++)
        for (int k = 0; k < l->items[m].region_count; k++)
            if (add_region(d, m, &l->items[m].regions[k], path, err)) return err->status;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------ texels of regions */

/* Whether the region's camera sees a point of a face, and the region holds it. */
static bool region_shows(const struct seen_region *s, const struct finder *d, struct vec3 p, struct vec3 normal)
{
    const struct vec3 to = vec3_sub(p, s->centre);
    double u, v;
    if (vec3_dot(to, s->axis) < s->cosine * vec3_length(to)) return false;
    if (!photo_camera_project(&s->camera, world_from_model_point(d->axes, p), &u, &v)) return false;
    if (!(u >= 0 && v >= 0 && u <= s->camera.lens.width && v <= s->camera.lens.height)) return false;
    if (!material_region_holds(s->region, u, v)) return false;
    const struct ray_scene *rays = &d->on->model->rays;
    const struct vec3 from = vec3_add(p, vec3_scale(normal, rays->epsilon));
    return !ray_scene_blocked(rays, from, vec3_sub(s->centre, from), 1);
}

static uint16_t *found_at(const struct finder *d, const struct atlas_tile *t, int x, int y)
{
    const size_t row = (size_t)d->on->atlas->atlas.page_sizes[t->page][0];
    return d->found[t->page] + (size_t)(t->y + y) * row + (size_t)(t->x + x);
}

static void search_tile(const struct finder *d, const struct atlas_tile *t, const struct face_plane *plane, int region)
{
    const struct seen_region *s = &d->regions[region];
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            uint16_t *found = found_at(d, t, x, y);
            if (*found || !field_atlas_has(d->on->atlas, t, x, y)) continue;
            if (region_shows(s, d, field_atlas_place(t, *plane, x, y), plane->normal)) *found = (uint16_t)(region + 1);
        }
}

static void search_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    const struct finder *d = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct atlas_tile *t = &d->on->atlas->atlas.tiles[i];
        if (t->face < 0 || t->face >= d->on->model->ids) continue;
        const struct face_plane *plane = &d->on->planes[t->face];
        for (int r = 0; r < d->region_count; r++)
            if (vec3_dot(plane->normal, d->regions[r].centre) > plane->offset) search_tile(d, t, plane, r);
    }
}

static enum status find_texels(struct finder *d, struct err *err)
{
    const struct atlas *a = &d->on->atlas->atlas;
    d->found = calloc((size_t)a->page_count + 1, sizeof *d->found);
    if (!d->found) return err_nomem(err, "pages", (size_t)a->page_count * sizeof *d->found);
    for (int i = 0; i < a->page_count; i++) {
        const size_t texels = (size_t)a->page_sizes[i][0] * (size_t)a->page_sizes[i][1];
        d->found[i] = calloc(texels + 1, sizeof **d->found);
        if (!d->found[i]) return err_nomem(err, "materials of texels", texels * sizeof **d->found);
    }
    parallel_for((size_t)a->tile_count, 1, search_tiles, d);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ marks */

/* The viewpoint of a view of the atlas. False: it is unknown or behind the face, and *viewpoint is unchanged. */
static bool find_viewpoint(struct vec3 *viewpoint, const struct finder *d, int view, const struct face_plane *plane)
{
    const struct atlas *a = &d->on->atlas->atlas;
    const int at = view >= 0 && view < a->source_count ? camera_set_find(&d->set, a->sources[view]) : -1;
    if (at < 0) return false;
    const struct vec3 p = model_from_world_point(d->axes, d->set.views[at].center);
    if (!(vec3_dot(plane->normal, p) > plane->offset)) return false;
    *viewpoint = p;
    return true;
}

static enum status add_mark(int *mark, struct field_materials *m, int material, struct vec3 viewpoint, struct err *err)
{
    if (m->mark_count == FIELD_ATLAS_MARKS)
        return err_set(err, ST_DATA,
                       "materials.txt: more than %d pairs of a material and a view that shows it, which is more than a "
                       "field of light can hold; mark fewer materials.",
                       FIELD_ATLAS_MARKS);
    m->marks[m->mark_count++] = (struct field_mark){material, viewpoint};
    *mark = m->mark_count;
    return ST_OK;
}

/* Which mark a texel gets. */
static enum status choose_mark(int *mark, struct finder *d, const struct atlas_tile *t, int x, int y, struct err *err)
{
    const int region = *found_at(d, t, x, y) - 1, view = field_atlas_view(d->on->atlas, t, x, y);
    const struct seen_region *s = &d->regions[region];
    struct vec3 viewpoint = s->centre;
    int *known = &d->by_region[region];
    if (find_viewpoint(&viewpoint, d, view, &d->on->planes[t->face]))
        known = &d->by_view[(size_t)s->material * (size_t)d->on->atlas->atlas.source_count + (size_t)view];
    if (!*known && add_mark(known, d->materials, s->material, viewpoint, err)) return err->status;
    *mark = *known - 1;
    return ST_OK;
}

static enum status mark_tile(struct finder *d, const struct atlas_tile *t, struct err *err)
{
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            int mark = 0;
            if (!*found_at(d, t, x, y)) continue;
            if (choose_mark(&mark, d, t, x, y, err)) return err->status;
            field_atlas_mark(d->on->atlas, t, x, y, mark);
            d->materials->texels[d->materials->marks[mark].material]++;
        }
    return ST_OK;
}

static enum status mark_texels(struct finder *d, struct err *err)
{
    const struct atlas *a = &d->on->atlas->atlas;
    struct field_materials *m = d->materials;
    const size_t pairs = (size_t)m->list.count * (size_t)a->source_count;
    d->by_view = calloc(pairs + 1, sizeof *d->by_view);
    m->marks = calloc(FIELD_ATLAS_MARKS, sizeof *m->marks);
    if (!d->by_view || !m->marks) return err_nomem(err, "marks of texels", (pairs + 1) * sizeof *d->by_view);
    for (int i = 0; i < a->tile_count; i++)
        if (mark_tile(d, &a->tiles[i], err)) return err->status;
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_list(struct field_materials *m, const char *path, struct provenance *prov, struct err *err)
{
    if (material_list_read(&m->list, path, prov, err)) return err->status;
    m->brdfs = calloc((size_t)m->list.count + 1, sizeof *m->brdfs);
    m->texels = calloc((size_t)m->list.count + 1, sizeof *m->texels);
    if (!m->brdfs || !m->texels) return err_nomem(err, "materials", (size_t)m->list.count * sizeof *m->brdfs);
    for (int i = 0; i < m->list.count; i++) m->brdfs[i] = material_brdf(&m->list.items[i]);
    return ST_OK;
}

static enum status read_cameras(struct finder *d, const char *views, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (camera_set_read_cameras(&d->set, views, prov, err) || product_path_in(path, views, PRODUCT_LENSES, NULL, err) ||
        lens_list_read(&d->lenses, path, prov, err))
        return err->status;
    return ST_OK;
}

enum status field_materials_read(struct field_materials *m, const struct field_surface *on, const char *path,
                                 const char *views, const struct model_axes *axes, struct provenance *prov,
                                 struct err *err)
{
    struct finder d = {.materials = m, .on = on, .axes = axes};
    if (!read_list(m, path, prov, err) && !read_cameras(&d, views, prov, err) &&
        !add_regions(&d, &m->list, path, err) && !find_texels(&d, err))
        mark_texels(&d, err);
    finder_release(&d);
    return err->status;
}
