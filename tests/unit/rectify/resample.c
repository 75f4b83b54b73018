/* resample.c - photographs of known textures through known lenses: position and sharpness of the result.
 *
 * Lens models are implemented here independently, to detect mistakes in common/capture/camera.c. The response of a
 * Lanczos-3 filter to a grating follows from its definition: kernel_gain(). */
#include "tests/unit/scratch.h"

#include <complex.h>
#include <math.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "stages/rectify/resample.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static const struct mat3 same_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static struct mat3 turn(double degrees, double x, double y, double z)
{
    double half = degrees * M_PI / 360, length = sqrt(x * x + y * y + z * z), s = sin(half) / length;
    return mat3_from_quat((struct quat){cos(half), s * x, s * y, s * z});
}

static struct view make_view(int width, int height, double fx, double fy, double cx, double cy)
{
    return (struct view){.name = "view",
                         .width = width,
                         .height = height,
                         .fx = fx,
                         .fy = fy,
                         .cx = cx,
                         .cy = cy,
                         .cam_from_world = same_axes};
}

static struct view centred_view(int width, int height, double focal)
{
    return make_view(width, height, focal, focal, width / 2.0, height / 2.0);
}

static struct camera pinhole(int width, int height, double focal)
{
    return (struct camera){CAMERA_SIMPLE_PINHOLE, width, height, {focal, width / 2.0, height / 2.0}};
}

static struct image make_photo(int width, int height)
{
    struct image photo;
    struct err err = ERR_INIT;
    assert_ok(image_init(&photo, width, height, 3, &err), err);
    return photo;
}

/* A checkerboard of single pixels. */
static struct image checkerboard(int width, int height)
{
    struct image photo = make_photo(width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) image_at(&photo, x, y)[c] = (float)((x + y) & 1);
    return photo;
}

static struct image noise(int width, int height)
{
    struct image photo = make_photo(width, height);
    struct rng rng = rng_make(5, "resample", "test");
    for (int i = 0; i < width * height * 3; i++) photo.data[i] = (float)(3 * rng_uniform(&rng, (uint64_t)i, 0));
    return photo;
}

/* Resamples, and checks what holds for every view: samples are finite and within the photo's range; alpha is 0 or 1;
 * colour is 0 where alpha is. */
static struct image look(const struct image *photo, const struct camera *lens, struct mat3 photo_from_view,
                         const struct view *view)
{
    struct image out = {0};
    struct err err = ERR_INIT;
    float min = INFINITY, max = -INFINITY;
    for (size_t i = 0; i < (size_t)photo->width * (size_t)photo->height * 3; i++) {
        min = fminf(min, photo->data[i]);
        max = fmaxf(max, photo->data[i]);
    }
    assert_ok(
        resample_photo(&out, NULL, &(struct resample_source){.linear = photo}, lens, &photo_from_view, view, &err),
        err);
    assert_true(out.width == view->width && out.height == view->height && out.channels == 4);
    for (size_t i = 0; i < (size_t)out.width * (size_t)out.height; i++) {
        const float *p = out.data + 4 * i;
        assert_true(p[3] == 0 || p[3] == 1);
        for (int c = 0; c < 3; c++) assert_true(p[3] == 1 ? p[c] >= min && p[c] <= max : p[c] == 0);
    }
    return out;
}

/* ------------------------------------------------------------------------------------------- the filter's
 * mathematics */

static double lanczos(double x)
{
    if (x == 0) return 1;
    if (fabs(x) >= 3) return 0;
    return sin(M_PI * x) / (M_PI * x) * sin(M_PI * x / 3) / (M_PI * x / 3);
}

enum { PHASES = 64 }; /* positions of the filter's centre between two samples */

/* The response of the filter of half width 3 `scale` to e^(2 pi i f x), relative to the value at its centre. */
static double complex gain_at(double f, double scale, double phase)
{
    double complex sum = 0;
    double weights = 0;
    for (int n = (int)floor(-3 * scale); n <= (int)ceil(3 * scale) + 1; n++) {
        double x = n - phase, k = lanczos(x / scale);
        sum += k * cexp(2 * M_PI * I * f * x);
        weights += k;
    }
    return sum / weights;
}

/* The largest remaining amplitude of a grating of f cycles per sample, for any position of the filter. */
static double kernel_gain(double f, double scale)
{
    double max = 0;
    for (int p = 0; p < PHASES; p++) max = fmax(max, cabs(gain_at(f, scale, (double)p / PHASES)));
    return max;
}

/* The largest change of a grating, relative to its amplitude, for scales up to `widest`. */
static double kernel_change(double f, double widest)
{
    double max = 0;
    for (double scale = 1; scale <= widest; scale += 0.05)
        for (int p = 0; p < PHASES; p++) max = fmax(max, cabs(gain_at(f, scale, (double)p / PHASES) - 1));
    return max;
}

/* The offset of the filter's centre of gravity, in samples: the error of a ramp. */
static double kernel_shift(double narrowest, double widest)
{
    double max = 0;
    for (double scale = narrowest; scale <= widest; scale += 0.05)
        for (int p = 0; p < PHASES; p++) {
            double sum = 0, weights = 0, phase = (double)p / PHASES;
            for (int n = (int)floor(-3 * scale); n <= (int)ceil(3 * scale) + 1; n++) {
                sum += lanczos((n - phase) / scale) * (n - phase);
                weights += lanczos((n - phase) / scale);
            }
            max = fmax(max, fabs(sum / weights));
        }
    return max;
}

