/* shell_steps.c - what the pixels of each face look up, pass by pass: from the rules of the texture map to tiles of
 * atlases [Colburn 2014, 4.5.4, 4.6].
 *
 * A face takes its rules in order. A place in the unedited model is looked up in the atlases of the two viewpoints, and
 * in the next pass in the VITA. Only pages of tiles that the picture may show are read.
 *
 * The light on a new surface is not known before irradiance is: common/texture/radiance_median.c guesses it, from
 * texels that some view shows. */
#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/light/model_rays.h"
#include "common/texture/radiance_median.h"
#include "stages/render_model/shell_scene.h"

static const double PARALLEL = 0.999; /* cosine between a face's normal and the direction in which a tile sees it */
static const double SLACK = 1e-6;     /* of the model's size: how far beyond its limits a rule counts */

/* ------------------------------------------------------------------------------------------------ radiance of faces */

static void count_tile(struct radiance_median *r, const struct texture_set *set, int tile, bool seen)
{
    const struct atlas_tile *t = &set->atlas.tiles[tile];
    const struct texture_page *page = &set->pages[t->page];
    const size_t texels = (size_t)texture_stride(t) * (size_t)(t->height + 2);
    for (size_t i = set->first[tile]; i < set->first[tile] + texels; i++) {
        if (page->made[i] == MADE_NOTHING || (seen && page->made[i] != MADE_WARPED)) continue;
        radiance_median_add(r, page->texels + 4 * i);
    }
}

static enum status count_radiances(struct radiance_median *r, struct shell_scene *s, struct texture_set *vita,
                                   const struct texture_rule *rule, bool seen, struct err *err)
{
    for (int i = 0; i < vita->atlas.tile_count; i++) {
        const struct atlas_tile *t = &vita->atlas.tiles[i];
        if (!radiance_median_wants(rule, t->face)) continue;
        if (page_cache_load(s->pages, vita, t->page, err)) return err->status;
        count_tile(r, vita, i, seen);
    }
    return ST_OK;
}

