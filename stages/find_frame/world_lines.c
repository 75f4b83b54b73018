/* world_lines.c - see world_lines.h. */
#include "stages/find_frame/world_lines.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"

#define END_ERROR   1.0    /* px: of a line's end across the line */
#define LENS_ERROR  0.0015 /* radians: what lenses and poses bend and turn */
#define HEAD_ON     0.08   /* sine of the angle to the vanishing point below which a line says nothing */
#define GRAZING     0.1    /* sine of the angle between a ray and a wall */
#define MOST_POINTS 4001   /* of which the scene's size is the median */

static struct vec3 ray_of(const struct view *view, double u, double v)
{
    return vec3_normalize(vec3_sub(view_unproject(view, u, v, 1), view->center));
}

enum status world_lines_add(struct world_lines *w, const struct view *view, int view_idx, const struct line_list *list,
                            struct err *err)
{
    for (int i = 0; i < list->count; i++) {
        const struct view_line *l = &list->lines[i];
        struct world_line o = {.view = view_idx, .length = hypot(l->u1 - l->u0, l->v1 - l->v0)};
        o.ends[0] = ray_of(view, l->u0, l->v0);
        o.ends[1] = ray_of(view, l->u1, l->v1);
        o.middle = vec3_normalize(vec3_add(o.ends[0], o.ends[1]));
        o.normal = vec3_normalize(vec3_cross(o.ends[0], o.ends[1]));
        o.across = vec3_cross(o.normal, o.middle);
        o.error = hypot(sqrt(2) * END_ERROR / o.length, LENS_ERROR);
        if (array_append(&w->lines, (size_t)w->count, sizeof o, "lines", err)) return err->status;
        w->lines[w->count++] = o;
    }
    return ST_OK;
}

void world_lines_release(struct world_lines *w)
{
    if (!w) return;
    free(w->lines);
    *w = (struct world_lines){0};
}

double world_lines_size(const struct camera_set *set)
{
    double distance[MOST_POINTS];
    const struct sfm_model *m = &set->model;
    const int stride = m->point_count / MOST_POINTS + 1;
    int count = 0;
    for (int i = 0; i < m->point_count; i += stride) {
        const struct sfm_point *p = &m->points[i];
        if (!p->track_count || p->track[0].image_idx >= set->view_count) continue;
        distance[count++] = vec3_length(vec3_sub(p->position, set->views[p->track[0].image_idx].center));
    }
    if (count >= 8) return sort_median(distance, (size_t)count);
    struct vec3 mean = {0};
    double square = 0;
    for (int i = 0; i < set->view_count; i++)
        mean = vec3_add(mean, vec3_scale(set->views[i].center, 1.0 / set->view_count));
    for (int i = 0; i < set->view_count; i++) {
        const struct vec3 d = vec3_sub(set->views[i].center, mean);
        square += vec3_dot(d, d) / set->view_count;
    }
    return 1.5 * sqrt(square);
}

enum status world_lines_place(struct world_lines *w, const struct camera_set *set, double reach, struct err *err)
{
    int *station = malloc(((size_t)set->view_count + 1) * sizeof *station), *first = NULL;
    if (station) first = malloc(((size_t)set->view_count + 1) * sizeof *first);
    if (!first) err_nomem(err, "stations", (size_t)set->view_count * 2 * sizeof *first);
    w->stations = 0;
    for (int i = 0; !err->status && i < set->view_count; i++) {
        int k = 0;
        while (k < w->stations && vec3_length(vec3_sub(set->views[i].center, set->views[first[k]].center)) > reach) k++;
        if (k == w->stations) first[w->stations++] = i;
        station[i] = k;
    }
    for (int i = 0; !err->status && i < w->count; i++) w->lines[i].station = station[w->lines[i].view];
    free(station);
    free(first);
    return err->status;
}

double world_line_slope(const struct world_line *l, struct vec3 direction)
{
    const double along = fabs(vec3_dot(l->across, direction));
    return along > HEAD_ON ? fabs(vec3_dot(l->normal, direction)) / along : HUGE_VAL;
}

double world_line_angle(const struct world_line *l, struct vec3 direction)
{
    return atan(world_line_slope(l, direction));
}

bool world_line_on_wall(double *height, double *place, const struct world_line *l, const struct frame_wall *wall,
                        const struct room_frame *f, const struct camera_set *set)
{
    const struct vec3 along = f->headings[wall->heading].along, across = frame_across(f, wall->heading),
                      eye = set->views[l->view].center;
    const double before = wall->side * (vec3_dot(across, eye) - wall->offset);
    *height = *place = 0;
    if (!(before > 0)) return false;
    for (int k = 0; k < 2; k++) {
        const double closing = -wall->side * vec3_dot(across, l->ends[k]);
        if (!(closing > GRAZING)) return false;
        *place += (vec3_dot(along, eye) + before / closing * vec3_dot(along, l->ends[k])) / 2;
        *height += (vec3_dot(f->up, eye) + before / closing * vec3_dot(f->up, l->ends[k])) / 2;
    }
    return true;
}