/* The error of float arithmetic and of the kernel's table, in samples. */
static const double rounding = 1e-3;

/* ------------------------------------------------------------------------------------------------------------
 * lenses */

/* Textbook formulas for the projection of a ray in the photo's axes. */
static void lens_pixel(const struct camera *lens, struct vec3 ray, double *u, double *v)
{
    const double *p = lens->params;
    double x = ray.x / ray.z, y = ray.y / ray.z, r2 = x * x + y * y, r4 = r2 * r2, r6 = r2 * r4;
    switch (lens->model) {
    case CAMERA_SIMPLE_RADIAL:
        *u = p[0] * x * (1 + p[3] * r2) + p[1];
        *v = p[0] * y * (1 + p[3] * r2) + p[2];
        break;
    case CAMERA_OPENCV:
        *u = p[0] * (x * (1 + p[4] * r2 + p[5] * r4) + 2 * p[6] * x * y + p[7] * (r2 + 2 * x * x)) + p[2];
        *v = p[1] * (y * (1 + p[4] * r2 + p[5] * r4) + 2 * p[7] * x * y + p[6] * (r2 + 2 * y * y)) + p[3];
        break;
    case CAMERA_OPENCV_FISHEYE: {
        double off = hypot(ray.x, ray.y), t = atan2(off, ray.z), t2 = t * t;
        double td = t * (1 + t2 * (p[4] + t2 * (p[5] + t2 * (p[6] + t2 * p[7]))));
        *u = p[0] * (off > 0 ? td * ray.x / off : 0) + p[2];
        *v = p[1] * (off > 0 ? td * ray.y / off : 0) + p[3];
        break;
    }
    case CAMERA_FULL_OPENCV: {
        double g = (1 + p[4] * r2 + p[5] * r4 + p[8] * r6) / (1 + p[9] * r2 + p[10] * r4 + p[11] * r6);
        *u = p[0] * (x * g + 2 * p[6] * x * y + p[7] * (r2 + 2 * x * x)) + p[2];
        *v = p[1] * (y * g + 2 * p[7] * x * y + p[6] * (r2 + 2 * y * y)) + p[3];
        break;
    }
    default:
        *u = *v = -1;
        fail_msg("no formula for %s", camera_model_name(lens->model));
    }
}

static struct vec3 view_ray(const struct view *view, int x, int y)
{
    return vec3_make((x + 0.5 - view->cx) / view->fx, (y + 0.5 - view->cy) / view->fy, 1);
}

static const struct camera lenses[] = {
    {CAMERA_SIMPLE_RADIAL, 640, 480, {500, 310, 250, -0.15}},
    {CAMERA_SIMPLE_RADIAL, 640, 480, {500, 330, 238, 0.25}},
    {CAMERA_OPENCV, 640, 480, {480, 500, 315, 236, -0.22, 0.04, -0.004, 0.006}},
    {CAMERA_OPENCV_FISHEYE, 600, 500, {300, 310, 305, 248, -0.03, 0.002, 0.0004, -0.0001}},
    {CAMERA_FULL_OPENCV, 640, 480, {420, 410, 318, 242, 0.4, 0.1, 0.001, 0.0005, 0.02, 0.7, 0.15, 0.01}},
};

/* Red is u and green is v, in [0, 1] across the photo: a view shows where its rays are projected. */
static struct image ramps(int width, int height)
{
    struct image photo = make_photo(width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            image_at(&photo, x, y)[0] = (float)((x + 0.5) / width);
            image_at(&photo, x, y)[1] = (float)((y + 0.5) / height);
        }
    return photo;
}

/* Errors are in photo pixels. */
static void ramps_are_where_the_lens_projects_them(void **state)
{
    static const double focals[] = {0.6, 1, 2.5}; /* relative to the lens's: reduced, equal, enlarged */
    const double widest = 3, bound = kernel_shift(1, widest) + rounding, border = 3 * widest + 1;
    (void)state;
    assert_true(bound < 0.025);
    for (size_t l = 0; l < COUNT(lenses); l++) {
        const struct camera *lens = &lenses[l];
        struct image photo = ramps(lens->width, lens->height);
        for (size_t f = 0; f < COUNT(focals); f++)
            for (int turned = 0; turned < 2; turned++) {
                struct mat3 photo_from_view = turned ? turn(14, 0.4, 1, 0.7) : same_axes;
                struct view view = make_view(301, 220, focals[f] * 500, focals[f] * 480, 147, 113);
                struct image out = look(&photo, lens, photo_from_view, &view);
                int compared = 0;
                for (int y = 0; y < out.height; y++)
                    for (int x = 0; x < out.width; x++) {
                        const float *p = image_at(&out, x, y);
                        double u, v;
                        lens_pixel(lens, mat3_apply(photo_from_view, view_ray(&view, x, y)), &u, &v);
                        double inside = fmin(fmin(u, photo.width - u), fmin(v, photo.height - v));
                        if (fabs(inside) > 1e-6) assert_true(p[3] == (inside > 0));
                        if (inside < border) continue;
                        assert_true(fabs(p[0] * photo.width - u) < bound);
                        assert_true(fabs(p[1] * photo.height - v) < bound);
                        assert_true(p[2] == 0);
                        compared++;
                    }
                assert_true(compared > out.width * out.height / 4);
                image_release(&out);
            }
        image_release(&photo);
    }
}

