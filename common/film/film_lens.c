/* film_lens.c - see film_lens.h. */
#include "common/film/film_lens.h"

#define AGREEING 0.1 /* the mean of upright directions is none where it is shorter than this */

static double even(double size) { return fmax(2, 2 * round(size / 2)); }

void film_lens(struct view *lens, struct vec3 *up, const struct camera_set *set, int at, const struct vec3 *ups,
               const struct film_size *size)
{
    const struct vec3 upright = {0, -1, 0};
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
    const double shrink = fmin(1, size->max_side / fmax(w, h));
    const double width = even(size->width ? size->width : size->height ? size->height * w / h : w * shrink);
    const double height = even(size->height ? size->height : size->width ? size->width * h / w : h * shrink);
    *lens =
        (struct view){.name = "film", .width = (int)width, .height = (int)height, .cx = width / 2, .cy = height / 2};
    lens->fx = lens->fy = focal * fmax(w, h) * fmax(width / w, height / h);
}
