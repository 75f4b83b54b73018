/* clutter_choose.c - which views a picture's clutter is drawn from.
 *
 * A few points of what the camera sees stand for all: on a lattice over the picture, on the shell and half way to it,
 * as nothing is known of the clutter yet. Each view is weighted at each point as in unstructured lumigraph rendering
 * [Buehler 2001]: by the angle between the rays from the view and from the camera, and by how much farther away the
 * view is; a view between which and the point a wall of the unedited model stands has no weight. Weights are normalised
 * per point, so that each point elects its views; those with the largest sums are
 * chosen. Their influence falls to 0 towards the first one that is left out, so that no view pops in or out as the
 * camera moves. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/render_model/clutter_scene.h"

enum { COLUMNS = 16, ROWS = 12, PLACES = 2 };
enum { THROUGH = 16 }; /* faces of panes behind one another */

#define FAR_FEE   0.1   /* radians per doubling of the distance */
#define SHARPNESS 0.005 /* radians^2 */
#define FADE      3.0
#define NEARLY    0.98 /* of the way to a point on the shell itself */

double clutter_penalty(struct vec3 point, struct vec3 camera, struct vec3 view)
{
    const struct vec3 a = vec3_sub(camera, point), b = vec3_sub(view, point);
    const double la = vec3_length(a), lb = vec3_length(b);
    if (!(la > 0 && lb > 0)) return 0;
    const double chord = vec3_length(vec3_sub(vec3_scale(a, 1 / la), vec3_scale(b, 1 / lb)));
    return chord + FAR_FEE * fmax(0, lb / la - 1);
}

bool clutter_is_hidden(const struct clutter_scene *s, struct vec3 from, struct vec3 point)
{
    struct ray_hit hit;
    if (!s->walls) return false;
    const struct vec3 to = model_from_world_point(&s->axes, point);
    struct vec3 at = model_from_world_point(&s->axes, from);
    const double way = vec3_length(vec3_sub(to, at));
    const struct vec3 direction = vec3_normalize(vec3_sub(to, at));
    double passed = 0;
    for (int k = 0; k < THROUGH && way > 0 && ray_scene_hit(&s->walls->rays, at, direction, &hit); k++) {
        passed += hit.t;
        if (!(passed < NEARLY * way)) return false;
        if (!solid_face_is_pane(&s->walls->mesh, (int)hit.id)) return true;
        at = vec3_add(hit.point, vec3_scale(direction, 2 * s->walls->rays.epsilon));
        passed += 2 * s->walls->rays.epsilon;
    }
    return false;
}

static void vote(double *score, double *weight, const struct clutter_scene *s, struct vec3 point, struct vec3 camera)
{
    const struct camera_set *set = s->set;
    double sum = 0;
    for (int i = 0; i < set->view_count; i++) {
        double u, v;
        const struct view *view = &set->views[i];
        weight[i] = 0;
        if (!(view_project(view, point, &u, &v) > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height))
            continue;
        if (clutter_is_hidden(s, view->center, point)) continue;
        const double penalty = clutter_penalty(point, camera, view->center);
        weight[i] = 1 / pow(SHARPNESS + penalty * penalty, 2);
        sum += weight[i];
    }
    for (int i = 0; i < set->view_count && sum > 0; i++) score[i] += weight[i] / sum;
}

static void elect(struct clutter_choice *choice, double *score, int views, int most)
{
    double scores[CLUTTER_VIEWS];
    for (choice->count = 0; choice->count < most; choice->count++) {
        int best = -1;
        for (int i = 0; i < views; i++)
            if (score[i] > 0 && (best < 0 || score[i] > score[best])) best = i;
        if (best < 0) break;
        choice->view[choice->count] = best;
        scores[choice->count] = score[best];
        score[best] = 0;
    }
    double next = 0;
    for (int i = 0; i < views; i++) next = fmax(next, score[i]);
    int kept = 0;
    for (int k = 0; k < choice->count; k++) {
        const double fade = FADE * (1 - next / scores[k]);
        if (!(fade > 0)) continue;
        choice->view[kept] = choice->view[k];
        choice->fade[kept++] = (float)fmin(1, fade);
    }
    choice->count = kept;
}

/* By insertion: in the order of the set. */
static void sort_choice(struct clutter_choice *c)
{
    for (int i = 1; i < c->count; i++)
        for (int k = i; k > 0 && c->view[k] < c->view[k - 1]; k--) {
            const int view = c->view[k];
            const float fade = c->fade[k];
            c->view[k] = c->view[k - 1];
            c->fade[k] = c->fade[k - 1];
            c->view[k - 1] = view;
            c->fade[k - 1] = fade;
        }
}

enum status clutter_choose_for(struct clutter_choice *choice, const struct clutter_scene *s, struct vec3 camera,
                               const struct vec3 *points, int count, int most, struct err *err)
{
    const struct camera_set *set = s->set;
    double *score = calloc(2 * (size_t)set->view_count + 1, sizeof *score);
    *choice = (struct clutter_choice){0};
    if (!score) return err_nomem(err, "scores of views", 2 * (size_t)set->view_count * sizeof *score);
    for (int i = 0; i < count; i++) vote(score, score + set->view_count, s, points[i], camera);
    elect(choice, score, set->view_count, most);
    sort_choice(choice);
    free(score);
    return ST_OK;
}

enum status clutter_choose(struct clutter_choice *choice, const struct clutter_scene *s, const struct view *camera,
                           const float *z, double scale, int most, struct err *err)
{
    struct vec3 points[COLUMNS * ROWS * PLACES];
    int count = 0;
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS; x++) {
            const double u = (x + 0.5) * camera->width / COLUMNS, v = (y + 0.5) * camera->height / ROWS;
            const float shell = z[(size_t)v * (size_t)camera->width + (size_t)u];
            if (!(shell > 0)) continue;
            for (int k = 1; k <= PLACES; k++)
                points[count++] = view_unproject(camera, u, v, (double)shell * scale * k / PLACES);
        }
    return clutter_choose_for(choice, s, camera->center, points, count, most, err);
}
