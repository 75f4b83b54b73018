/* ends_search.h - shared by the search on the grid (ends.c) and off it (ends_climb.c): depth pictures of viewpoints,
 * and measures of the path between two ends. */
#ifndef REMODEL_ENDS_SEARCH_H
#define REMODEL_ENDS_SEARCH_H

#include "stages/plan_path/ends.h"
#include "stages/plan_path/parallax.h"

struct ends_search {
    const struct layer_scene *scene;
    const struct validity *v;
    const struct plan_params *params;
    struct scene_points points;
    struct viewpoint_test test;
    struct ends_notes *notes;
    double least_pixels[2]; /* of the views in the frame of each end (viewpoint_pixels_within) */
};

enum status ends_search_init(struct ends_search *s, const struct layer_scene *scene, const struct validity *v,
                             const struct plan_params *params, struct ends_notes *notes, struct err *err);
void ends_search_release(struct ends_search *s);

static inline int cell_count(const struct validity_region *r) { return r->columns * r->rows; }

static inline struct vec3 point_between(struct vec3 a, struct vec3 b, double t)
{
    return vec3_add(vec3_scale(a, 1 - t), vec3_scale(b, t));
}

/* Depth pictures of many viewpoints, each rendered by one thread. The caller fills at, end and wanted. */
struct picture_batch {
    struct ends_search *search;
    int count;
    struct vec3 *at; /* one per viewpoint, as are those below */
    int *end;        /* which end of the move it is */
    bool *wanted;    /* whether it is rendered */
    struct depth_picture *pictures;
    struct err *errors;
};

enum status ends_batch_init(struct picture_batch *b, struct ends_search *s, int count, struct err *err);
enum status ends_batch_render(struct picture_batch *b, struct err *err);
void ends_batch_release(struct picture_batch *b);

/* Sets e->parallax for the ends e->at. */
enum status ends_measure_parallax(struct ends_search *s, struct move_ends *e, struct err *err);

/* Sets the rest of e. A few samples of the path come first, as they soon find most invalid paths. */
enum status ends_measure_path(struct ends_search *s, struct move_ends *e, struct err *err);

/* Whether a few samples of the path between the ends are valid. */
enum status ends_test_path(bool *valid, struct ends_search *s, const struct vec3 at[2], struct err *err);

/* Angle between the ends at the scene's centroid, degrees. */
double ends_angle(const struct shot_setup *shot, const struct vec3 at[2]);

/* Whether an end of the move shows as much of the scene as it should. Only an establishing dolly has such a limit. */
bool ends_show_enough(const struct ends_search *s, int end, struct vec3 at);

/* Whether a move between these ends is no wider than max_angle and, if it is a dolly in or out, advances enough. */
bool ends_move_as_asked(const struct ends_search *s, const struct vec3 at[2]);

/* Both of these. */
bool ends_are_allowed(const struct ends_search *s, const struct vec3 at[2]);

#endif