/* A smooth texture at infinity, of amplitude 1/2. */
static double sky(struct vec3 d) { return 0.5 + 0.25 * sin(40 * d.x + 1) + 0.25 * cos(36 * d.y); }

static void a_distant_texture_matches_a_pinhole_camera(void **state)
{
    /* its period is at least 78 px at a focal length of 500; a lens may shrink that to 45 */
    const double f = 1 / 45.0, bound = 0.5 * kernel_change(f, 2) + 0.5 * (1 - cos(M_PI * f));
    (void)state;
    assert_true(bound < 0.01);
    for (size_t l = 0; l < COUNT(lenses); l++) {
        const struct camera *lens = &lenses[l];
        struct image photo = make_photo(lens->width, lens->height);
        for (int y = 0; y < photo.height; y++)
            for (int x = 0; x < photo.width; x++) {
                struct vec3 ray;
                assert_true(camera_unproject(lens, x + 0.5, y + 0.5, &ray));
                for (int c = 0; c < 3; c++) image_at(&photo, x, y)[c] = (float)sky(ray);
            }
        for (int turned = 0; turned < 3; turned++) {
            struct mat3 photo_from_view = turned ? turn(11, turned - 1, 1, 0.3) : same_axes;
            struct view view = make_view(210, 170, 400, 390, 101, 88);
            struct image out = look(&photo, lens, photo_from_view, &view);
            int compared = 0;
            for (int y = 0; y < out.height; y++)
                for (int x = 0; x < out.width; x++) {
                    struct vec3 ray = mat3_apply(photo_from_view, view_ray(&view, x, y));
                    double u, v;
                    lens_pixel(lens, ray, &u, &v);
                    if (!(fmin(fmin(u, photo.width - u), fmin(v, photo.height - v)) > 10)) continue;
                    for (int c = 0; c < 3; c++)
                        assert_true(fabs(image_at(&out, x, y)[c] - sky(vec3_normalize(ray))) < bound);
                    compared++;
                }
            assert_true(compared > out.width * out.height / 2);
            image_release(&out);
        }
        image_release(&photo);
    }
}

static void a_fisheye_view_covers_the_side(void **state)
{
    const double bound = kernel_shift(1, 3) + rounding;
    struct camera lens = {CAMERA_OPENCV_FISHEYE, 400, 400, {120, 120, 200, 200, 0, 0, 0, 0}}; /* 191 degrees across */
    struct image photo = ramps(400, 400);
    struct view view = centred_view(80, 60, 40);     /* 90 degrees across */
    struct mat3 photo_from_view = turn(85, 0, 1, 0); /* its axis is 85 degrees to the right */
    int beside = 0, outside = 0;
    (void)state;
    struct image out = look(&photo, &lens, photo_from_view, &view);
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 80; x++) {
            struct vec3 ray = mat3_apply(photo_from_view, view_ray(&view, x, y));
            const float *p = image_at(&out, x, y);
            double u, v;
            lens_pixel(&lens, ray, &u, &v);
            assert_true(p[3] == (u <= 400));
            outside += p[3] == 0;
            if (u > 390) continue;
            assert_true(fabs(p[0] * 400 - u) < bound && fabs(p[1] * 400 - v) < bound);
            beside += ray.z < 0;
        }
    assert_true(beside > 20 && outside > 500);
    image_release(&out);

    view = centred_view(80, 60, 80);
    out = look(&photo, &lens, turn(180, 0, 1, 0), &view); /* nothing behind the camera */
    for (int i = 0; i < 80 * 60 * 4; i++) assert_true(out.data[i] == 0);
    image_release(&out);
    image_release(&photo);
}

/* ------------------------------------------------------------------------------------------------- unchanged pixels */

static void the_photos_own_pinhole_camera_copies_its_pixels(void **state)
{
    static const struct camera cameras[] = {
        {CAMERA_PINHOLE, 37, 23, {41.5, 40.25, 17.125, 12.5}},
        {CAMERA_SIMPLE_PINHOLE, 37, 23, {41.5, 18.5, 11.5}},
    };
    struct image photo = noise(37, 23);
    photo.data[100] = 6e4F; /* must not affect its neighbour at all */
    photo.data[103] = 1e-12F;
    (void)state;
    for (size_t i = 0; i < COUNT(cameras); i++) {
        double fx, fy, cx, cy;
        camera_focal(&cameras[i], &fx, &fy, &cx, &cy);
        struct view view = make_view(37, 23, fx, fy, cx, cy);
        struct image out = look(&photo, &cameras[i], same_axes, &view);
        for (size_t k = 0; k < 37 * 23; k++) {
            assert_memory_equal(out.data + 4 * k, photo.data + 3 * k, 3 * sizeof(float));
            assert_true(out.data[4 * k + 3] == 1);
        }
        image_release(&out);
    }
    image_release(&photo);
}

