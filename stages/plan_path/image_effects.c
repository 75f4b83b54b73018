/* image_effects.c - depth of field, focus and colour of a move [Colburn 2014, 3.4.3].
 *
 * Aperture: as in the thesis, it grows until a corner of the square around its disk is an invalid viewpoint; here
 * bisection then refines it. It is also limited by the circle of confusion of an infinitely far point, aperture fx /
 * focus px. */
#include "stages/plan_path/image_effects.h"

#include <stdlib.h>
#include <string.h>

#define FIRST_APERTURE 0.002 /* in units of the focus distance */
#define BISECTIONS     4
#define BOX_DEPTH      0.75 /* of the box in front of and behind the subject, in units of its height */
#define BOX_FALLOFF    0.35 /* in units of the subject's height */

static enum status corners_valid(bool *valid, struct viewpoint_test *test, const struct view *camera, double aperture,
                                 double focus, struct err *err)
{
    *valid = true;
    for (int i = 0; i < 4 && *valid; i++) {
        const struct view corner =
            view_from_lens_point(camera, (i % 2 ? 0.5 : -0.5) * aperture, (i / 2 ? 0.5 : -0.5) * aperture, focus);
        if (viewpoint_is_valid(valid, test, &corner, err)) return err->status;
    }
    return ST_OK;
}

/* Finds the widest valid aperture of a camera focused at `focus`. max_blur: px. 0: not even a small one is valid. */
static enum status widest_aperture(double *aperture, struct viewpoint_test *test, const struct view *camera,
                                   double focus, double max_blur, struct err *err)
{
    const double limit = max_blur * focus / camera->fx;
    double inner = 0, outer = 0, next = fmin(FIRST_APERTURE * focus, limit); /* largest valid, smallest invalid */
    bool valid;

    *aperture = 0;
    if (!(limit > 0)) return ST_OK;
    while (!(outer > 0) && inner < limit) {
        if (corners_valid(&valid, test, camera, next, focus, err)) return err->status;
        if (valid)
            inner = next, next = fmin(2 * next, limit);
        else
            outer = next;
    }
    for (int i = 0; outer > 0 && i < BISECTIONS; i++) {
        next = 0.5 * (inner + outer);
        if (corners_valid(&valid, test, camera, next, focus, err)) return err->status;
        if (valid)
            inner = next;
        else
            outer = next;
    }
    *aperture = inner;
    return ST_OK;
}

static double depth_of(const struct view *camera, const struct subject *s)
{
    double u, v;
    return view_project(camera, subject_center(s), &u, &v);
}

/* The focus of a frame at `fraction` of the path; 0: a subject is behind the camera. */
static double focus_at(const struct view *camera, const struct validity *v, const struct subject_list *subjects,
                       double fraction)
{
    const bool two = v->effect.move == MOVE_DOLLY;
    const double first = depth_of(camera, &subjects->subjects[0]);
    const double second = two ? depth_of(camera, &subjects->subjects[1]) : first;
    if (!(first > 0 && second > 0)) return 0;
    if (!two) return first;
    if (v->effect.focus == FOCUS_WIDEN) return first; /* blur is visible near the start alone */
    return v->effect.focus == FOCUS_NARROW ? second : (1 - fraction) * first + fraction * second;
}

enum status effects_focus(struct camera_path *path, double *widest, const double *fractions,
                          struct viewpoint_test *test, const struct validity *v, const struct subject_list *subjects,
                          const struct plan_params *params, struct err *err)
{
    const enum focus_effect effect = v->effect.focus;
    const int last = path->frame_count - 1;
    const double longer = fmax(v->shot.lens.width, v->shot.lens.height);

    *widest = INFINITY;
    for (int end = 0; end < 2; end++) { /* the ends at which the aperture is open */
        const struct view *camera = &path->frames[end ? last : 0].camera;
        double aperture = 0;
        if (effect == (end ? FOCUS_WIDEN : FOCUS_NARROW)) continue;
        const double focus = focus_at(camera, v, subjects, end);
        if (focus > 0 && widest_aperture(&aperture, test, camera, focus, params->max_blur * longer, err))
            return err->status;
        *widest = fmin(*widest, aperture);
    }
    for (int i = 0; i <= last; i++) {
        struct path_frame *f = &path->frames[i];
        f->aperture = f->focus = 0;
        const double t = fractions[i], focus = focus_at(&f->camera, v, subjects, t);
        const double open = effect == FOCUS_NARROW ? t : effect == FOCUS_WIDEN ? 1 - t : 1;
        if (!(focus > 0) || !(open * *widest > 0)) continue;
        f->aperture = *widest * open;
        f->focus = focus;
    }
    return ST_OK;
}

