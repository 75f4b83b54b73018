/* camera.c - projection through COLMAP's camera models, and its inverse.
 *
 * A perspective model maps the plane coordinates (x, y) = (X / Z, Y / Z) to distorted ones,
 *   x_d = x g(s) + 2 p1 x y + p2 (s + 2 x^2),  y_d = y g(s) + 2 p2 x y + p1 (s + 2 y^2),  s = x^2 + y^2,
 *   g(s) = N(s) / D(s),  N = 1 + n1 s + n2 s^2 + ..., D = 1 + d1 s + d2 s^2 + d3 s^3,
 * and a fisheye maps the angle t from the axis to the radius t N(t^2): with (x, y) the direction from the axis times t
 * and g = N, the same formulas hold, and thin prisms [Weng 1992] add (sx, sy) s. The FOV model [Devernay 2001] has
 *   g(s) = arctan(2 r tan(w / 2)) / (w r), r^2 = s,
 * which rises everywhere. Every model is a special case.
 *
 * The radial map r -> r g(r^2) is one-to-one only up to the first radius where its derivative is 0; rays beyond it fold
 * back onto pixels of other rays. The numerator of the derivative is a polynomial in s with coefficients
 *   P_k = sum over i + j = k of N_i D_j (1 + 2 i - 2 j),
 * so "P > 0 and D > 0 on [0, s]" is decided by the roots of P and D. With tangential terms the Jacobian's determinant
 * must be positive, too. The inverse is found by Newton's method inside that range. */
#include "common/capture/camera.h"

#include <stddef.h>
#include <string.h>

#include "common/math/numbers.h"

static const struct {
    const char *name;
    int params;
} models[CAMERA_MODEL_COUNT] = {
    [CAMERA_SIMPLE_PINHOLE] = {"SIMPLE_PINHOLE", 3},
    [CAMERA_PINHOLE] = {"PINHOLE", 4},
    [CAMERA_SIMPLE_RADIAL] = {"SIMPLE_RADIAL", 4},
    [CAMERA_RADIAL] = {"RADIAL", 5},
    [CAMERA_OPENCV] = {"OPENCV", 8},
    [CAMERA_OPENCV_FISHEYE] = {"OPENCV_FISHEYE", 8},
    [CAMERA_FULL_OPENCV] = {"FULL_OPENCV", 12},
    [CAMERA_FOV] = {"FOV", 5},
    [CAMERA_SIMPLE_RADIAL_FISHEYE] = {"SIMPLE_RADIAL_FISHEYE", 4},
    [CAMERA_RADIAL_FISHEYE] = {"RADIAL_FISHEYE", 5},
    [CAMERA_THIN_PRISM_FISHEYE] = {"THIN_PRISM_FISHEYE", 12},
};

const char *camera_model_name(enum camera_model model) { return models[model].name; }
int camera_model_params(enum camera_model model) { return models[model].params; }

bool camera_model_from_name(const char *name, enum camera_model *model)
{
    for (int i = 0; i < CAMERA_MODEL_COUNT; i++)
        if (!strcmp(name, models[i].name)) {
            *model = (enum camera_model)i;
            return true;
        }
    return false;
}

bool camera_model_has_one_focal(enum camera_model model)
{
    return model == CAMERA_SIMPLE_PINHOLE || model == CAMERA_SIMPLE_RADIAL || model == CAMERA_RADIAL ||
           model == CAMERA_SIMPLE_RADIAL_FISHEYE || model == CAMERA_RADIAL_FISHEYE;
}

bool camera_model_is_fisheye(enum camera_model model)
{
    return model == CAMERA_OPENCV_FISHEYE || model == CAMERA_SIMPLE_RADIAL_FISHEYE || model == CAMERA_RADIAL_FISHEYE ||
           model == CAMERA_THIN_PRISM_FISHEYE;
}

/* The coefficients are those of the Taylor series
 *   2 sin(theta / 2) / theta = 1 - theta^2 / 24 + theta^4 / 1920 - theta^6 / 322560 + theta^8 / 92897280 - ...
 * The error stays below 1e-3 px up to theta = 90 degrees for a focal length of 500 px. */
struct camera camera_equisolid(int width, int height, double focal, double cx, double cy)
{
    return (struct camera){
        CAMERA_OPENCV_FISHEYE,
        width,
        height,
        {focal, focal, cx, cy, -1 / 24.0, 1 / 1920.0, -1 / 322560.0, 1 / 92897280.0},
    };
}