static void a_nearly_identical_camera_is_resampled(void **state)
{
    struct image photo = noise(37, 23);
    (void)state;
    for (int i = 0; i < 6; i++) {
        struct camera lens = {CAMERA_PINHOLE, 37, 23, {41, 40, 18.5, 11.5}};
        double number[4] = {41, 40, 18.5, 11.5};
        if (i < 4) number[i] *= 1.1;
        if (i == 4) lens = (struct camera){CAMERA_SIMPLE_RADIAL, 37, 23, {41, 18.5, 11.5, -0.2}};
        if (i == 4) number[1] = 41;
        struct view view = make_view(37, 23, number[0], number[1], number[2], number[3]);
        struct image out = look(&photo, &lens, i == 5 ? turn(2, 1, 1, 1) : same_axes, &view);
        int differ = 0;
        for (int k = 0; k < 37 * 23; k++)
            differ += memcmp(out.data + 4 * k, photo.data + 3 * k, 3 * sizeof(float)) != 0;
        assert_true(differ > 37 * 23 / 2);
        image_release(&out);
    }
    image_release(&photo);
}

static void shifts_and_rotations_by_whole_pixels_do_not_blur(void **state)
{
    struct image photo = noise(40, 40);
    struct camera lens = pinhole(40, 40, 50);
    struct view view = make_view(40, 40, 50, 50, 23, 18);
    (void)state;
    struct image out = look(&photo, &lens, same_axes, &view); /* the view's (x, y) is the photo's (x - 3, y + 2) */
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 40; x++) {
            assert_true(image_at(&out, x, y)[3] == (x >= 3 && y < 38));
            for (int c = 0; c < 3 && x >= 3 && y < 38; c++)
                assert_true(fabsf(image_at(&out, x, y)[c] - image_at(&photo, x - 3, y + 2)[c]) < 1e-5F);
        }
    image_release(&out);

    view = centred_view(40, 40, 50);
    out = look(&photo, &lens, turn(90, 0, 0, 1), &view); /* x of the view is y of the photo */
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 40; x++)
            for (int c = 0; c < 3; c++)
                assert_true(fabsf(image_at(&out, x, y)[c] - image_at(&photo, 39 - y, x)[c]) < 1e-4F);
    image_release(&out);
    image_release(&photo);
}

/* ---------------------------------------------------------------------------------------------------------
 * reduction */

struct grating {
    double fx, fy; /* cycles per photo pixel */
};

static double grating_at(struct grating g, double x, double y)
{
    return 0.5 + 0.5 * cos(2 * M_PI * (g.fx * x + g.fy * y) + 0.3);
}

/* A photo of the grating at 1 / reduction of its size, offset from its grid by a quarter of a pixel. */
static struct image reduced_grating(struct grating g, int reduction, struct view *view)
{
    const int size = 24;
    struct image photo = make_photo(size * reduction, size * reduction);
    for (int y = 0; y < photo.height; y++)
        for (int x = 0; x < photo.width; x++)
            for (int c = 0; c < 3; c++) image_at(&photo, x, y)[c] = (float)grating_at(g, x + 0.5, y + 0.5);
    struct camera lens = pinhole(photo.width, photo.height, 300);
    *view = centred_view(size, size, 300.0 / reduction);
    view->cx += 0.25 / reduction;
    struct image out = look(&photo, &lens, same_axes, view);
    image_release(&photo);
    return out;
}

enum { EDGE = 4 }; /* view pixels whose filter crosses the photo's border */

/* Gratings too fine for the view: from 3/4 cycle per view pixel, including a checkerboard. The remaining energy follows
 * from the filter's gain and is small. */
static void reduction_does_not_alias(void **state)
{
    static const int reductions[] = {2, 4, 7, 20};
    (void)state;
    for (size_t i = 0; i < COUNT(reductions); i++) {
        const double s = reductions[i], fine = 0.75 / s;
        const struct grating gratings[] = {{0.5, 0.5},   {0.5, 0},     {0, 0.5},        {fine, 0},
                                           {0, fine},    {fine, fine}, {fine, 0.1 / s}, {(fine + 0.5) / 2, 0.45},
                                           {0.31, 0.43}, {0.43, -0.31}};
        for (size_t g = 0; g < COUNT(gratings); g++) {
            double gain = kernel_gain(gratings[g].fx, s) * kernel_gain(gratings[g].fy, s), energy = 0;
            struct view view;
            struct image out = reduced_grating(gratings[g], reductions[i], &view);
            assert_true(gain < 0.04);
            for (int y = EDGE; y < out.height - EDGE; y++)
                for (int x = EDGE; x < out.width - EDGE; x++) {
                    double off = image_at(&out, x, y)[0] - 0.5;
                    assert_true(fabs(off) <= 0.5 * gain + 1e-5);
                    energy += off * off;
                }
            energy /= (out.height - 2 * EDGE) * (out.width - 2 * EDGE);
            assert_true(energy <= 0.25 * gain * gain + 1e-9);
            image_release(&out);
        }
    }
}