/* The bounding box of the subject's quadrilateral extended by BOX_DEPTH to both sides, along the quadrilateral's own
 * axes: its upper edge, down, and its normal. */
static struct effect_box subject_box(const struct subject *s)
{
    const struct vec3 down = vec3_sub(s->corner[3], s->corner[0]), right = vec3_sub(s->corner[1], s->corner[0]);
    const struct vec3 x = vec3_normalize(right), z = vec3_normalize(vec3_cross(right, down)), y = vec3_cross(z, x);
    const struct mat3 box_from_world = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    const double size = vec3_length(down);
    struct vec3 low = vec3_make(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = vec3_scale(low, -1); /* from corner 0 */

    for (int i = 0; i < 4; i++) {
        const struct vec3 c = mat3_apply(box_from_world, vec3_sub(s->corner[i], s->corner[0]));
        low = vec3_make(fmin(low.x, c.x), fmin(low.y, c.y), fmin(low.z, c.z));
        high = vec3_make(fmax(high.x, c.x), fmax(high.y, c.y), fmax(high.z, c.z));
    }
    low.z -= BOX_DEPTH * size;
    high.z += BOX_DEPTH * size;
    const struct vec3 half = vec3_scale(vec3_sub(high, low), 0.5);
    const struct vec3 middle = vec3_add(s->corner[0], mat3_apply(mat3_transpose(box_from_world), vec3_add(low, half)));
    return (struct effect_box){.low = vec3_sub(middle, half),
                               .high = vec3_add(middle, half),
                               .falloff = BOX_FALLOFF * size,
                               .box_from_world = quat_from_mat3(box_from_world)};
}

enum status effects_tone_layers(struct effects *layers, const struct validity *v, const struct subject_list *subjects,
                                const struct camera_path *path, const struct plan_params *params, struct err *err)
{
    const double final[TONE_COUNT] = {[TONE_SATURATE] = params->saturate,
                                      [TONE_DESATURATE] = params->desaturate,
                                      [TONE_BRIGHTEN] = params->brighten,
                                      [TONE_DIM] = params->dim};
    const enum tone_effect tone = v->effect.tone;

    *layers = (struct effects){0};
    if (!tone) return ST_OK;
    layers->layers = calloc(1, sizeof *layers->layers);
    if (!layers->layers) return err_nomem(err, "an effect layer", sizeof *layers->layers);
    layers->layer_count = 1;
    struct effect_layer *l = layers->layers;
    l->kind = tone == TONE_SATURATE || tone == TONE_DESATURATE ? EFFECT_SATURATION : EFFECT_BRIGHTNESS;
    l->region = tone == TONE_SATURATE || tone == TONE_BRIGHTEN ? EFFECT_INSIDE : EFFECT_OUTSIDE;
    l->curve = EFFECT_CUBIC;
    l->name = strdup("subject");
    l->boxes = calloc(1, sizeof *l->boxes);
    l->keys = calloc(2, sizeof *l->keys);
    if (!l->name || !l->boxes || !l->keys) return err_nomem(err, "an effect layer", 2 * sizeof *l->keys);
    l->boxes[0] = subject_box(&subjects->subjects[0]);
    l->box_count = 1;
    l->key_count = 2;
    l->keys[0] = (struct effect_key){path->frames[0].time, {1}};
    l->keys[1] = (struct effect_key){path->frames[path->frame_count - 1].time, {final[tone]}};
    return ST_OK;
}
