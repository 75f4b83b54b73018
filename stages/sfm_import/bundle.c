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
 * Poses that a user gave are trusted as far as the residuals with them allow: noise of s px is what rotations off by
 * s / f, or centres off by that times the distance of the points, would cause, and so are their priors. Without them a
 * camera slides along directions that its few points do not determine. Given images at one place are cut from one
 * picture, or from a camera on a tripod, and have one centre.
 *
 * The lenses of a multi-lens camera keep their poses in its body, so the pose of an image is that of the body at its
 * capture, followed by that of the lens in the body [Schneider 2012]. Both are unknown, and tie the images (rig.c). The
 * ties are elastic, by RIG_FLEX of what noise does to a pose: hundreds of observations determine a pose to a tenth of
 * that or less, and a tie must be stronger than all of them.
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
#define SAME_PLACE       1e-5  /* given centres nearer to each other, in parts of their extent, are one */
#define REDUNDANCY       3.0   /* numbers for each unknown of a given pose that is adjusted */
#define RIG_FLEX         0.003 /* of a rig's lenses, in parts of what noise of the residuals does to a pose */
#define MAX_SIGMAS       4.0   /* a parameter farther off shows that something else is wrong */
enum { MIN_OBSERVATIONS = 6 }; /* of an image; with fewer its pose is kept */

/* ---------------------------------------------------------------------------------------------------- the problem */

static struct quat rotation_of(const struct bundle_image *im)
{
    return (struct quat){im->rotation[0], im->rotation[1], im->rotation[2], im->rotation[3]};
}

