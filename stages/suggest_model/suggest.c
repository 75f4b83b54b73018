/* suggest.c - suggests a plan: faces, free space, cells, walls, rooms, in turn. */
#include "stages/suggest_model/suggest.h"

#include <stdlib.h>

#include "common/base/sort.h"
#include "stages/suggest_model/plan_search.h"

static const double MAX_HEIGHTS = 50; /* extent of a plan, in heights of the ceiling */
static const double MARGIN = 0.25;    /* around the points, likewise */
static const size_t RARE = 500;       /* one point in so many may lie outside of the plan, on each side */

void suggest_release(struct suggestion *s)
{
    if (!s) return;
    free(s->walls);
    free(s->openings);
    free(s->rooms);
    free(s->doubts);
    free(s->room_walls);
    *s = (struct suggestion){0};
}

/* The bounds of the plan: of nearly all points and all cameras, and no larger than a building. */
static enum status find_bounds(struct face_list *list, const struct sights *sights, struct err *err)
{
    const size_t count = sights->points.cloud.count;
    double *v = malloc((count + 1) * sizeof *v);
    if (!v) return err_nomem(err, "coordinates", count * sizeof *v);
    for (int axis = 0; axis < 2; axis++) {
        double cameras[2] = {HUGE_VAL, -HUGE_VAL};
        for (size_t i = 0; i < count; i++) {
            const struct vec3 p = sights->points.cloud.points[i].position;
            v[i] = axis ? p.y : p.x;
        }
        sort_doubles(v, count);
        list->low[axis] = v[count / RARE];
        list->high[axis] = v[count - 1 - count / RARE];
        for (int k = 0; k < sights->view_count; k++) {
            const double at = axis ? sights->views[k].center.y : sights->views[k].center.x;
            cameras[0] = fmin(cameras[0], at);
            cameras[1] = fmax(cameras[1], at);
        }
        const double middle = sights->view_count ? 0.5 * (cameras[0] + cameras[1]) : v[count / 2];
        list->low[axis] = fmin(list->low[axis], cameras[0]) - MARGIN * list->height;
        list->high[axis] = fmax(list->high[axis], cameras[1]) + MARGIN * list->height;
        list->low[axis] = fmax(list->low[axis], middle - 0.5 * MAX_HEIGHTS * list->height);
        list->high[axis] = fmin(list->high[axis], middle + 0.5 * MAX_HEIGHTS * list->height);
    }
    free(v);
    return ST_OK;
}

enum status suggest_plan(struct suggestion *s, const struct sights *sights, double height, double thickness,
                         const struct suggest_params *params, struct err *err)
{
    struct face_list faces = {.height = height, .cell = params->cell * height, .up = (int)ceil(1 / params->cell)};
    struct free_space space = {0};
    struct plan_search search = {.faces = &faces, .space = &space, .sights = sights, .params = params};
    *s = (struct suggestion){.ceiling = height};
    if (!sights->points.cloud.count) return ST_OK;
    if (!find_bounds(&faces, sights, err) && !faces_find(&faces, sights, params, err) &&
        !free_space_find(&space, &faces, sights, err) && !search_cells(&search, err) && !search_walls(s, &search, err))
        search_rooms(s, &search, suggested_thickness(thickness, height), err);
    search_release(&search);
    free_space_release(&space);
    face_list_release(&faces);
    if (err->status) suggest_release(s);
    return err->status;
}