enum status camera_check(const struct camera *c, struct err *err)
{
    if ((int)c->model < 0 || c->model >= CAMERA_MODEL_COUNT)
        return err_set(err, ST_DATA, "camera model number %d is unknown.", (int)c->model);
    if (c->width < 1 || c->height < 1)
        return err_set(err, ST_DATA, "the camera's size is %d x %d px; both must be at least 1.", c->width, c->height);
    for (int i = 0; i < models[c->model].params; i++)
        if (!isfinite(c->params[i]))
            return err_set(err, ST_DATA, "parameter %d of the %s camera is not a finite number.", i + 1,
                           models[c->model].name);
    for (int i = 0; i < (camera_model_has_one_focal(c->model) ? 1 : 2); i++)
        if (!(c->params[i] > 0))
            return err_set(err, ST_DATA, "the %s camera's focal length is %.9g px; it must be greater than 0.",
                           models[c->model].name, c->params[i]);
    if (c->model == CAMERA_FOV && !(fabs(c->params[4]) < PI))
        return err_set(err, ST_DATA, "the FOV camera's field is %.9g radians; it must be below pi.", c->params[4]);
    return ST_OK;
}

void camera_focal(const struct camera *c, double *fx, double *fy, double *cx, double *cy)
{
    const double *p = c->params;
    bool single = camera_model_has_one_focal(c->model);
    *fx = p[0];
    *fy = single ? p[0] : p[1];
    *cx = single ? p[1] : p[2];
    *cy = single ? p[2] : p[3];
}

/* Whether both sides differ by the same ratio, up to the half pixel (of the smaller picture) that rounding explains. */
static bool same_shape(const struct camera *c, int width, int height)
{
    double ratio = (double)width / c->width, other = (double)height / c->height;
    bool smaller = ratio < 1;
    double off = smaller ? fmin(fabs(c->height * ratio - height), fabs(c->width * other - width))
                         : fmin(fabs(height / ratio - c->height), fabs(width / other - c->width));
    return off <= 0.5;
}

bool camera_resize(struct camera *c, int width, int height)
{
    if (c->width == width && c->height == height) return true;
    if (!same_shape(c, width, height)) return false;
    const double scale_u = (double)width / c->width, scale_v = (double)height / c->height;
    const bool single = camera_model_has_one_focal(c->model);
    double *p = c->params, fx, fy, cx, cy;
    camera_focal(c, &fx, &fy, &cx, &cy);
    p[0] = fx * (single ? sqrt(scale_u * scale_v) : scale_u);
    if (!single) p[1] = fy * scale_v;
    p[single ? 1 : 2] = cx * scale_u;
    p[single ? 2 : 3] = cy * scale_v;
    c->width = width;
    c->height = height;
    return true;
}

/* ------------------------------------------------------------------------------------------------- distortion */

enum { N_TERMS = 5, D_TERMS = 4, SLOPE_TERMS = N_TERMS + D_TERMS - 1 };

struct distortion {
    double n[N_TERMS], d[D_TERMS]; /* coefficients of s^0, s^1, ... */
    double p1, p2, sx, sy;
    double omega, slope; /* of the FOV model; slope: 2 tan(omega / 2); omega 0: another model */
    bool none, tangential;
};

#define MIN_OMEGA 1e-6 /* radians; a narrower FOV lens has no distortion */

static struct distortion distortion_of(const struct camera *c)
{
    struct distortion q = {.n = {1}, .d = {1}};
    const double *p = c->params;
    switch (c->model) {
    case CAMERA_SIMPLE_RADIAL:
    case CAMERA_SIMPLE_RADIAL_FISHEYE:
        q.n[1] = p[3];
        break;
    case CAMERA_RADIAL:
    case CAMERA_RADIAL_FISHEYE:
        q.n[1] = p[3];
        q.n[2] = p[4];
        break;
    case CAMERA_OPENCV_FISHEYE:
        memcpy(q.n + 1, p + 4, 4 * sizeof *p);
        break;
    case CAMERA_FOV:
        q.omega = fabs(p[4]);
        q.none = q.omega < MIN_OMEGA;
        if (q.none) q.omega = 0;
        q.slope = 2 * tan(q.omega / 2);
        break;
    case CAMERA_THIN_PRISM_FISHEYE:
        q.n[1] = p[4];
        q.n[2] = p[5];
        q.p1 = p[6];
        q.p2 = p[7];
        q.n[3] = p[8];
        q.n[4] = p[9];
        q.sx = p[10];
        q.sy = p[11];
        break;
    case CAMERA_FULL_OPENCV:
        q.n[3] = p[8];
        memcpy(q.d + 1, p + 9, 3 * sizeof *p);
        /* fall through */
    case CAMERA_OPENCV:
        q.n[1] = p[4];
        q.n[2] = p[5];
        q.p1 = p[6];
        q.p2 = p[7];
        break;
    default:
        q.none = true;
    }
    q.tangential = q.p1 != 0 || q.p2 != 0 || q.sx != 0 || q.sy != 0;
    return q;
}