/* Gratings that the view can resolve keep position and amplitude. Apart from the filter's gain, a crest may be clamped
 * to the highest sample nearby, at most half a pixel away. */
static void reduction_keeps_resolvable_detail(void **state)
{
    static const int reductions[] = {2, 4, 7};
    (void)state;
    for (size_t i = 0; i < COUNT(reductions); i++) {
        const double s = reductions[i];
        const struct grating gratings[] = {{0.1 / s, 0}, {0, 0.1 / s}, {0.15 / s, -0.07 / s}, {0.2 / s, 0.2 / s}};
        for (size_t g = 0; g < COUNT(gratings); g++) {
            double fx = fabs(gratings[g].fx), fy = fabs(gratings[g].fy), change = 0;
            for (int p = 0; p < PHASES; p++)
                for (int q = 0; q < PHASES; q += 4)
                    change =
                        fmax(change, cabs(gain_at(fx, s, (double)p / PHASES) * gain_at(fy, s, (double)q / PHASES) - 1));
            double bound = 0.5 * fmax(change, 1 - cos(M_PI * (fx + fy))) + 1e-5;
            struct view view;
            struct image out = reduced_grating(gratings[g], reductions[i], &view);
            assert_true(bound < 0.1);
            for (int y = EDGE; y < out.height - EDGE; y++)
                for (int x = EDGE; x < out.width - EDGE; x++) {
                    double u = (x + 0.5) * s - 0.25, v = (y + 0.5) * s;
                    assert_true(fabs(image_at(&out, x, y)[0] - grating_at(gratings[g], u, v)) <= bound);
                }
            image_release(&out);
        }
    }
}

/* With a reduction along one axis, the other stays sharp; the axes are the photo's, for any rotation of the view. */
static void each_axis_has_its_own_filter_width(void **state)
{
    struct image photo = make_photo(160, 40);
    struct camera lens = {CAMERA_PINHOLE, 160, 40, {100, 100, 80, 20}};
    (void)state;
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 160; x++) image_at(&photo, x, y)[x & 1] = image_at(&photo, x, y)[2] = (float)(y & 1);
    for (int turned = 0; turned < 2; turned++) {
        struct view view = turned ? make_view(40, 40, 100, 25, 20, 20.1) : make_view(40, 40, 25, 100, 20.1, 20);
        struct image out = look(&photo, &lens, turned ? turn(90, 0, 0, 1) : same_axes, &view);
        for (int y = 0; y < 40; y++)
            for (int x = EDGE; x < 40 - EDGE; x++) {
                const float *p = turned ? image_at(&out, y, x) : image_at(&out, x, y);
                for (int c = 0; c < 2; c++) assert_true(fabs(p[c] - 0.5 * (y & 1)) <= 0.5 * kernel_gain(0.5, 4) + 1e-4);
                assert_true(fabs(p[2] - (y & 1)) < 1e-4);
            }
        image_release(&out);
    }
    image_release(&photo);
}

/* A reduction of 200 is filtered like one of 64: nothing overflows, and uniform colour stays uniform. */
static void a_reduction_beyond_the_widest_filter_is_resampled(void **state)
{
    struct image photo = make_photo(1000, 800);
    struct camera lens = pinhole(1000, 800, 900);
    struct view view = centred_view(5, 4, 4.5);
    (void)state;
    for (size_t i = 0; i < 1000 * 800 * 3; i++) photo.data[i] = 0.1F;
    struct image out = look(&photo, &lens, same_axes, &view);
    for (int i = 0; i < 20; i++) assert_true(out.data[4 * i] == 0.1F && out.data[4 * i + 3] == 1);
    image_release(&out);
    image_release(&photo);

    photo = checkerboard(1000, 800);
    out = look(&photo, &lens, same_axes, &view);
    for (int i = 0; i < 20; i++) assert_true(fabs(out.data[4 * i] - 0.5) < 0.01);
    image_release(&out);
    view = centred_view(1, 1, 1e-9); /* the whole photo covers a millionth of the pixel */
    out = look(&photo, &lens, same_axes, &view);
    assert_true(out.data[3] == 1 && fabs(out.data[0] - 0.5) < 0.01);
    image_release(&out);
    image_release(&photo);
}

/* --------------------------------------------------------------------------------------------------- bright and
 * dark */

/* A bright window in a dark wall: in linear light a ringing filter would draw bright and dark lines around it, with
 * negative values on the wall. Farther than one lobe from the edge both keep their exact values. */