/* Sets the colour of a rule, unless there is no texel to take the light from. */
static enum status find_colour(struct shell_rule *rule, struct shell_scene *s, struct texture_set *vita,
                               struct err *err)
{
    struct radiance_median r;
    if (radiance_median_init(&r, err)) return err->status;
    count_radiances(&r, s, vita, &rule->rule, true, err);
    if (!err->status && !r.total) count_radiances(&r, s, vita, &rule->rule, false, err);
    rule->tried = !err->status;
    rule->known = !err->status && r.total;
    if (rule->known) radiance_median_colour(rule->colour, &r, rule->rule.albedo);
    radiance_median_release(&r);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ tiles */

/* A face in a picture. */
struct place {
    const struct solid_face *face;
    const struct texture_rule *rule;
    const struct view *camera;
    struct linear inverse_z;
};

/* Whether an orthogonal tile looks at the face from the front. Surfaces of one name may be in several planes. */
static bool sees_plane(const struct atlas_tile *t, const struct place *p)
{
    const double(*m)[4] = p->rule->matrix;
    double row[2][3];
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            row[i][k] = t->matrix[i][0] * m[0][k] + t->matrix[i][1] * m[1][k] + t->matrix[i][2] * m[2][k];
    const struct vec3 along =
        vec3_cross(vec3_make(row[0][0], row[0][1], row[0][2]), vec3_make(row[1][0], row[1][1], row[1][2]));
    return fabs(vec3_dot(vec3_normalize(along), p->face->normal)) > PARALLEL;
}

static enum status add_tile(struct shell_scene *s, struct texture_set *set, int tile, const struct shade_tile *placed,
                            struct err *err)
{
    const struct atlas_tile *t = &set->atlas.tiles[tile];
    if (array_reserve(&s->tiles, &s->tile_room, (size_t)s->tile_count + 1, sizeof *s->tiles, "tiles", err) ||
        page_cache_load(s->pages, set, t->page, err))
        return err->status;
    struct shade_tile *added = &s->tiles[s->tile_count++];
    *added = *placed;
    added->texels = set->pages[t->page].texels + 4 * set->first[tile];
    added->made = set->pages[t->page].made + set->first[tile];
    return ST_OK;
}

/* Adds the tiles of a set that the face's pixels may look into, or all of them. */
static enum status add_tiles(struct shell_scene *s, struct texture_set *set, const struct place *p, bool all,
                             int *first, int *count, struct err *err)
{
    *first = s->tile_count;
    *count = 0;
    if (!set) return ST_OK;
    const struct atlas *a = &set->atlas;
    for (int i = atlas_first_tile(a, p->rule->from); i < a->tile_count && a->tiles[i].face == p->rule->from; i++) {
        struct shade_tile placed;
        if (!set->photo && !sees_plane(&a->tiles[i], p)) continue;
        shade_tile_place(&placed, &a->tiles[i], p->rule->matrix, &p->inverse_z, p->camera);
        if (!all && shade_tile_misses(&placed, 0, 0, p->camera->width - 1, p->camera->height - 1)) continue;
        if (add_tile(s, set, i, &placed, err)) return err->status;
    }
    *count = s->tile_count - *first;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ steps */

/* The limits of a rule: a point p of the face is to the left of each side of the quadrilateral, seen from outside. */
static void set_limits(struct shade_step *step, const struct place *p, double slack)
{
    const struct vec3 *q = p->rule->within, n = p->face->normal;
    const struct vec3 area = vec3_cross(vec3_sub(q[2], q[0]), vec3_sub(q[3], q[1]));
    const double turn = vec3_dot(area, n) < 0 ? -1 : 1;
    step->limited = p->rule->limited;
    for (int k = 0; step->limited && k < 4; k++) {
        const struct vec3 left = vec3_scale(vec3_normalize(vec3_cross(n, vec3_sub(q[(k + 1) % 4], q[k]))), turn);
        const double row[4] = {left.x, left.y, left.z, slack - vec3_dot(left, q[k])};
        step->limits[k] = shade_linear(row, &p->inverse_z, p->camera);
    }
}

static enum status set_step(struct shade_step *step, struct shell_scene *s, struct shell_rule *rule, bool from_vita,
                            const struct place *p, const struct shell_atlases *atlases, struct err *err)
{
    set_limits(step, p, SLACK * s->model.size);
    switch (rule->rule.kind) {
    case TEXTURE_PLACE:
        step->kind = SHADE_TILES;
        if (add_tiles(s, from_vita ? atlases->vita : atlases->pair[0], p, false, &step->a, &step->a_count, err))
            return err->status;
        return add_tiles(s, from_vita ? NULL : atlases->pair[1], p, false, &step->b, &step->b_count, err);
    case TEXTURE_EDGE:
        step->kind = SHADE_EDGE;
        return add_tiles(s, atlases->vita, p, true, &step->a, &step->a_count, err);
    case TEXTURE_COLOUR:
        if (!rule->tried && atlases->vita && find_colour(rule, s, atlases->vita, err)) return err->status;
        step->kind = rule->known ? SHADE_COLOUR : SHADE_TILES; /* no tiles: no colour */
        for (int c = 0; c < 3; c++) step->colour[c] = rule->colour[c];
        return ST_OK;
    default:
        step->kind = SHADE_OUTDOORS;
        return ST_OK;
    }
}

/* Sets the step of a face; SHADE_NOTHING if it has no more. */
static enum status make_step(struct shell_scene *s, int face, int pass, const struct view *camera,
                             const struct shell_atlases *atlases, bool outdoors, struct err *err)
{
    struct shade_step *step = &s->steps[face + 1];
    const bool pair = atlases->pair[0] || atlases->pair[1];
    struct place p = {.face = &s->mesh.faces[face], .camera = camera};
    double plane[3];
    model_face_inverse_depth(plane, p.face, camera);
    p.inverse_z = (struct linear){plane[0], plane[1], plane[2] + 0.5 * (plane[0] + plane[1])};
    for (int i = s->faces[face].first; i < s->faces[face].first + s->faces[face].count; i++) {
        struct shell_rule *rule = &s->rules[i];
        const int passes = rule->rule.kind == TEXTURE_PLACE && pair ? 2 : 1;
        if (rule->rule.kind == TEXTURE_OUTDOORS && !outdoors) continue;
        p.rule = &rule->rule;
        if (pass < passes) return set_step(step, s, rule, pass == passes - 1, &p, atlases, err);
        pass -= passes;
    }
    return ST_OK;
}

enum status shell_steps_make(struct shell_scene *s, int pass, const struct view *camera,
                             const struct shell_atlases *atlases, bool outdoors, bool *any, struct err *err)
{
    *any = false;
    s->tile_count = 0;
    for (int i = 0; i <= s->mesh.face_count; i++) {
        s->steps[i] = (struct shade_step){.kind = SHADE_NOTHING};
        if (!s->open[i]) continue;
        if (i && make_step(s, i - 1, pass, camera, atlases, outdoors, err)) return err->status;
        if (!i && !pass && outdoors) s->steps[i].kind = SHADE_OUTDOORS;
        *any |= s->steps[i].kind != SHADE_NOTHING;
    }
    return ST_OK;
}