static double poly(const double *c, int terms, double s)
{
    double v = 0;
    for (int i = terms - 1; i >= 0; i--) v = v * s + c[i];
    return v;
}

/* The same of the FOV model. With k the slope, arctan(k r) / r = k (1 - z / 3 + z^2 / 5 - ...), z = k^2 s. */
static void radial_fov(const struct distortion *q, double s, double *g, double *dg)
{
    const double k = q->slope, z = k * k * s, r = sqrt(s);
    if (z < 1e-4) {
        *g = k / q->omega * (1 - z * (1 / 3.0 - z * (1 / 5.0 - z / 7)));
        *dg = k * k * k / q->omega * (-1 / 3.0 + z * (2 / 5.0 - z * 3 / 7));
    } else {
        *g = atan(k * r) / (q->omega * r);
        *dg = (k / (q->omega * (1 + z)) - *g) / (2 * s);
    }
}

/* g(s) and its derivative. */
static void radial(const struct distortion *q, double s, double *g, double *dg)
{
    if (q->omega > 0) {
        radial_fov(q, s, g, dg);
        return;
    }
    double n = poly(q->n, N_TERMS, s), d = poly(q->d, D_TERMS, s), dn = 0, dd = 0;
    for (int i = N_TERMS - 1; i > 0; i--) dn = dn * s + i * q->n[i];
    for (int i = D_TERMS - 1; i > 0; i--) dd = dd * s + i * q->d[i];
    *g = n / d;
    *dg = (dn * d - n * dd) / (d * d);
}

static void slope_poly(const struct distortion *q, double slope[SLOPE_TERMS])
{
    memset(slope, 0, SLOPE_TERMS * sizeof *slope);
    for (int i = 0; i < N_TERMS; i++)
        for (int j = 0; j < D_TERMS; j++) slope[i + j] += q->n[i] * q->d[j] * (1 + 2 * i - 2 * j);
}

/* The roots in (0, end] where the polynomial changes sign, ascending, by bisection between the roots of its
 * derivative. */
static int poly_roots(const double *c, int terms, double end, double roots[SLOPE_TERMS])
{
    if (terms < 2) return 0;
    double derivative[SLOPE_TERMS], stops[SLOPE_TERMS + 1] = {0};
    for (int i = 1; i < terms; i++) derivative[i - 1] = i * c[i];
    int n = poly_roots(derivative, terms - 1, end, stops + 1), found = 0;
    stops[n + 1] = end;
    for (int i = 0; i <= n; i++) {
        double a = stops[i], b = stops[i + 1];
        bool positive = poly(c, terms, a) > 0;
        if (positive == (poly(c, terms, b) > 0)) continue;
        for (double m = (a + b) / 2; m > a && m < b; m = (a + b) / 2) {
            if ((poly(c, terms, m) > 0) == positive)
                a = m;
            else
                b = m;
        }
        roots[found++] = a;
    }
    return found;
}

/* Largest s up to `end` such that the polynomial (1 at 0) is positive on [0, s]. */
static double positive_until(const double *c, int terms, double end)
{
    double bound = 1, power = 1, roots[SLOPE_TERMS];
    for (int i = 1; i < terms; i++) {
        power *= end;
        if (c[i] < 0) bound += c[i] * power; /* lower bound of the polynomial on [0, end] */
    }
    if (bound > 0) return end;
    return poly_roots(c, terms, end, roots) ? roots[0] : end;
}

/* Largest s up to `end` on which the radial part is one-to-one. */
static double one_to_one_until(const struct distortion *q, double end)
{
    if (q->omega > 0) return end;
    double slope[SLOPE_TERMS];
    slope_poly(q, slope);
    return positive_until(slope, SLOPE_TERMS, positive_until(q->d, D_TERMS, end));
}