static void a_bright_window_has_no_halo(void **state)
{
    static const double reductions[] = {0.4, 1, 1.7, 2.6, 5};
    const int left = 90, right = 170, top = 80, bottom = 190;
    struct image photo = make_photo(260, 250);
    struct camera lens = pinhole(260, 250, 200);
    (void)state;
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++)
            for (int c = 0; c < 3; c++) image_at(&photo, x, y)[c] = 5000;
    for (size_t i = 0; i < COUNT(reductions); i++) {
        double s = reductions[i], lobe = fmax(s, 1) + 0.5;
        struct view view = centred_view((int)(260 / s), (int)(250 / s), 200 / s);
        view.cx += 0.3;
        view.cy -= 0.2;
        struct image out = look(&photo, &lens, same_axes, &view);
        int lit = 0, dark = 0;
        for (int y = 0; y < out.height; y++)
            for (int x = 0; x < out.width; x++) {
                const float *p = image_at(&out, x, y);
                double u = (x + 0.5 - view.cx) * s + 130, v = (y + 0.5 - view.cy) * s + 125;
                double in = fmin(fmin(u - left, right - u), fmin(v - top, bottom - v));
                if (in > lobe) {
                    assert_true(p[0] == 5000 && p[1] == 5000 && p[2] == 5000);
                    lit++;
                } else if (in < -lobe && p[3] == 1) {
                    assert_true(p[0] == 0 && p[1] == 0 && p[2] == 0);
                    dark++;
                }
                /* brightness rises monotonically from the wall into the window */
                if (x && v > top + lobe && v < bottom - lobe && u < 130) assert_true(p[0] >= p[-4]);
            }
        assert_true(lit > 100 && dark > 100);
        image_release(&out);
    }
    image_release(&photo);
}

/* ---------------------------------------------------------------------------------------------- outside the photo */

static void pixels_outside_the_photo_are_empty(void **state)
{
    struct image photo = noise(50, 30);
    struct camera lens = {CAMERA_SIMPLE_RADIAL, 50, 30, {40, 25, 15, 0.01}};
    struct view view = centred_view(120, 90, 40);
    (void)state;
    struct image out = look(&photo, &lens, same_axes, &view);
    int inside = 0;
    for (int y = 0; y < 90; y++)
        for (int x = 0; x < 120; x++) {
            double u, v;
            lens_pixel(&lens, view_ray(&view, x, y), &u, &v);
            bool in = u >= 0 && v >= 0 && u <= 50 && v <= 30;
            assert_true(image_at(&out, x, y)[3] == in);
            inside += in;
        }
    assert_true(inside > 1000);
    image_release(&out);
    image_release(&photo);
}

/* r (1 - 0.3 r^2) has its maximum at r^2 = 1 / 0.9: rays beyond are not in the photo. At that limit a pixel is filtered
 * even if its neighbour has no projection. */
static void rays_outside_the_lens_are_empty(void **state)
{
    struct image photo = checkerboard(640, 480);
    struct camera lens = {CAMERA_SIMPLE_RADIAL, 640, 480, {200, 320, 240, -0.3}};
    struct view view = centred_view(160, 140, 50);
    (void)state;
    struct image out = look(&photo, &lens, same_axes, &view);
    int ends = 0;
    for (int y = 0; y < 139; y++)
        for (int x = 0; x < 159; x++) {
            struct vec3 ray = view_ray(&view, x, y);
            const float *p = image_at(&out, x, y);
            assert_true(p[3] == ((ray.x * ray.x + ray.y * ray.y) * 0.9 < 1));
            if (p[3] == 0 || (p[7] == 1 && image_at(&out, x, y + 1)[3] == 1)) continue;
            assert_true(fabsf(p[0] - 0.5F) < 0.1F);
            ends++;
        }
    assert_true(ends > 100);
    image_release(&out);

    out = look(&photo, &lens, turn(180, 0, 1, 0), &view); /* nothing behind the camera */
    for (int i = 0; i < 160 * 140 * 4; i++) assert_true(out.data[i] == 0);
    image_release(&out);

    view = centred_view(40, 40, 1); /* half of the rays are more than 90 degrees off the lens's axis */
    out = look(&photo, &lens, turn(90, 0, 1, 0), &view);
    for (int i = 0; i < 40 * 40; i++) assert_true(out.data[4 * i + 3] == 0 || out.data[4 * i + 3] == 1);
    image_release(&out);
    image_release(&photo);
}

/* ----------------------------------------------------------------------------------------------------- sizes,
 * threads */

static void the_smallest_and_the_longest_sizes_are_resampled(void **state)
{
    struct image dot = noise(1, 1);
    struct camera lens = {CAMERA_SIMPLE_RADIAL, 1, 1, {1, 0.5, 0.5, 0.1}};
    struct view view = centred_view(1, 1, 3);
    (void)state;
    struct image out = look(&dot, &lens, same_axes, &view);
    assert_memory_equal(out.data, dot.data, 3 * sizeof(float));
    assert_true(out.data[3] == 1);
    image_release(&out);
    view = centred_view(9, 7, 10); /* a single pixel enlarged keeps its value */
    out = look(&dot, &lens, same_axes, &view);
    for (int i = 0; i < 63; i++) assert_memory_equal(out.data + 4 * i, dot.data, 3 * sizeof(float));
    image_release(&out);
    image_release(&dot);

    struct image strip = ramps(20000, 16);
    for (int i = 0; i < 20000 * 16; i++) strip.data[3 * i + 2] = 0.25F;
    lens = (struct camera){CAMERA_PINHOLE, 20000, 16, {9000, 9000, 10000, 8}};
    view = make_view(200, 1, 90, 9000 / 16.0, 100, 0.5); /* 100 to 1 along, 16 to 1 across */
    out = look(&strip, &lens, same_axes, &view);
    const double bound = kernel_shift(64, 64) + 64 * rounding;
    for (int x = 2; x < 198; x++) {
        assert_true(fabs(out.data[4 * x] * 20000.0 - (x + 0.5) * 100) < bound);
        assert_true(out.data[4 * x + 2] == 0.25F);
    }
    image_release(&out);
    lens =
        (struct camera){CAMERA_OPENCV, 20000, 16, {9000, 9000, 10000, 8, 0, 0, 0, 0}}; /* no distortion, but filtered */
    view = make_view(20000, 16, 9000, 9000, 10000, 8);
    out = look(&strip, &lens, same_axes, &view);
    for (int i = 0; i < 20000 * 16; i++) assert_true(fabsf(out.data[4 * i] - strip.data[3 * i]) < 1e-5F);
    image_release(&out);
    image_release(&strip);
}

