/* outdoors_turn.c - matches a lighting reference image with the views that look out of its opening.
 *
 * Features of what both show outdoors (outdoors_map.c) are matched as those of photos are; each match gives a ray of
 * the image's camera and a direction from the view's place. The rotation follows from them (outdoors_rotation.c); the
 * place stays. How well it is known depends on whether somebody stated it (PLACE), and else on the size of the opening.
 * At most MAX_VIEWS views are matched, those that show most of the outdoors. */
#include "stages/hdr_merge/outdoors_turn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/mutual_matches.h"
#include "common/model/scene_inputs.h"
#include "stages/hdr_merge/outdoors_map.h"

enum { MAX_VIEWS = 48 };

static const double MIN_SEEN = 1e-3;               /* steradians: two degrees by two */
static const double PLACE = 0.04, ANYWHERE = 0.15; /* standard errors of the place, shares of the diagonal */
static const struct match_limits limits = MATCH_LIMITS;

struct looking { /* a view, and how much of the opening it shows */
    int view;
    double seen;
};

struct search {
    const struct outdoors_image *image;
    struct scene_inputs in;
    struct opening_sight sight;
    struct pose cam_from_model;
    struct feature_list features; /* of the image */
    struct nearest_descriptors descriptors;
    struct outdoors_grid grid; /* of the image */
    struct looking *views;     /* owned */
    int view_count;
    struct outdoors_sight *sights; /* owned */
    int sight_count;
};

static int compare_looking(const void *a, const void *b)
{
    const struct looking *l = a, *r = b;
    return l->seen != r->seen ? (l->seen < r->seen ? 1 : -1) : l->view - r->view;
}

static enum status choose_views(struct search *s, struct err *err)
{
    s->views = malloc(((size_t)s->in.set.view_count + 1) * sizeof *s->views);
    if (!s->views) return err_nomem(err, "views", (size_t)s->in.set.view_count * sizeof *s->views);
    for (int i = 0; i < s->in.set.view_count; i++) {
        const double seen = outdoors_map_seen(&s->in.set.views[i], &s->sight);
        if (seen >= MIN_SEEN) s->views[s->view_count++] = (struct looking){i, seen};
    }
    qsort(s->views, (size_t)s->view_count, sizeof *s->views, compare_looking);
    if (s->view_count > MAX_VIEWS) s->view_count = MAX_VIEWS;
    return ST_OK;
}

/* Views of one photo have one number: the lowest of those that are cut from the same place. */
static int photo_of(const struct search *s, int k)
{
    const struct vec3 at = s->in.set.views[s->views[k].view].center;
    for (int i = 0; i < k; i++)
        if (vec3_length(vec3_sub(s->in.set.views[s->views[i].view].center, at)) < 1e-6) return i;
    return k;
}

static enum status add_match(struct search *s, const struct view *view, int photo, const struct outdoors_grid *grid,
                             const struct feature *seen, int point, struct err *err)
{
    const struct feature *f = &s->features.features[point];
    const struct vec3 guess = outdoors_map_direction(&s->grid, (double)f->x, (double)f->y);
    if (array_append(&s->sights, (size_t)s->sight_count, sizeof *s->sights, "matches", err)) return err->status;
    s->sights[s->sight_count++] =
        (struct outdoors_sight){.point = point,
                                .photo = photo,
                                .ray = mat3_apply(mat3_from_quat(s->cam_from_model.rotation), guess),
                                .from = vec3_sub(view->center, pose_center(&s->cam_from_model)),
                                .direction = outdoors_map_direction(grid, (double)seen->x, (double)seen->y)};
    return ST_OK;
}

