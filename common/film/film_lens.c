/* film_lens.c - frame size, focal length and upright direction of a film. */
#include "common/film/film_lens.h"

#define MIN_MEAN_LENGTH 0.1 /* a shorter mean of upright directions is meaningless */

static double round_to_even(double size) { return fmax(2, 2 * round(size / 2)); }

void film_lens(struct view *lens, struct vec3 *up, const struct camera_set *set, int middle, const struct vec3 *ups,
               const struct film_size *size)
{
    const struct vec3 upright = {0, -1, 0};
    const struct view *middle_view = &set->views[middle];
    const struct vec3 middle_up = ups ? ups[middle] : upright;
    struct vec3 sum = {0};
    double focal = 0; /* mean, in units of the longer side */
    for (int i = 0; i < set->view_count; i++) {
        const struct view *v = &set->views[i];
        sum = vec3_add(sum, mat3_apply(mat3_transpose(v->cam_from_world), ups ? ups[i] : upright));
        focal += sqrt(v->fx * v->fy) / (v->width > v->height ? v->width : v->height) / set->view_count;
    }
    if (vec3_length(sum) < MIN_MEAN_LENGTH * set->view_count)
        sum = mat3_apply(mat3_transpose(middle_view->cam_from_world), middle_up);
    *up = vec3_normalize(sum);

    const bool turned = fabs(middle_up.x) > fabs(middle_up.y);
    const double w = turned ? middle_view->height : middle_view->width,
                 h = turned ? middle_view->width : middle_view->height;
    const double shrink = fmin(1, size->max_side / fmax(w, h));
    const double width = round_to_even(size->width ? size->width : size->height ? size->height * w / h : w * shrink);
    const double height = round_to_even(size->height ? size->height : size->width ? size->width * h / w : h * shrink);
    *lens =
        (struct view){.name = "film", .width = (int)width, .height = (int)height, .cx = width / 2, .cy = height / 2};
    lens->fx = lens->fy = focal * fmax(w, h) * fmax(width / w, height / h);
}