static void the_result_does_not_depend_on_threads(void **state)
{
    const struct camera *lens = &lenses[2];
    struct image photo = noise(lens->width, lens->height);
    struct view view = make_view(190, 131, 210, 200, 91, 67);
    (void)state;
    parallel_set_threads(1);
    struct image one = look(&photo, lens, turn(5, 1, 1, 1), &view);
    for (int threads = 2; threads < 5; threads++) {
        parallel_set_threads(threads);
        struct image more = look(&photo, lens, turn(5, 1, 1, 1), &view);
        assert_memory_equal(one.data, more.data, 190 * 131 * 4 * sizeof(float));
        image_release(&more);
    }
    parallel_set_threads(0);
    image_release(&one);
    image_release(&photo);
}

static void a_photo_of_another_size_is_refused(void **state)
{
    struct image photo = noise(20, 10), out = {0};
    struct camera lens = pinhole(10, 20, 15);
    struct view view = centred_view(10, 20, 15);
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(
        resample_photo(&out, NULL, &(struct resample_source){.linear = &photo}, &lens, &same_axes, &view, &err),
        ST_DATA);
    assert_err(err, ST_DATA, "the photo has 20 x 10 pixels but its camera 10 x 20");
    assert_contains(err.text, "(SFM)");
    assert_null(out.data);
    image_release(&photo);
}

/* ------------------------------------------------------------------------------------------------ parts of photos */

/* Samples of 8 bits as samples or bytes, of 16 bits, and of a space of its own. */
static void store_photo(struct linear_photo *p, int width, int height, int kind)
{
    static const struct single_exposure assumed = {30000, 6, 0.95, 0.02};
    static const struct chromaticities p3 = {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}};
    struct rng rng = rng_make(8, "resample", "stored");
    struct err err = ERR_INIT;
    *p = (struct linear_photo){.width = width, .height = height};
    p->photo.info = (struct photo_info){.width = width, .height = height, .bits = kind == 2 ? 16 : 8};
    assert_ok(photo_init_samples(&p->photo, &err), err);
    for (int i = 0; i < width * height * 3; i++) /* dark and bright ones are marked */
        p->photo.samples[i] = (uint16_t)(rng_uniform(&rng, (uint64_t)i, 0) * (kind == 2 ? 65535.99 : 255.99));
    if (kind == 3) assert_ok(colour_space_from_primaries(&p->photo.space, &p3, 0, 8, "P3", &err), err);
    if (kind == 1) {
        p->photo.bytes = malloc((size_t)width * (size_t)height * 3);
        for (int i = 0; i < width * height * 3; i++) p->photo.bytes[i] = (uint8_t)p->photo.samples[i];
    }
    assert_ok(photo_light_init(&p->light, &p->photo, &err), err);
    photo_quality_judge_init(&p->judge, &p->photo, &assumed);
}

/* Through its own camera, a distorted lens, reductions so strong that tiles are halved, a turned wide lens. */
static void parts_give_the_same_picture_as_the_whole(void **state)
{
    enum { WIDE = 1500, HIGH = 1100 };
    const struct single_exposure assumed = {30000, 6, 0.95, 0.02};
    const struct camera cameras[] = {
        pinhole(WIDE, HIGH, 1200),
        {CAMERA_SIMPLE_RADIAL, WIDE, HIGH, {1200, WIDE / 2.0, HIGH / 2.0, -0.1}},
        pinhole(WIDE, HIGH, 1200),
        {CAMERA_OPENCV_FISHEYE, WIDE, HIGH, {420, 420, WIDE / 2.0, HIGH / 2.0, 0.01, 0, 0, 0}}};
    const struct view views[] = {centred_view(WIDE, HIGH, 1200), centred_view(700, 520, 600), centred_view(60, 44, 48),
                                 centred_view(500, 500, 250)};
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct linear_photo p;
        store_photo(&p, WIDE, HIGH, k);
        const struct mat3 axes = k == 3 ? turn(90, 0, 1, 0) : same_axes;
        struct image linear, out = {0}, parts = {0};
        struct photo_quality q = {0}, out_q = {0}, parts_q = {0};
        struct err err = ERR_INIT;
        assert_ok(photo_to_linear(&linear, &p.photo, &err), err);
        assert_ok(photo_quality_of_exposure(&q, &p.photo, &linear, &assumed, &err), err);
        const struct resample_source whole = {.linear = &linear, .quality = &q}, source = {.photo = &p};
        assert_ok(resample_photo(&out, &out_q, &whole, &cameras[k], &axes, &views[k], &err), err);
        assert_ok(resample_photo(&parts, &parts_q, &source, &cameras[k], &axes, &views[k], &err), err);
        const size_t pixels = (size_t)out.width * (size_t)out.height;
        int inside = 0;
        for (size_t i = 0; i < pixels; i++) inside += out.data[4 * i + 3] == 1;
        assert_true(inside > 0.2 * (double)pixels);
        assert_memory_equal(out.data, parts.data, pixels * 4 * sizeof(float));
        assert_memory_equal(out_q.variance, parts_q.variance, pixels * sizeof(float));
        assert_memory_equal(out_q.marks, parts_q.marks, pixels);
        image_release(&linear);
        image_release(&out);
        image_release(&parts);
        photo_quality_release(&q);
        photo_quality_release(&out_q);
        photo_quality_release(&parts_q);
        linear_photo_release(&p);
    }
}

