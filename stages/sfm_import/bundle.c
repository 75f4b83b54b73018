/* bundle.c - bundle adjustment of a structure-from-motion model with a given form of its lenses.
 *
 * Poses, points and lenses are adjusted together [Triggs 2000]. Residuals r have heavy tails, since some matches are
 * wrong: their density is that of a Student t distribution in the plane with FREEDOM degrees of freedom n and scale s,
 *   p(r) = (1 + r^2 / (n s^2))^-(n + 2)/2 / (2 pi s^2).
 * s is its maximum-likelihood estimate [Liu 1995]: iterate s^2 = mean of w r^2 / 2, w = (n + 2) / (n + r^2 / s^2).
 *
 * A stabiliser moves the lens or the sensor of a camera from photo to photo, and with it the principal point. So a
 * photo's principal point is that of its lens plus a shift, which has a Gaussian prior around 0. Focal lengths and
 * distortion are those of the lens: free focal lengths drift along with the distances. Weak priors around the start
 * keep the parameters of lenses where the photos do not determine them, as for two photos or points in one plane.
 *
 * Forms of lenses are compared by the Bayesian information criterion [Schwarz 1978],
 *   BIC = -2 log likelihood + k log N,   N observations, k parameters of lenses and shifts,
 * each with its own scale s. Poses and points are the same number in all forms and are left out. */
#include "stages/sfm_import/bundle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/math/numbers.h"

#define FREEDOM    4.0
#define MIN_NOISE  0.02 /* px: simulated models without noise */
#define ITERATIONS 40
#define TOLERANCE  1e-6
/* Priors of a lens: the focal length relative to its start; the ratio of two focal lengths, which is practically fixed
 * (pixels are square, and a free ratio fits other errors: fountain's would be off by 0.5 %); the principal point, in
 * parts of the longer side; the part of the radius by
 * which a radial coefficient moves the picture's corner; a tangential coefficient. */
#define FOCAL_SIGMA      0.05
#define ASPECT_SIGMA     1e-5
#define CENTER_SIGMA     0.02
#define RADIAL_SIGMA     0.1
#define TANGENTIAL_SIGMA 0.001
#define MAX_SIGMAS       4.0   /* a parameter farther off shows that something else is wrong */
enum { MIN_OBSERVATIONS = 6 }; /* of an image; with fewer its pose is kept */

/* ---------------------------------------------------------------------------------------------------- the problem */

static bool residual_of(const struct bundle *b, const struct bundle_observation *o, double r[2])
{
    const struct bundle_image *im = &b->images[o->image];
    const struct pose pose = {{im->rotation[0], im->rotation[1], im->rotation[2], im->rotation[3]},
                              {im->translation[0], im->translation[1], im->translation[2]}};
    const double *x = b->points[o->point];
    double u, v;
    if (!camera_project(&b->lenses[im->lens].camera, pose_apply(&pose, vec3_make(x[0], x[1], x[2])), &u, &v))
        return false;
    r[0] = u + im->shift[0] - o->u;
    r[1] = v + im->shift[1] - o->v;
    return isfinite(r[0]) && isfinite(r[1]);
}

struct track_length {
    int point, length;
};

