/* sun_indoors.c - see sun_indoors.h. */
#include "stages/bake_outdoors/sun_indoors.h"

#include <math.h>

/* The texture of a face, or the colour of a piece of furniture. */
static void see(struct light_look *seen, const struct sun_indoors *in, const struct ray_hit *hit)
{
    const struct atlas_scene *s = in->scene;
    const int extra = (int)hit->id - s->model->mesh.face_count;
    seen->distance = hit->t;
    if (extra >= 0) {
        seen->radiance = in->furniture->radiance[extra][!hit->front];
        seen->source = LIGHT_OBJECT;
    } else if (hit->front) {
        const struct field_texel texel =
            field_atlas_look(s->atlas, solid_face_id(&s->model->mesh, (int)hit->id), hit->point);
        seen->radiance = texel.radiance;
        seen->source = texel.source;
    }
}

static void look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                 const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    const struct sun_indoors *in = ctx;
    const struct atlas_scene *s = in->scene;
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
            see(&seen[k], in, &hits[k]);
        } else {
            outdoors_sample(rgb, in->outdoors, direction[k]);
            seen[k].radiance = rgb_make((double)rgb[0], (double)rgb[1], (double)rgb[2]);
            seen[k].source = LIGHT_SKY;
        }
    }
}

struct light_field sun_indoors_field(const struct sun_indoors *in)
{
    return (struct light_field){.ctx = in, .look = look};
}
