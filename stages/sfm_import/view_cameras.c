/* view_cameras.c - from a photo's lens to the pinhole cameras of its views.
 *
 * The rules are in view_cameras.h. The rectangle of rule 3: the border of the photo, sampled on all sides, is projected
 * onto the plane z = 1. The rectangle's left side is at the largest x of the left border's samples, and so on. No
 * sample is inside the rectangle and the axis is, so the rectangle is inside the photo for barrel and pincushion
 * distortion alike. A border pixel without a ray (beyond the radius where the distortion folds, or in the black corners
 * of a circular fisheye) is replaced by the outermost pixel on the way to the principal point that has one. */
#include "stages/sfm_import/view_cameras.h"

#include <float.h>

#include "common/math/numbers.h"

enum { BORDER_SAMPLES = 256, GRID = 64 };

static const double MAX_ANGLE = 85; /* degrees from the axis that a single pinhole view may show */

/* Ray of the pixel at (u, v); if it has none within `limit` (radians) of the axis, that of the outermost pixel on the
 * way to the principal point that has one. */
static struct vec3 border_ray(const struct camera *lens, double u, double v, double limit)
{
    double fx, fy, cx, cy, inside = 0, outside = 1;
    struct vec3 ray, best = {0, 0, 1};
    camera_focal(lens, &fx, &fy, &cx, &cy);
    if (camera_unproject(lens, u, v, &ray) && ray.z >= cos(limit)) return ray;
    for (int i = 0; i < 60; i++) {
        double t = (inside + outside) / 2;
        if (camera_unproject(lens, cx + t * (u - cx), cy + t * (v - cy), &ray) && ray.z >= cos(limit)) {
            best = ray;
            inside = t;
        } else {
            outside = t;
        }
    }
    return best;
}

static double angle_to_axis(struct vec3 ray) { return atan2(hypot(ray.x, ray.y), ray.z); }

void view_lens_field(const struct camera *lens, double *horizontal, double *vertical)
{
    double w = lens->width, h = lens->height;
    *horizontal = angle_to_axis(border_ray(lens, 0, h / 2, PI)) + angle_to_axis(border_ray(lens, w, h / 2, PI));
    *vertical = angle_to_axis(border_ray(lens, w / 2, 0, PI)) + angle_to_axis(border_ray(lens, w / 2, h, PI));
}

/* Fraction of the view that is inside the photo, sampled on a grid. */
static double fraction_inside(const struct camera *lens, const struct photo_view *view)
{
    struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(view->view_from_photo));
    double fx, fy, cx, cy;
    int inside = 0;
    camera_focal(&view->camera, &fx, &fy, &cx, &cy);
    for (int i = 0; i < GRID; i++)
        for (int j = 0; j < GRID; j++) {
            double x = ((j + 0.5) / GRID * view->camera.width - cx) / fx,
                   y = ((i + 0.5) / GRID * view->camera.height - cy) / fy, u, v;
            inside += camera_project(lens, mat3_apply(photo_from_view, vec3_make(x, y, 1)), &u, &v) && u >= 0 &&
                      v >= 0 && u <= lens->width && v <= lens->height;
        }
    return inside / (double)(GRID * GRID);
}

/* Rotations by 90 degrees: the view's z is the photo's z, -x, x, -y, y. */
static const struct quat rotations[MAX_PHOTO_VIEWS] = {
    {1, 0, 0, 0},
    {0.70710678118654752440, 0, 0.70710678118654752440, 0},
    {0.70710678118654752440, 0, -0.70710678118654752440, 0},
    {0.70710678118654752440, -0.70710678118654752440, 0, 0},
    {0.70710678118654752440, 0.70710678118654752440, 0, 0},
};

static int wide_views(struct photo_view views[MAX_PHOTO_VIEWS], const struct camera *lens, double max_pixels)
{
    double fx, fy, cx, cy;
    int count = 0;
    camera_focal(lens, &fx, &fy, &cx, &cy);
    int side = (int)fmin(fmin(2 * sqrt(fx * fy), sqrt(max_pixels)) + 1e-6, 1 << 15);
    for (int part = 0; part < MAX_PHOTO_VIEWS && side >= 1; part++) {
        struct photo_view v = {
            part, {CAMERA_PINHOLE, side, side, {side / 2.0, side / 2.0, side / 2.0, side / 2.0}}, rotations[part]};
        if (part == 0 || fraction_inside(lens, &v) >= 0.25) views[count++] = v;
    }
    return count;
}

static bool one_view(struct photo_view *view, const struct camera *lens, double max_pixels)
{
    double fx, fy, cx, cy, w = lens->width, h = lens->height, limit = MAX_ANGLE * PI / 180;
    double left = -DBL_MAX, right = DBL_MAX, top = -DBL_MAX, bottom = DBL_MAX;
    camera_focal(lens, &fx, &fy, &cx, &cy);
    for (int i = 0; i <= BORDER_SAMPLES; i++) {
        double u = w * i / BORDER_SAMPLES, v = h * i / BORDER_SAMPLES;
        struct vec3 l = border_ray(lens, 0, v, limit), r = border_ray(lens, w, v, limit);
        struct vec3 t = border_ray(lens, u, 0, limit), b = border_ray(lens, u, h, limit);
        left = fmax(left, l.x / l.z);
        right = fmin(right, r.x / r.z);
        top = fmax(top, t.y / t.z);
        bottom = fmin(bottom, b.y / b.z);
    }
    double across = (right - left) * fx, down = (bottom - top) * fy;
    if (!(left < right && top < bottom)) return false;
    double scale = fmin(1, sqrt(max_pixels / (across * down)));
    across *= scale;
    down *= scale;
    /* the tolerance keeps sides that are whole up to rounding; a fraction of a pixel is cut off evenly at both ends */
    double width = floor(across + 1e-6), height = floor(down + 1e-6);
    if (!(width >= 1 && height >= 1 && width <= 1 << 20 && height <= 1 << 20)) return false;
    *view = (struct photo_view){-1, {CAMERA_PINHOLE, (int)width, (int)height, {0}}, {1, 0, 0, 0}};
    view->camera.params[0] = fx * scale;
    view->camera.params[1] = fy * scale;
    view->camera.params[2] = -left * fx * scale - (across - width) / 2;
    view->camera.params[3] = -top * fy * scale - (down - height) / 2;
    return true;
}

enum status view_cameras_of_photo(struct photo_view views[MAX_PHOTO_VIEWS], int *count, const struct camera *lens,
                                  double max_megapixels, double max_field, struct err *err)
{
    double horizontal, vertical, max_pixels = max_megapixels > 0 ? max_megapixels * 1e6 : DBL_MAX;
    bool pinhole = lens->model == CAMERA_SIMPLE_PINHOLE || lens->model == CAMERA_PINHOLE;
    view_lens_field(lens, &horizontal, &vertical);
    if (fmax(horizontal, vertical) > max_field * PI / 180) {
        *count = wide_views(views, lens, max_pixels);
    } else if (pinhole && (double)lens->width * lens->height <= max_pixels) {
        views[0] = (struct photo_view){-1, *lens, {1, 0, 0, 0}};
        *count = 1;
    } else {
        *count = one_view(&views[0], lens, max_pixels);
    }
    if (*count) return ST_OK;
    return err_set(
        err, ST_DATA,
        "its %s lens of %d x %d px leaves no picture when rectified: focal length or distortion must be wrong. "
        "Leave the photo out (EXCLUDE), or set the lens with [sfm] camera_model and camera_params.",
        camera_model_name(lens->model), lens->width, lens->height);
}