static int compare_lengths(const void *a, const void *b)
{
    const struct track_length *x = a, *y = b;
    if (x->length != y->length) return x->length > y->length ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

/* Adds the observations of a point that have a residual, if there are two. Without `quota` or if one of the images has
 * fewer observations than the quota. */
static void add_point(struct bundle *b, int *point_of, int *in_image, const struct sfm_model *m, int point, int quota)
{
    const struct sfm_point *p = &m->points[point];
    const size_t before = b->observation_count;
    bool wanted = !quota;
    b->points[b->point_count][0] = p->position.x;
    b->points[b->point_count][1] = p->position.y;
    b->points[b->point_count][2] = p->position.z;
    for (int k = 0; k < p->track_count; k++) {
        const struct sfm_track *t = &p->track[k];
        const struct sfm_observation *o = &m->images[t->image_idx].observations[t->observation_idx];
        const struct bundle_observation seen = {t->image_idx, b->point_count, o->u, o->v};
        double r[2];
        if (!residual_of(b, &seen, r)) continue;
        wanted = wanted || in_image[t->image_idx] < quota;
        b->observations[b->observation_count++] = seen;
    }
    if (!wanted || b->observation_count < before + 2) {
        b->observation_count = before;
        return;
    }
    for (size_t i = before; i < b->observation_count; i++) in_image[b->observations[i].image]++;
    point_of[b->point_count++] = point;
}

static enum status add_points(struct bundle *b, int *point_of, const struct sfm_model *m, size_t max_observations,
                              size_t total, struct err *err)
{
    struct track_length *order = malloc(((size_t)m->point_count + 1) * sizeof *order);
    int *in_image = calloc((size_t)m->image_count + 1, sizeof *in_image);
    if (!order || !in_image) err_nomem(err, "tracks", (size_t)m->point_count * sizeof *order);
    const bool all = !max_observations || total <= max_observations;
    const int quota = all ? 0 : (int)(max_observations / (size_t)m->image_count) + 1;
    for (int i = 0; !err->status && i < m->point_count; i++)
        order[i] = (struct track_length){i, m->points[i].track_count};
    if (!err->status && !all) qsort(order, (size_t)m->point_count, sizeof *order, compare_lengths);
    for (int i = 0; !err->status && i < m->point_count; i++) add_point(b, point_of, in_image, m, order[i].point, quota);
    for (int i = 0; !err->status && i < m->image_count; i++) b->images[i].fixed = in_image[i] < MIN_OBSERVATIONS;
    free(order);
    free(in_image);
    return err->status;
}

/* The lenses, images and points are one allocation, see struct bundle. */
static enum status allocate(struct bundle *b, int lenses, int images, int points, size_t observations, struct err *err)
{
    const size_t of_lenses = (size_t)lenses * sizeof *b->lenses, of_images = (size_t)images * sizeof *b->images;
    char *memory = calloc(1, of_lenses + of_images + ((size_t)points + 1) * sizeof *b->points);
    b->lenses = (struct bundle_lens *)memory;
    b->observations = calloc(observations + 1, sizeof *b->observations);
    if (!memory || !b->observations) {
        bundle_release(b);
        return err_nomem(err, "a bundle", observations * sizeof *b->observations);
    }
    b->images = (struct bundle_image *)(memory + of_lenses);
    b->points = (double(*)[3])(memory + of_lenses + of_images);
    return ST_OK;
}

enum status bundle_make(struct bundle *b, int **point_of, const struct sfm_model *m, size_t max_observations,
                        struct err *err)
{
    size_t total = 0;
    for (int i = 0; i < m->point_count; i++) total += (size_t)m->points[i].track_count;
    *b = (struct bundle){.lens_count = m->camera_count,
                         .image_count = m->image_count,
                         .freedom = FREEDOM,
                         .noise = 1,
                         .iterations = ITERATIONS,
                         .tolerance = TOLERANCE};
    *point_of = calloc((size_t)m->point_count + 1, sizeof **point_of);
    if (!*point_of) err_nomem(err, "points", (size_t)m->point_count * sizeof **point_of);
    if (!err->status) allocate(b, m->camera_count, m->image_count, m->point_count, total, err);
    for (int i = 0; !err->status && i < m->camera_count; i++) b->lenses[i].camera = m->cameras[i].camera;
    for (int i = 0; !err->status && i < m->image_count; i++) {
        const struct pose *pose = &m->images[i].cam_from_world;
        b->images[i] = (struct bundle_image){
            .lens = m->images[i].camera_idx,
            .rotation = {pose->rotation.w, pose->rotation.x, pose->rotation.y, pose->rotation.z},
            .translation = {pose->translation.x, pose->translation.y, pose->translation.z},
        };
    }
    if (!err->status) add_points(b, *point_of, m, max_observations, total, err);
    if (err->status) {
        bundle_release(b);
        free(*point_of);
        *point_of = NULL;
    }
    return err->status;
}

enum status bundle_copy(struct bundle *to, const struct bundle *from, struct err *err)
{
    *to = *from;
    if (allocate(to, from->lens_count, from->image_count, from->point_count, from->observation_count, err))
        return err->status;
    memcpy(to->lenses, from->lenses, (size_t)from->lens_count * sizeof *to->lenses);
    memcpy(to->images, from->images, (size_t)from->image_count * sizeof *to->images);
    memcpy(to->points, from->points, (size_t)from->point_count * sizeof *to->points);
    memcpy(to->observations, from->observations, from->observation_count * sizeof *to->observations);
    return ST_OK;
}

void bundle_release(struct bundle *b)
{
    if (!b) return;
    free(b->lenses); /* and the images and points after them */
    free(b->observations);
    *b = (struct bundle){0};
}

/* --------------------------------------------------------------------------------------------------- the statistics */

enum status bundle_measure(struct bundle_fit *fit, const struct bundle *b, struct err *err)
{
    const size_t n = b->observation_count;
    double *length = malloc((n + 1) * sizeof *length);
    if (!length) return err_nomem(err, "residuals", n * sizeof *length);
    for (size_t i = 0; i < n; i++) {
        double r[2] = {0, 0};
        const bool has = residual_of(b, &b->observations[i], r);
        length[i] = has ? hypot(r[0], r[1]) : 1e6; /* behind the camera: as bad as any */
    }
    sort_doubles(length, n);
    fit->median = n ? (length[(n - 1) / 2] + length[n / 2]) / 2 : 0;
    double square = fmax(fit->median * fit->median / 2, MIN_NOISE * MIN_NOISE);
    for (int round = 0; round < 200; round++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += (FREEDOM + 2) / (FREEDOM + length[i] * length[i] / square) * length[i] * length[i];
        const double next = fmax(n ? sum / (2 * (double)n) : 0, MIN_NOISE * MIN_NOISE);
        const bool same = fabs(next - square) <= 1e-9 * square;
        square = next;
        if (same) break;
    }
    double minus_log = (double)n * log(2 * PI * square); /* minus the log likelihood */
    for (size_t i = 0; i < n; i++) minus_log += (FREEDOM + 2) / 2 * log1p(length[i] * length[i] / (FREEDOM * square));
    fit->noise = sqrt(square);
    fit->bic = 2 * minus_log + fit->parameters * log(fmax((double)n, 1));
    free(length);
    return ST_OK;
}

void bundle_prune(struct bundle *b)
{
    size_t kept = 0;
    for (size_t i = 0; i < b->observation_count; i++) {
        double r[2];
        if (residual_of(b, &b->observations[i], r)) b->observations[kept++] = b->observations[i];
    }
    b->observation_count = kept;
}

void bundle_thin(struct bundle *b, size_t max_observations)
{
    const size_t every = (b->observation_count + max_observations - 1) / max_observations;
    size_t kept = 0;
    if (every < 2) return;
    for (size_t i = 0; i < b->observation_count; i++)
        if ((size_t)b->observations[i].point % every == 0) b->observations[kept++] = b->observations[i];
    b->observation_count = kept;
}

/* ------------------------------------------------------------------------------------------------- forms of lenses */

static bool is_single(enum camera_model model)
{
    return model == CAMERA_SIMPLE_PINHOLE || model == CAMERA_SIMPLE_RADIAL || model == CAMERA_RADIAL;
}

/* Lenses that can take another model: those whose distortion is a polynomial of two terms at most. */
static bool is_convertible(enum camera_model model)
{
    return is_single(model) || model == CAMERA_PINHOLE || model == CAMERA_OPENCV;
}

/* The lens in another model, as near as that one comes. */
static struct camera convert(const struct camera *c, enum camera_model model)
{
    struct camera to = {.model = model, .width = c->width, .height = c->height};
    const int from_first = is_single(c->model) ? 3 : 4, to_first = is_single(model) ? 3 : 4;
    const int from_terms = camera_model_params(c->model) - from_first;
    double fx, fy, cx, cy;
    camera_focal(c, &fx, &fy, &cx, &cy);
    to.params[0] = is_single(model) ? sqrt(fx * fy) : fx;
    to.params[1] = fy;
    to.params[to_first - 2] = cx;
    to.params[to_first - 1] = cy;
    for (int i = 0; i < camera_model_params(model) - to_first; i++)
        to.params[to_first + i] = i < from_terms ? c->params[from_first + i] : 0;
    return to;
}

bool bundle_can_convert(const struct bundle *b)
{
    bool any = false;
    for (int i = 0; i < b->lens_count; i++) any = any || is_convertible(b->lenses[i].camera.model);
    return any;
}

/* The power of the radius that a parameter of the distortion scales, relative to the undistorted one; 0: tangential. */
static int radial_power(enum camera_model model, int param)
{
    const int first = is_single(model) ? 3 : 4, k = param - first;
    if (model == CAMERA_OPENCV || model == CAMERA_FULL_OPENCV) {
        if (k == 2 || k == 3) return 0;
        if (k > 3) return k == 4 ? 6 : 2 * (k - 4); /* k3 of the numerator, k4 to k6 of the denominator */
    }
    return 2 * (k + 1);
}

/* The priors of a lens around its present parameters. */
static void set_priors(struct bundle_lens *l)
{
    const struct camera *c = &l->camera;
    const int center = is_single(c->model) ? 1 : 2;
    const double corner = hypot(c->width, c->height) / 2 / c->params[0]; /* radius, in focal lengths */
    for (int k = 0; k < camera_model_params(c->model); k++) {
        l->expected[k] = c->params[k];
        if (k < center)
            l->sigma[k] = FOCAL_SIGMA * c->params[k];
        else if (k < center + 2)
            l->sigma[k] = CENTER_SIGMA * fmax(c->width, c->height);
        else if (radial_power(c->model, k))
            l->sigma[k] = RADIAL_SIGMA / pow(corner, radial_power(c->model, k));
        else
            l->sigma[k] = TANGENTIAL_SIGMA;
    }
    l->aspect = c->params[1] / c->params[0];
    l->aspect_sigma = !is_single(c->model) && l->free[0] ? ASPECT_SIGMA : 0;
}

static void take_form(struct bundle *b, const struct lens_form *form)
{
    for (int i = 0; i < b->lens_count; i++) {
        struct bundle_lens *l = &b->lenses[i];
        if (!form->model_kept && !form->lens_kept && is_convertible(l->camera.model))
            l->camera = convert(&l->camera, form->model);
        const int center = is_single(l->camera.model) ? 1 : 2;
        for (int k = 0; k < camera_model_params(l->camera.model); k++) {
            const bool of_center = k == center || k == center + 1;
            l->free[k] = !form->lens_kept && (!of_center || form->center != CENTER_KEPT) &&
                         (k < center + 2 || !form->focal_only);
        }
        set_priors(l);
    }
}

/* Whether all that was adjusted is within MAX_SIGMAS of its prior. */
static bool is_plausible(const struct bundle *b)
{
    for (int i = 0; i < b->lens_count; i++) {
        const struct bundle_lens *l = &b->lenses[i];
        const double *p = l->camera.params;
        for (int k = 0; k < camera_model_params(l->camera.model); k++)
            if (l->free[k] && fabs(p[k] - l->expected[k]) > MAX_SIGMAS * l->sigma[k]) return false;
    }
    for (int i = 0; i < b->image_count && b->shift_sigma > 0; i++)
        if (hypot(b->images[i].shift[0], b->images[i].shift[1]) > MAX_SIGMAS * b->shift_sigma) return false;
    return true;
}

static int count_parameters(const struct bundle *b, const struct lens_form *form)
{
    int count = 0;
    for (int i = 0; i < b->lens_count; i++) {
        bool used = false;
        for (int k = 0; k < b->image_count; k++) used = used || (b->images[k].lens == i && !b->images[k].fixed);
        for (int k = 0; used && k < camera_model_params(b->lenses[i].camera.model); k++) count += b->lenses[i].free[k];
    }
    for (int k = 0; k < b->image_count; k++)
        count += form->center == CENTER_PER_PHOTO && !form->lens_kept && !b->images[k].fixed ? 2 : 0;
    return count;
}

/* Whether the picture's corners have rays if they had in `before`: a distortion may fit the features, and fold beyond
 * them. */
static bool folds(const struct camera *c, const struct camera *before)
{
    for (int k = 0; k < 4; k++) {
        const double u = k & 1 ? c->width : 0, v = k >> 1 ? c->height : 0;
        struct vec3 ray;
        if (camera_unproject(before, u, v, &ray) && !camera_unproject(c, u, v, &ray)) return true;
    }
    return false;
}

enum status bundle_adjust(struct bundle_fit *fit, struct bundle *b, const struct lens_form *form, double shift_sigma,
                          struct err *err)
{
    struct camera *before = calloc((size_t)b->lens_count + 1, sizeof *before);
    if (!before) return err_nomem(err, "lenses", (size_t)b->lens_count * sizeof *before);
    for (int i = 0; i < b->lens_count; i++) before[i] = b->lenses[i].camera;
    take_form(b, form);
    b->shift_sigma = form->center == CENTER_PER_PHOTO && !form->lens_kept ? shift_sigma : 0;
    *fit = (struct bundle_fit){.parameters = count_parameters(b, form)};
    if (!ceres_bundle_adjust(b, err)) bundle_measure(fit, b, err);
    for (int i = 0; !err->status && i < b->lens_count; i++)
        if (folds(&b->lenses[i].camera, &before[i]))
            err_set(err, ST_DATA, "the adjusted lens folds inside the picture");
    if (!err->status && !is_plausible(b)) err_set(err, ST_DATA, "the adjusted lens is implausible");
    free(before);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- the result */

enum status bundle_store(struct sfm_model *m, const struct bundle *b, const int *point_of, struct err *err)
{
    const bool shifted = b->shift_sigma > 0;
    const int count = shifted ? m->image_count : m->camera_count;
    struct sfm_camera *cameras = calloc((size_t)count + 1, sizeof *cameras);
    if (!cameras) return err_nomem(err, "cameras", (size_t)count * sizeof *cameras);
    for (int i = 0; i < count; i++) {
        const struct bundle_lens *l = &b->lenses[shifted ? b->images[i].lens : i];
        cameras[i] = (struct sfm_camera){shifted ? i + 1 : m->cameras[i].id, l->camera};
        if (!shifted) continue;
        const int center = is_single(l->camera.model) ? 1 : 2;
        for (int k = 0; k < 2; k++) cameras[i].camera.params[center + k] += b->images[i].shift[k];
    }
    for (int i = 0; i < m->image_count; i++) {
        const struct bundle_image *im = &b->images[i];
        const double *q = im->rotation, *t = im->translation;
        m->images[i].cam_from_world = (struct pose){{q[0], q[1], q[2], q[3]}, {t[0], t[1], t[2]}};
        if (shifted) m->images[i].camera_idx = i;
    }
    for (int i = 0; i < m->point_count; i++) m->points[i].error = -1; /* what was stated holds no more */
    for (int i = 0; i < b->point_count; i++)
        m->points[point_of[i]].position = vec3_make(b->points[i][0], b->points[i][1], b->points[i][2]);
    free(m->cameras);
    m->cameras = cameras;
    m->camera_count = count;
    return ST_OK;
}
