/* sun_light.c - how much light the sun gives.
 *
 * Overview. Beside the edge of a patch lies the same material without sun. If E is its irradiance there, the surface is
 * L / E times as bright as its irradiance says, and the patch, q times as bright, gets (q - 1) E from the sun, which is
 * the sun's irradiance times the cosine of the angle to the surface. E is gathered from the atlas and the outdoors, as
 * all light indoors is.
 *
 * The squares near the edges of all patches are sorted into places: cubes of space on one face, a hand wide. In a place
 * with enough lit and unlit squares q is the quotient of their mean radiances; texture differs from square to square,
 * but not on average. Places whose lit squares are hardly brighter are shadows of furniture, and do not count. The
 * result is the weighted median over all places, of each colour.
 *
 * Limits. The atlas lacks the light of lamps that saturate in all photographs, of cones of spots, and of lamps that
 * hang in the room. Below them E is too small, and the sun with it, by as much. So a place's weight is the square of
 * the share of its light that comes from outdoors: sills and reveals, which lamps hardly reach, count most. Where lamps
 * are as bright as the sun the result is a lower bound. A gloss brightens lit and unlit squares alike, and lowers q. */
#include "stages/bake_outdoors/sun_light.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/gather/irradiance.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

enum { RAYS = 1024, MIN_SQUARES = 5, MOST = 400 };
static const double PLACE = 12;              /* squares: the side of a place */
static const double LIT = 0.95, DARK = 0.05; /* shares of the disk */
static const double LEAST = 1.1;             /* quotient of lit to unlit */
static const double GRAZING = 0.1;           /* cosine below which a surface does not measure */

/* ------------------------------------------------------------------------------------------------ light without sun */

/* What a gather sees. */
struct indoors {
    const struct sun_scene *scene;
    const struct outdoors *outdoors;
};

static void look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                 const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    const struct indoors *in = ctx;
    const struct sun_scene *s = in->scene;
    struct vec3 origin[RAY_PACKET];
    struct ray_hit hits[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1) origin[k] = vec3_add(from[k], vec3_scale(normal, s->model->rays.epsilon));
    const unsigned hit = ray_scene_hit_packet(&s->model->rays, origin, direction, active, hits);
    for (int k = 0; k < RAY_PACKET; k++) {
        float rgb[3];
        if (!(active >> k & 1)) continue;
        seen[k] = (struct light_look){{0, 0, 0}, INFINITY, LIGHT_NONE, -1};
        if (hit >> k & 1) {
            seen[k].distance = hits[k].t;
            if (!hits[k].front) continue;
            const struct field_texel texel =
                field_atlas_look(s->atlas, solid_face_id(&s->model->mesh, (int)hits[k].id), hits[k].point);
            seen[k].radiance = texel.radiance;
            seen[k].source = texel.source;
        } else {
            outdoors_sample(rgb, in->outdoors, direction[k]);
            seen[k].radiance = rgb_make((double)rgb[0], (double)rgb[1], (double)rgb[2]);
            seen[k].source = LIGHT_SKY;
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- places */

struct place {
    int tile;
    int64_t x, y, z; /* the cube */
    int lit, dark;
    double sum[2][3];       /* radiances of lit and dark squares */
    struct vec3 at, normal; /* of the dark squares, summed */
    double sun[3];          /* the irradiance that it tells */
    double weight;
};

static struct place *find_place(struct place *places, int *count, const struct sun_texel *t, double size)
{
    const int64_t x = (int64_t)floor(t->at.x / size), y = (int64_t)floor(t->at.y / size);
    const int64_t z = (int64_t)floor(t->at.z / size);
    for (int i = *count; i-- > 0;) {
        struct place *p = &places[i];
        if (p->tile == t->tile && p->x == x && p->y == y && p->z == z) return p;
    }
    if (*count == MOST) return NULL;
    places[*count] = (struct place){.tile = t->tile, .x = x, .y = y, .z = z, .normal = t->normal};
    return &places[(*count)++];
}

static void add_square(struct place *p, const struct sun_texel *t, double share)
{
    const bool lit = share > LIT;
    if (!lit && !(share < DARK)) return;
    *(lit ? &p->lit : &p->dark) += 1;
    for (int c = 0; c < 3; c++) p->sum[!lit][c] += exp((double)t->level[c]);
    if (!lit) p->at = vec3_add(p->at, t->at);
}

/* Drops the places that cannot measure. Returns their number. */
static int keep_useful(struct place *places, int count, struct vec3 direction)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        struct place p = places[i];
        if (p.lit < MIN_SQUARES || p.dark < MIN_SQUARES || !(vec3_dot(p.normal, direction) > GRAZING)) continue;
        if (!(p.sum[0][1] / p.lit > LEAST * p.sum[1][1] / p.dark)) continue;
        p.at = vec3_scale(p.at, 1.0 / p.dark);
        places[kept++] = p;
    }
    return kept;
}