static enum status match_view(struct search *s, int k, const char *folder, struct provenance *prov, struct err *err)
{
    const struct view *view = &s->in.set.views[s->views[k].view];
    struct outdoors_grid grid = {.out = s->grid.out, .pitch = s->grid.pitch};
    struct view_planes planes = {0};
    struct feature_list list = {0};
    struct nearest_descriptors descriptors = {0};
    struct matched_pair pair = {0};
    if (!view_planes_read(&planes, folder, view, VIEW_A + 1, prov, err) &&
        !outdoors_map_of_view(&list, &grid, &planes, view, &s->sight, err) &&
        !nearest_descriptors_init(&descriptors, &list, err))
        mutual_matches_find(&pair, &s->descriptors, &descriptors, &limits, err);
    for (int i = 0; !err->status && i < pair.count; i++)
        add_match(s, view, photo_of(s, k), &grid, &list.features[pair.matches[i].second], pair.matches[i].first, err);
    free(pair.matches);
    nearest_descriptors_release(&descriptors);
    feature_list_release(&list);
    view_planes_release(&planes);
    return err->status;
}

static int compare_sights(const void *a, const void *b)
{
    const struct outdoors_sight *l = a, *r = b;
    const double first[] = {l->point, l->photo, l->direction.x, l->direction.y, l->direction.z},
                 second[] = {r->point, r->photo, r->direction.x, r->direction.y, r->direction.z};
    for (int k = 0; k < 5; k++)
        if (first[k] != second[k]) return first[k] < second[k] ? -1 : 1;
    return 0;
}

static enum status turn(struct outdoors_turn *t, struct search *s, struct pose *cam_from_model,
                        const struct merge_params *params, struct err *err)
{
    const double diagonal = opening_sight_diagonal(&s->sight);
    const struct outdoors_rules rules = {.nearest = diagonal,
                                         .place_error = (s->image->stated ? PLACE : ANYWHERE) * diagonal,
                                         .min_sights = params->outdoors_matches,
                                         .max_error = params->outdoors_error};
    const struct vec3 at = pose_center(cam_from_model);
    if (s->sight_count) qsort(s->sights, (size_t)s->sight_count, sizeof *s->sights, compare_sights);
    if (outdoors_rotation_find(&t->found, mat3_from_quat(cam_from_model->rotation), s->sights, s->sight_count, &rules,
                               s->image->id, err))
        return err->status;
    if (t->found.verdict == OUTDOORS_TURNED)
        *cam_from_model = (struct pose){quat_from_mat3(t->found.cam_from_model),
                                        vec3_scale(mat3_apply(t->found.cam_from_model, at), -1)};
    return ST_OK;
}

static void search_release(struct search *s)
{
    free(s->views);
    free(s->sights);
    nearest_descriptors_release(&s->descriptors);
    feature_list_release(&s->features);
    scene_inputs_release(&s->in);
}

enum status outdoors_turn_find(struct outdoors_turn *t, struct pose *cam_from_model, const struct outdoors_image *image,
                               const struct reference_frame *frame, const struct merge_params *params,
                               struct provenance *prov, struct err *err)
{
    const struct scene_files files = {.views = frame->outdoors, .axes = frame->axes, .plan = frame->plan};
    struct search s = {.image = image, .cam_from_model = *cam_from_model};
    *t = (struct outdoors_turn){.tried = true};
    if (!scene_inputs_read(&s.in, SCENE_CAMERAS | SCENE_AXES | SCENE_MODEL_VIEWS | SCENE_PLAN, &files, prov, err) &&
        opening_sight_init(&s.sight, &s.in.plan, image->opening) && !choose_views(&s, err)) {
        s.grid.out = vec3_make(-s.sight.wall->normal[0], -s.sight.wall->normal[1], 0);
        t->views = s.view_count;
        if (s.view_count &&
            !outdoors_map_of_reference(&s.features, &s.grid, image->radiance, image->lens, cam_from_model, err))
            nearest_descriptors_init(&s.descriptors, &s.features, err);
        for (int k = 0; !err->status && k < s.view_count; k++) match_view(&s, k, frame->outdoors, prov, err);
        if (!err->status) turn(t, &s, cam_from_model, params, err);
    }
    search_release(&s);
    return err->status;
}