/* Distorted point and Jacobian ([0] dx/dx, [1] dx/dy, [2] dy/dx, [3] dy/dy); false where the map is not one-to-one. */
static bool distort(const struct distortion *q, double x, double y, double *xd, double *yd, double jacobian[4])
{
    double s = x * x + y * y, g, dg;
    if (!isfinite(s) || one_to_one_until(q, s) < s) return false;
    radial(q, s, &g, &dg);
    *xd = x * g + 2 * q->p1 * x * y + q->p2 * (s + 2 * x * x) + q->sx * s;
    *yd = y * g + 2 * q->p2 * x * y + q->p1 * (s + 2 * y * y) + q->sy * s;
    const double both = 2 * x * y * dg + 2 * q->p1 * x + 2 * q->p2 * y;
    jacobian[0] = g + 2 * x * x * dg + 2 * q->p1 * y + 6 * q->p2 * x + 2 * q->sx * x;
    jacobian[1] = both + 2 * q->sx * y;
    jacobian[2] = both + 2 * q->sy * x;
    jacobian[3] = g + 2 * y * y * dg + 2 * q->p2 * x + 6 * q->p1 * y + 2 * q->sy * y;
    return jacobian[0] * jacobian[3] > jacobian[1] * jacobian[2];
}

/* Finds r in [0, end] with r g(r^2) = rd, by Newton's method within a shrinking bracket. False: there is none; *r is
 * then the end of the one-to-one range. */
static bool undistort_radius(const struct distortion *q, double rd, double end, double *r)
{
    double low = 0, high = fmin(rd, end), g, dg;
    if (q->omega > 0) {
        *r = rd * q->omega < PI / 2 ? tan(rd * q->omega) / q->slope : end;
        return rd * q->omega < PI / 2 && *r < end;
    }
    for (;; high = fmin(2 * high, end)) {
        double limit = one_to_one_until(q, high * high);
        bool last = limit < high * high || high >= end;
        if (limit < high * high) high = sqrt(limit);
        radial(q, high * high, &g, &dg);
        if (high * g >= rd) break;
        low = high;
        if (last) {
            *r = high;
            return false;
        }
    }
    double at = (low + high) / 2;
    for (int i = 0; i < 200 && high > low; i++) {
        radial(q, at * at, &g, &dg);
        double e = at * g - rd, slope = g + 2 * at * at * dg;
        if (e < 0)
            low = at;
        else
            high = at;
        double next = at - e / slope;
        if (!(next > low && next < high)) next = low + (high - low) / 2;
        if (e == 0 || fabs(next - at) <= 1e-15 * at) break;
        at = next;
    }
    *r = at;
    return true;
}

/* Newton's method in the plane from (x, y); steps are halved until the error decreases. */
static bool undistort_tangential(const struct distortion *q, double xd, double yd, double *x, double *y)
{
    double a, b, j[4];
    for (int i = 0; !distort(q, *x, *y, &a, &b, j); i++) {
        if (i == 20) return false;
        *x *= 0.75;
        *y *= 0.75;
    }
    double ex = a - xd, ey = b - yd, tolerance = 1e-14 * (1 + hypot(xd, yd));
    for (int i = 0; i < 100 && hypot(ex, ey) > tolerance; i++) {
        double det = j[0] * j[3] - j[1] * j[2], step = 1;
        double dx = (j[3] * ex - j[1] * ey) / det, dy = (j[0] * ey - j[2] * ex) / det;
        for (; step > 1e-6; step /= 2) {
            double nj[4], nx = *x - step * dx, ny = *y - step * dy;
            if (!distort(q, nx, ny, &a, &b, nj) || !(hypot(a - xd, b - yd) < hypot(ex, ey))) continue;
            *x = nx;
            *y = ny;
            ex = a - xd;
            ey = b - yd;
            memcpy(j, nj, sizeof j);
            break;
        }
        if (step <= 1e-6) break;
    }
    return hypot(ex, ey) <= 1e-10;
}

/* -------------------------------------------------------------------------------------------------- projection */