struct measuring {
    struct place *places;
    struct light_field field;
    struct vec3 direction;
};

static void measure_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct measuring *m = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct place *p = &m->places[i];
        struct irradiance e;
        ray_irradiance(&e, &m->field, (struct gather_point){p->at, p->normal}, RAYS, i);
        const double without[3] = {e.value.r, e.value.g, e.value.b}, cosine = vec3_dot(p->normal, m->direction);
        const double sky = e.from[LIGHT_SKY] + e.from[LIGHT_SKY_GUESSED];
        p->weight = sky * sky;
        for (int c = 0; c < 3; c++) {
            const double quotient = p->sum[0][c] / p->lit / (p->sum[1][c] / p->dark);
            p->sun[c] = fmax(0, (quotient - 1) * without[c] / cosine);
        }
    }
}

/* The median of the places' irradiances of a colour, or of their luminances (c = 3). */
static double median_of(const struct place *places, int count, int c, double less, struct weighted *scratch)
{
    for (int i = 0; i < count; i++) {
        const double *sun = places[i].sun;
        const double v = c < 3 ? sun[c] : rgb_luminance(rgb_make(sun[0], sun[1], sun[2]));
        scratch[i] = (struct weighted){less >= 0 ? fabs(v - less) : v, places[i].weight};
    }
    return weighted_percentile(scratch, (size_t)count, 0.5);
}

static void sum_up(struct sun_light *l, const struct place *places, int count, struct weighted *scratch)
{
    const double r = median_of(places, count, 0, -1, scratch), g = median_of(places, count, 1, -1, scratch);
    const double b = median_of(places, count, 2, -1, scratch), luminance = median_of(places, count, 3, -1, scratch);
    const double deviation = 1.4826 * median_of(places, count, 3, luminance, scratch);
    l->places = count;
    l->irradiance = rgb_make(r, g, b);
    /* the median's deviation is 1.2533 times that of the mean */
    l->error = luminance > 0 ? 1.96 * 1.2533 * deviation / (luminance * sqrt(count)) : INFINITY;
}

enum status sun_light_measure(struct sun_light *l, const struct sun_scene *scene, const struct outdoors *o,
                              const struct sun_texels *texels, struct vec3 direction, double radius, struct err *err)
{
    struct place *places = malloc(MOST * sizeof *places);
    struct weighted *scratch = malloc(MOST * sizeof *scratch);
    float *share = malloc(((size_t)texels->count + 1) * sizeof *share);
    int count = 0;
    *l = (struct sun_light){{0, 0, 0}, 0, 0};
    if (!places || !scratch || !share) err_nomem(err, "places", MOST * sizeof *places);
    if (!err->status) {
        sun_shares(share, texels, scene->model, direction, radius);
        for (int i = 0; i < texels->count; i++) {
            struct place *p = find_place(places, &count, &texels->list[i], PLACE * texels->side);
            if (p) add_square(p, &texels->list[i], (double)share[i]);
        }
        count = keep_useful(places, count, direction);
        const struct indoors in = {scene, o};
        struct measuring m = {places, {.ctx = &in, .look = look}, direction};
        parallel_for((size_t)count, 1, measure_range, &m);
        if (count) sum_up(l, places, count, scratch);
    }
    free(places);
    free(scratch);
    free(share);
    return err->status;
}