static bool residual_of(const struct bundle *b, const struct bundle_observation *o, double r[2])
{
    const struct bundle_image *im = &b->images[o->image];
    const struct mat3 turn = mat3_from_quat(rotation_of(im));
    const double *x = b->points[o->point], *c = b->stations[im->station].center;
    double u, v;
    const struct vec3 p = mat3_apply(turn, vec3_make(x[0] - c[0], x[1] - c[1], x[2] - c[2]));
    if (!camera_project(&b->lenses[im->lens].camera, p, &u, &v)) return false;
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

/* Adds the observations of a point that have a residual, if they are from two stations: else its distance is unknown.
 * Without `quota` or if one of the images has fewer observations than the quota. */
static void add_point(struct bundle *b, int *point_of, int *in_image, const struct sfm_model *m, int point, int quota)
{
    const struct sfm_point *p = &m->points[point];
    const size_t before = b->observation_count;
    bool wanted = !quota, parallax = false;
    b->points[b->point_count][0] = p->position.x;
    b->points[b->point_count][1] = p->position.y;
    b->points[b->point_count][2] = p->position.z;
    for (int k = 0; k < p->track_count; k++) {
        const struct sfm_track *t = &p->track[k];
        const struct sfm_observation *o = &m->images[t->image_idx].observations[t->observation_idx];
        const struct bundle_observation seen = {t->image_idx, b->point_count, o->u, o->v};
        double r[2];
        if (!residual_of(b, &seen, r)) continue;
        parallax = parallax || (b->observation_count > before &&
                                b->images[t->image_idx].station != b->images[b->observations[before].image].station);
        wanted = wanted || in_image[t->image_idx] < quota;
        b->observations[b->observation_count++] = seen;
    }
    if (!wanted || !parallax) {
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
    for (int i = 0; !err->status && i < m->image_count; i++) {
        struct bundle_image *im = &b->images[i];
        im->fixed = in_image[i] < MIN_OBSERVATIONS;
        b->stations[im->station].fixed = b->stations[im->station].fixed || im->fixed;
    }
    free(order);
    free(in_image);
    return err->status;
}

/* The unknowns are one allocation, see struct bundle. Stations, captures and mounts are as many as images at most. */
static enum status allocate(struct bundle *b, int lenses, int images, int points, size_t observations, struct err *err)
{
    const size_t of_lenses = (size_t)lenses * sizeof *b->lenses, of_images = (size_t)images * sizeof *b->images;
    const size_t of_stations = (size_t)images * sizeof *b->stations, of_frames = (size_t)images * sizeof *b->captures;
    const size_t of_cameras = of_lenses + of_stations + of_images + 2 * of_frames;
    char *memory = calloc(1, of_cameras + ((size_t)points + 1) * sizeof *b->points);
    b->lenses = (struct bundle_lens *)memory;
    b->observations = calloc(observations + 1, sizeof *b->observations);
    if (!memory || !b->observations) {
        bundle_release(b);
        return err_nomem(err, "a bundle", observations * sizeof *b->observations);
    }
    b->stations = (struct bundle_station *)(memory + of_lenses);
    b->images = (struct bundle_image *)(memory + of_lenses + of_stations);
    b->captures = (struct bundle_frame *)(memory + of_lenses + of_stations + of_images);
    b->mounts = (struct bundle_frame *)(memory + of_lenses + of_stations + of_images + of_frames);
    b->points = (double(*)[3])(memory + of_cameras);
    return ST_OK;
}

static double distance_between(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* The extent of the stations: the largest distance from the first one. */
static double extent_of(const struct bundle *b)
{
    double extent = 0;
    for (int i = 0; i < b->station_count; i++)
        extent = fmax(extent, distance_between(b->stations[0].center, b->stations[i].center));
    return extent;
}

/* Each image at a station of its own; given ones that are at one place at one station. */
static void place_images(struct bundle *b, const struct sfm_model *m, enum bundle_poses poses)
{
    double extent = 0;
    for (int pass = 0; pass < 2; pass++) {
        b->station_count = 0;
        for (int i = 0; i < m->image_count; i++) {
            const struct pose *pose = &m->images[i].cam_from_world;
            const struct quat q = pose->rotation;
            const struct vec3 c = pose_center(pose);
            const struct bundle_station here = {.center = {c.x, c.y, c.z}, .expected = {c.x, c.y, c.z}};
            int at = pass && poses == POSES_GIVEN ? 0 : b->station_count;
            while (at < b->station_count && distance_between(b->stations[at].center, here.center) > SAME_PLACE * extent)
                at++;
            if (at == b->station_count) b->stations[b->station_count++] = here;
            b->images[i] = (struct bundle_image){.lens = m->images[i].camera_idx,
                                                 .station = at,
                                                 .capture = -1,
                                                 .mount = -1,
                                                 .rotation = {q.w, q.x, q.y, q.z},
                                                 .expected = {q.w, q.x, q.y, q.z}};
        }
        extent = extent_of(b);
    }
}

/* Holds the given images and stations that the observations do not determine well. An observation has two numbers, and
 * a point seen by n images takes three of its 2 n for itself, so 2 - 3 / n are left for each image. An image needs
 * REDUNDANCY times as many numbers as its rotation and its share of its station's centre have unknowns, a station as
 * many as all of its images that are adjusted. */
static enum status hold_weak(struct bundle *b, struct err *err)
{
    double *numbers = calloc((size_t)b->image_count + 1, sizeof *numbers);
    int *shared = calloc((size_t)b->station_count + 1, sizeof *shared);
    if (!numbers || !shared) err_nomem(err, "images", (size_t)b->image_count * sizeof *numbers);
    for (size_t from = 0, end; !err->status && from < b->observation_count; from = end) {
        for (end = from; end < b->observation_count && b->observations[end].point == b->observations[from].point;)
            end++;
        for (size_t i = from; i < end; i++) numbers[b->observations[i].image] += 2 - 3 / (double)(end - from);
    }
    for (int i = 0; !err->status && i < b->image_count; i++) shared[b->images[i].station]++;
    for (int i = 0; !err->status && i < b->image_count; i++) {
        struct bundle_image *im = &b->images[i];
        im->fixed = numbers[i] < REDUNDANCY * (3 + 3.0 / shared[im->station]);
    }
    for (int s = 0; !err->status && s < b->station_count; s++) {
        double sum = 0, unknowns = 3;
        for (int i = 0; i < b->image_count; i++) {
            if (b->images[i].station != s || b->images[i].fixed) continue;
            sum += numbers[i];
            unknowns += 3;
        }
        b->stations[s].fixed = sum < REDUNDANCY * unknowns;
    }
    free(numbers);
    free(shared);
    return err->status;
}

/* What noise of the residuals, px, does to a pose: the angle that it is, and the length that this angle is at the
 * points' median distance; 0 without observations. */
static enum status noise_of_pose(double *turn, double *length, const struct bundle *b, double noise, struct err *err)
{
    double *distance = malloc((b->observation_count + 1) * sizeof *distance);
    double *focal = malloc((b->observation_count + 1) * sizeof *focal);
    *turn = *length = 0;
    if (!distance || !focal) err_nomem(err, "distances", b->observation_count * sizeof *distance);
    for (size_t i = 0; !err->status && i < b->observation_count; i++) {
        const struct bundle_observation *o = &b->observations[i];
        const struct bundle_image *im = &b->images[o->image];
        distance[i] = distance_between(b->points[o->point], b->stations[im->station].center);
        focal[i] = b->lenses[im->lens].camera.params[0];
    }
    if (!err->status && b->observation_count) {
        sort_doubles(distance, b->observation_count);
        sort_doubles(focal, b->observation_count);
        const size_t middle = b->observation_count / 2;
        *turn = noise / focal[middle];
        *length = *turn * distance[middle];
    }
    free(distance);
    free(focal);
    return err->status;
}

enum status bundle_trust_poses(struct bundle *b, double noise, struct err *err)
{
    return noise_of_pose(&b->turn_sigma, &b->center_sigma, b, noise, err);
}

enum status bundle_trust_rig(struct bundle *b, double noise, struct err *err)
{
    return noise_of_pose(&b->mount_turn_sigma, &b->mount_sigma, b, RIG_FLEX * noise, err);
}

enum status bundle_make(struct bundle *b, int **point_of, const struct sfm_model *m, enum bundle_poses poses,
                        size_t max_observations, struct err *err)
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
    if (!err->status) place_images(b, m, poses);
    if (!err->status && !add_points(b, *point_of, m, max_observations, total, err) && poses == POSES_GIVEN)
        hold_weak(b, err);
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
    memcpy(to->stations, from->stations, (size_t)from->image_count * sizeof *to->stations);
    memcpy(to->images, from->images, (size_t)from->image_count * sizeof *to->images);
    memcpy(to->captures, from->captures, (size_t)from->image_count * sizeof *to->captures);
    memcpy(to->mounts, from->mounts, (size_t)from->image_count * sizeof *to->mounts);
    memcpy(to->points, from->points, (size_t)from->point_count * sizeof *to->points);
    memcpy(to->observations, from->observations, from->observation_count * sizeof *to->observations);
    return ST_OK;
}

void bundle_release(struct bundle *b)
{
    if (!b) return;
    free(b->lenses); /* and the other unknowns after them */
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

void bundle_keep_fold(struct bundle *b, int fold, int folds, bool others)
{
    size_t kept = 0;
    for (size_t i = 0; i < b->observation_count; i++)
        if ((b->observations[i].point % folds == fold) != others) b->observations[kept++] = b->observations[i];
    b->observation_count = kept;
}

void bundle_add_costs(double *cost, const struct bundle *b)
{
    for (size_t i = 0; i < b->observation_count; i++) {
        double r[2] = {0, 0};
        const bool has = residual_of(b, &b->observations[i], r);
        const double square = has ? r[0] * r[0] + r[1] * r[1] : 1e6; /* behind the camera: as bad as any */
        cost[b->observations[i].point] += (FREEDOM + 2) * log1p(square / (FREEDOM * b->noise * b->noise));
    }
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

/* Lenses that can take another model: those whose distortion is a polynomial of two terms at most. */
static bool is_convertible(enum camera_model model)
{
    return model == CAMERA_SIMPLE_PINHOLE || model == CAMERA_SIMPLE_RADIAL || model == CAMERA_RADIAL ||
           model == CAMERA_PINHOLE || model == CAMERA_OPENCV;
}

/* The lens in another model, as near as that one comes. */
static struct camera convert(const struct camera *c, enum camera_model model)
{
    struct camera to = {.model = model, .width = c->width, .height = c->height};
    const int from_first = camera_model_has_one_focal(c->model) ? 3 : 4,
              to_first = camera_model_has_one_focal(model) ? 3 : 4;
    const int from_terms = camera_model_params(c->model) - from_first;
    double fx, fy, cx, cy;
    camera_focal(c, &fx, &fy, &cx, &cy);
    to.params[0] = camera_model_has_one_focal(model) ? sqrt(fx * fy) : fx;
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
    const int first = camera_model_has_one_focal(model) ? 3 : 4, k = param - first;
    if (model == CAMERA_THIN_PRISM_FISHEYE && (k == 2 || k == 3 || k > 5)) return 0; /* prisms are as weak */
    if (model == CAMERA_THIN_PRISM_FISHEYE && k > 3) return 2 * (k - 1);
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
    const int center = camera_model_has_one_focal(c->model) ? 1 : 2;
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
    l->aspect_sigma = !camera_model_has_one_focal(c->model) && l->free[0] ? ASPECT_SIGMA : 0;
}

static void take_form(struct bundle *b, const struct lens_form *form)
{
    for (int i = 0; i < b->lens_count; i++) {
        struct bundle_lens *l = &b->lenses[i];
        if (!form->model_kept && !form->lens_kept && is_convertible(l->camera.model))
            l->camera = convert(&l->camera, form->model);
        const int center = camera_model_has_one_focal(l->camera.model) ? 1 : 2;
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

void bundle_take_cameras(struct bundle *b, const struct bundle *from)
{
    for (int i = 0; i < b->lens_count; i++) b->lenses[i] = from->lenses[i];
    for (int i = 0; i < b->image_count; i++) {
        const bool fixed = b->images[i].fixed;
        b->images[i] = from->images[i];
        b->images[i].fixed = fixed;
        b->captures[i] = from->captures[i];
        b->mounts[i] = from->mounts[i];
    }
    for (int i = 0; i < b->station_count; i++) {
        const bool fixed = b->stations[i].fixed;
        b->stations[i] = from->stations[i];
        b->stations[i].fixed = fixed;
    }
}

enum status bundle_adjust_points(struct bundle *b, struct err *err)
{
    b->points_only = true;
    ceres_bundle_adjust(b, err);
    b->points_only = false;
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- the result */

static struct pose pose_of(const struct bundle *b, int image)
{
    const struct bundle_image *im = &b->images[image];
    const double *c = b->stations[im->station].center;
    const struct quat q = rotation_of(im);
    return (struct pose){q, vec3_scale(mat3_apply(mat3_from_quat(q), vec3_make(c[0], c[1], c[2])), -1)};
}

/* Moves all points of a model along with the first image that sees them. */
static void carry_points(struct sfm_model *m, const struct bundle *b)
{
    for (int i = 0; i < m->point_count; i++) {
        struct sfm_point *p = &m->points[i];
        if (!p->track_count) continue;
        const int image = p->track[0].image_idx;
        const struct pose to = pose_of(b, image);
        const struct vec3 seen = pose_apply(&m->images[image].cam_from_world, p->position);
        p->position = mat3_apply(mat3_transpose(mat3_from_quat(to.rotation)), vec3_sub(seen, to.translation));
    }
}

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
        const int center = camera_model_has_one_focal(l->camera.model) ? 1 : 2;
        for (int k = 0; k < 2; k++) cameras[i].camera.params[center + k] += b->images[i].shift[k];
    }
    carry_points(m, b); /* those that are not adjusted */
    for (int i = 0; i < m->image_count; i++) {
        const struct bundle_image *im = &b->images[i];
        if (!im->fixed || !b->stations[im->station].fixed) m->images[i].cam_from_world = pose_of(b, i);
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