/* ------------------------------------------------------------------------------------------------------------ masks */

/* With the photo's own camera, a reduction, and a distorted lens: no pixel shows light of the masked part, although
 * that is by far the brightest; out of its reach nothing changes. */
static void masked_pixels_are_empty(void **state)
{
    enum { SIDE = 60 };
    const struct camera cameras[] = {pinhole(SIDE, SIDE, 60),
                                     pinhole(SIDE, SIDE, 60),
                                     {CAMERA_SIMPLE_RADIAL, SIDE, SIDE, {60, SIDE / 2.0, SIDE / 2.0, -0.1}}};
    const struct view views[] = {centred_view(SIDE, SIDE, 60), centred_view(SIDE / 2, SIDE / 2, 30),
                                 centred_view(SIDE, SIDE, 60)};
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct image photo = noise(SIDE, SIDE), plain, out = {0};
        unsigned char masked[SIDE * SIDE] = {0};
        struct err err = ERR_INIT;
        plain = look(&photo, &cameras[k], same_axes, &views[k]);
        for (int y = 20; y < 33; y++)
            for (int x = 25; x < 40; x++) {
                masked[y * SIDE + x] = 1;
                for (int c = 0; c < 3; c++) image_at(&photo, x, y)[c] = 1000;
            }
        assert_ok(resample_photo(&out, NULL, &(struct resample_source){.linear = &photo, .masked = masked}, &cameras[k],
                                 &same_axes, &views[k], &err),
                  err);
        const double scale = (double)SIDE / views[k].width;
        int hidden = 0;
        for (int y = 0; y < out.height; y++)
            for (int x = 0; x < out.width; x++) {
                const float *p = image_at(&out, x, y), *q = image_at(&plain, x, y);
                double u = (x + 0.5) * scale, v = (y + 0.5) * scale;
                const double r2 = ((u - 30) * (u - 30) + (v - 30) * (v - 30)) / 3600;
                if (k == 2) u = 30 + (u - 30) * (1 - 0.1 * r2);
                if (k == 2) v = 30 + (v - 30) * (1 - 0.1 * r2);
                const double away = fmax(fmax(25 - u, u - 40), fmax(20 - v, v - 33)); /* negative: inside */
                assert_true(p[3] == 0 || p[3] == 1);
                if (away < 0) assert_true(p[3] == 0);
                if (away > 2 * scale) assert_true(p[3] == q[3]);
                if (away > 3.5 * scale) assert_memory_equal(p, q, 4 * sizeof *p);
                for (int c = 0; c < 3; c++) assert_true(p[3] == 1 ? p[c] < 4 : p[c] == 0);
                hidden += p[3] < q[3];
            }
        const double area = 15 * 13 / (scale * scale);
        if (k == 0) assert_int_equal(hidden, 15 * 13);
        assert_true(hidden >= area * 0.95 &&
                    hidden <= (15 + 2.1 * scale) * (13 + 2.1 * scale) / (scale * scale) * 1.05);
        image_release(&photo);
        image_release(&plain);
        image_release(&out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ramps_are_where_the_lens_projects_them),
        cmocka_unit_test(a_distant_texture_matches_a_pinhole_camera),
        cmocka_unit_test(a_fisheye_view_covers_the_side),
        cmocka_unit_test(the_photos_own_pinhole_camera_copies_its_pixels),
        cmocka_unit_test(a_nearly_identical_camera_is_resampled),
        cmocka_unit_test(shifts_and_rotations_by_whole_pixels_do_not_blur),
        cmocka_unit_test(reduction_does_not_alias),
        cmocka_unit_test(reduction_keeps_resolvable_detail),
        cmocka_unit_test(each_axis_has_its_own_filter_width),
        cmocka_unit_test(a_reduction_beyond_the_widest_filter_is_resampled),
        cmocka_unit_test(a_bright_window_has_no_halo),
        cmocka_unit_test(pixels_outside_the_photo_are_empty),
        cmocka_unit_test(rays_outside_the_lens_are_empty),
        cmocka_unit_test(the_smallest_and_the_longest_sizes_are_resampled),
        cmocka_unit_test(the_result_does_not_depend_on_threads),
        cmocka_unit_test(a_photo_of_another_size_is_refused),
        cmocka_unit_test(parts_give_the_same_picture_as_the_whole),
        cmocka_unit_test(masked_pixels_are_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
