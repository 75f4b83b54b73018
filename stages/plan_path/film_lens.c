/* film_lens.c - see film_lens.h. */
#include "stages/plan_path/film_lens.h"

#define AGREEING 0.1 /* the mean of upright directions is none where it is shorter than this */

/* The view nearest the centroid of the centres; of several there, the one that looks where most views look. */
static int middle_view(const struct camera_set *set)
{
    struct vec3 centroid = {0}, gaze = {0};
    double least = HUGE_VAL, best_gaze = 0;
    int best = 0;
    for (int i = 0; i < set->view_count; i++) {
        const double *axis = set->views[i].cam_from_world.m[2];
        centroid = vec3_add(centroid, vec3_scale(set->views[i].center, 1.0 / set->view_count));
        gaze = vec3_add(gaze, vec3_make(axis[0], axis[1], axis[2]));
    }
    for (int i = 0; i < set->view_count; i++) {
        const double *axis = set->views[i].cam_from_world.m[2];
        const double far = vec3_length(vec3_sub(set->views[i].center, centroid));
        const double along = vec3_dot(vec3_make(axis[0], axis[1], axis[2]), gaze);
        if (far > least * (1 + 1e-9) || (far >= least * (1 - 1e-9) && along <= best_gaze)) continue;
        least = far, best_gaze = along, best = i;
    }
    return best;
}

static double even(double size) { return fmax(2, 2 * round(size / 2)); }

void film_lens(struct view *lens, struct vec3 *up, const struct camera_set *set, const struct vec3 *ups,
               const struct plan_params *params)
{
    const struct vec3 upright = {0, -1, 0};
    const int at = middle_view(set);
    const struct view *middle = &set->views[at];
    const struct vec3 middle_up = ups ? ups[at] : upright;
    struct vec3 sum = {0};
    double focal = 0; /* of the longer side */
    for (int i = 0; i < set->view_count; i++) {
        const struct view *v = &set->views[i];
        sum = vec3_add(sum, mat3_apply(mat3_transpose(v->cam_from_world), ups ? ups[i] : upright));
        focal += sqrt(v->fx * v->fy) / (v->width > v->height ? v->width : v->height) / set->view_count;
    }
    if (vec3_length(sum) < AGREEING * set->view_count)
        sum = mat3_apply(mat3_transpose(middle->cam_from_world), middle_up);
    *up = vec3_normalize(sum);

    const bool turned = fabs(middle_up.x) > fabs(middle_up.y);
    const double w = turned ? middle->height : middle->width, h = turned ? middle->width : middle->height;
    const double shrink = fmin(1, params->max_side / fmax(w, h));
    const double width = even(params->width ? params->width : params->height ? params->height * w / h : w * shrink);
    const double height = even(params->height ? params->height : params->width ? params->width * h / w : h * shrink);
    *lens = (struct view){.width = (int)width, .height = (int)height, .cx = width / 2, .cy = height / 2};
    lens->fx = lens->fy = focal * fmax(w, h) * fmax(width / w, height / h);
}