bool camera_project(const struct camera *c, struct vec3 p, double *u, double *v)
{
    double fx, fy, cx, cy, x, y;
    struct distortion q = distortion_of(c);
    camera_focal(c, &fx, &fy, &cx, &cy);
    if (camera_model_is_fisheye(c->model)) {
        double rho = hypot(p.x, p.y), theta = atan2(rho, p.z), scale = p.z > 0 ? 1 / p.z : 0, j[4];
        if (rho > 0 && q.tangential) {
            if (theta >= PI || !distort(&q, p.x / rho * theta, p.y / rho * theta, &x, &y, j)) return false;
        } else if (rho > 0) {
            if (one_to_one_until(&q, theta * theta) < theta * theta || theta >= PI) return false;
            scale = theta * poly(q.n, N_TERMS, theta * theta) / rho;
        } else if (!(p.z > 0)) {
            return false;
        }
        if (!q.tangential || !(rho > 0)) {
            x = p.x * scale;
            y = p.y * scale;
        }
    } else {
        if (!(p.z > 0)) return false;
        x = p.x / p.z;
        y = p.y / p.z;
        double s = x * x + y * y, g, dg, j[4];
        if (q.tangential) {
            if (!distort(&q, x, y, &x, &y, j)) return false;
        } else if (!q.none) {
            if (!isfinite(s) || one_to_one_until(&q, s) < s) return false;
            radial(&q, s, &g, &dg);
            x *= g;
            y *= g;
        }
    }
    double a = fx * x + cx, b = fy * y + cy;
    if (!isfinite(a) || !isfinite(b)) return false;
    *u = a;
    *v = b;
    return true;
}

/* Derivatives of the distorted point (xd, yd) by the distortion's parameters: those after the principal point. x, y:
 * the point on the plane z = 1; for a fisheye the direction from the axis times the angle t, so that s = t^2. */
static void distortion_derivatives(const struct camera *c, const struct distortion *q, double x, double y,
                                   double (*dx)[CAMERA_MAX_PARAMS], const double focal[2])
{
    const double s = x * x + y * y, d = poly(q->d, D_TERMS, s), n = poly(q->n, N_TERMS, s);
    const bool single = camera_model_has_one_focal(c->model);
    const int first = single ? 3 : 4, count = models[c->model].params - first;
    const bool thin_prism = c->model == CAMERA_THIN_PRISM_FISHEYE;
    const bool tangential = c->model == CAMERA_OPENCV || c->model == CAMERA_FULL_OPENCV || thin_prism;
    double power = 1; /* of s: one more for each radial coefficient, of the numerator and then of the denominator */
    for (int i = 0; i < count; i++) {
        double ex, ey;
        if (c->model == CAMERA_FOV) {
            double g, dg;
            radial(q, s, &g, &dg);
            const double k = q->slope, by_omega = (1 + k * k / 4) / (1 + k * k * s) / q->omega - g / q->omega;
            const double slope = q->none ? 0 : c->params[4] < 0 ? -by_omega : by_omega;
            ex = x * slope;
            ey = y * slope;
        } else if (tangential && (i == 2 || i == 3)) {
            ex = i == 2 ? 2 * x * y : s + 2 * x * x;
            ey = i == 2 ? s + 2 * y * y : 2 * x * y;
        } else if (thin_prism && i > 5) {
            ex = i == 6 ? s : 0;
            ey = i == 7 ? s : 0;
        } else {
            const bool below = tangential && !thin_prism && i >= 5;
            if (below && i == 5) power = 1; /* k4, the denominator's first */
            power *= s;
            const double slope = below ? -n / (d * d) * power : power / d;
            ex = x * slope;
            ey = y * slope;
        }
        dx[0][first + i] = focal[0] * ex;
        dx[1][first + i] = focal[1] * ey;
    }
}

/* Derivatives by the point of a fisheye's (X, Y) h(rho, Z), h = t g(t^2) / rho, rho = |(X, Y)|, t = atan2(rho, Z). */
static void fisheye_derivatives(struct vec3 p, double g, double dg, double d[2][3])
{
    const double rho = hypot(p.x, p.y), square = rho * rho + p.z * p.z, t = atan2(rho, p.z);
    double by_rho = 0, by_z = -1 / (p.z * p.z), h = 1 / p.z; /* by_rho: dh / drho / rho */
    if (rho > 1e-9 * sqrt(square)) {
        const double slope = g + 2 * t * t * dg; /* of t g(t^2) */
        h = t * g / rho;
        by_rho = (slope * p.z / square * rho - t * g) / (rho * rho * rho);
        by_z = -slope / square;
    }
    d[0][0] = h + p.x * p.x * by_rho;
    d[0][1] = d[1][0] = p.x * p.y * by_rho;
    d[1][1] = h + p.y * p.y * by_rho;
    d[0][2] = p.x * by_z;
    d[1][2] = p.y * by_z;
}

bool camera_project_derivatives(const struct camera *c, struct vec3 p, double pixel[2], double d_point[2][3],
                                double d_params[2][CAMERA_MAX_PARAMS])
{
    const struct distortion q = distortion_of(c);
    const bool single = camera_model_has_one_focal(c->model);
    double focal[2], center[2], x, y, jacobian[4], xd, yd;
    camera_focal(c, &focal[0], &focal[1], &center[0], &center[1]);
    if (!camera_project(c, p, &pixel[0], &pixel[1])) return false;
    xd = (pixel[0] - center[0]) / focal[0];
    yd = (pixel[1] - center[1]) / focal[1];
    if (camera_model_is_fisheye(c->model)) {
        const double rho = hypot(p.x, p.y), t = atan2(rho, p.z);
        double g = 1, dg = 0, d[2][3];
        x = rho > 0 ? p.x / rho * t : 0;
        y = rho > 0 ? p.y / rho * t : 0;
        if (!q.tangential) radial(&q, t * t, &g, &dg);
        fisheye_derivatives(p, g, dg, d);
        if (q.tangential && !distort(&q, x, y, &xd, &yd, jacobian)) return false;
        for (int i = 0; i < 2; i++)
            for (int k = 0; k < 3; k++)
                d_point[i][k] =
                    focal[i] * (q.tangential ? jacobian[2 * i] * d[0][k] + jacobian[2 * i + 1] * d[1][k] : d[i][k]);
    } else {
        x = p.x / p.z;
        y = p.y / p.z;
        if (!distort(&q, x, y, &xd, &yd, jacobian)) return false;
        d_point[0][0] = focal[0] * jacobian[0] / p.z;
        d_point[0][1] = focal[0] * jacobian[1] / p.z;
        d_point[1][0] = focal[1] * jacobian[2] / p.z;
        d_point[1][1] = focal[1] * jacobian[3] / p.z;
        for (int i = 0; i < 2; i++) d_point[i][2] = -(d_point[i][0] * x + d_point[i][1] * y);
    }
    d_params[0][0] = xd;
    d_params[1][0] = single ? yd : 0;
    if (!single) {
        d_params[0][1] = 0;
        d_params[1][1] = yd;
    }
    const int at = single ? 1 : 2;
    d_params[0][at] = d_params[1][at + 1] = 1;
    d_params[0][at + 1] = d_params[1][at] = 0;
    distortion_derivatives(c, &q, x, y, d_params, focal);
    return true;
}

/* Largest distance from the axis on the plane z = 1, practically perpendicular to it. */
static const double MAX_PLANE_RADIUS = 1e8;

bool camera_unproject(const struct camera *c, double u, double v, struct vec3 *ray)
{
    double fx, fy, cx, cy;
    struct distortion q = distortion_of(c);
    camera_focal(c, &fx, &fy, &cx, &cy);
    double xd = (u - cx) / fx, yd = (v - cy) / fy, rd = hypot(xd, yd), r = rd;
    if (!isfinite(rd)) return false;
    if (camera_model_is_fisheye(c->model) && q.tangential) {
        undistort_radius(&q, rd, PI, &r);
        double a = rd > 0 ? xd * (r / rd) : 0, b = rd > 0 ? yd * (r / rd) : 0;
        if (!undistort_tangential(&q, xd, yd, &a, &b)) return false;
        const double t = hypot(a, b), across = t > 0 ? sin(t) / t : 1;
        if (t >= PI) return false;
        *ray = vec3_normalize(vec3_make(a * across, b * across, cos(t)));
        return true;
    }
    if (camera_model_is_fisheye(c->model)) {
        if (rd > 0 && (!undistort_radius(&q, rd, PI, &r) || r >= PI)) return false;
        double across = rd > 0 ? sin(r) / rd : 0;
        *ray = vec3_normalize(vec3_make(xd * across, yd * across, cos(r)));
        return true;
    }
    double x = xd, y = yd;
    if (q.none && rd > MAX_PLANE_RADIUS) return false;
    if (rd > 0 && !q.none) {
        bool found = undistort_radius(&q, rd, MAX_PLANE_RADIUS, &r);
        x = xd * (r / rd);
        y = yd * (r / rd);
        if (q.tangential ? !undistort_tangential(&q, xd, yd, &x, &y) : !found) return false;
    }
    *ray = vec3_normalize(vec3_make(x, y, 1));
    return true;
}
