/* picture_tool.c - pictures in the colours of phones, cameras and clips, and how far others are from them.
 *
 *   p3 IN OUT.png           the photo in Display P3, 16 bits, with its profile
 *   hlg IN OUT.png          the signal of HLG in BT.2020, 16 bits: light 1 is at 75 %, as ITU-R BT.2408 says
 *   delta A B               prints the mean colour difference CIEDE2000 [Sharma 2005] of two photos of one size
 *   panorama K OUT.jpg      a made-up room as a panorama of 360 degrees, from its Kth place
 *   pinhole K YAW SIDE OUT.png   the same as a pinhole picture of 90 degrees, turned to the right
 *
 * Colours of photos are those of the product's readers; light, signals and differences are computed here in closed
 * form. */
#include <lcms2.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/err.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "common/math/vec.h"

static double srgb_signal(double l) { return l <= 0.0031308 ? 12.92 * l : 1.055 * pow(l, 1 / 2.4) - 0.055; }

static double hlg_signal(double l)
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a), scene = l * (exp((0.75 - c) / a) + b) / 12;
    return scene <= 1.0 / 12 ? sqrt(3 * scene) : a * log(12 * scene - b) + c;
}

static enum status read_linear(struct image *out, const char *path, struct err *err)
{
    struct photo p = {0};
    if (!photo_read_any(&p, path, err) && !p.values)
        photo_to_linear(out, &p, err);
    else if (!err->status && !image_init(out, p.info.width, p.info.height, 3, err))
        memcpy(out->data, p.values, 3 * (size_t)out->width * (size_t)out->height * sizeof *p.values);
    photo_release(&p);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- encoding */

/* Writes signals, through a matrix, as PNG of 16 bits; the space owns a profile, or is NULL. */
static enum status encode(const char *in, const char *out, const double m[3][3], double (*signal)(double),
                          struct colour_space *space, struct err *err)
{
    struct image linear = {0};
    struct photo p = {.space = space};
    if (read_linear(&linear, in, err)) return err->status;
    p.info = (struct photo_info){.width = linear.width, .height = linear.height, .bits = 16, .orientation = 1};
    const size_t pixels = (size_t)linear.width * (size_t)linear.height;
    if (!photo_init_samples(&p, err)) {
        for (size_t i = 0; i < pixels; i++)
            for (int c = 0; c < 3; c++) {
                double l = 0;
                for (int k = 0; k < 3; k++) l += m[c][k] * (double)linear.data[3 * i + (size_t)k];
                p.samples[3 * i + (size_t)c] = (uint16_t)lrint(65535 * fmin(1, signal(fmax(l, 0))));
            }
        photo_write_part(out, &p, 0, 0, p.info.width, p.info.height, &p.info, err);
    }
    p.space = NULL;
    photo_release(&p);
    image_release(&linear);
    return err->status;
}

/* Display P3, as phones write it: the curve of sRGB. */
static enum status encode_p3(const char *in, const char *out, struct err *err)
{
    static const double from_rec709[3][3] = {
        {0.8224621, 0.1775380, 0}, {0.0331941, 0.9668058, 0}, {0.0170827, 0.0723974, 0.9105199}};
    const cmsCIExyY white = {0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE primaries = {{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
    const cmsFloat64Number curve[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    cmsToneCurve *one = cmsBuildParametricToneCurve(NULL, 4, curve), *curves[3] = {one, one, one};
    cmsHPROFILE profile = one ? cmsCreateRGBProfile(&white, &primaries, curves) : NULL;
    struct colour_space space = {.levels = 65536};
    cmsUInt32Number size = 0;
    if (!profile || !cmsSaveProfileToMem(profile, NULL, &size) || !(space.icc = malloc(size)) ||
        !cmsSaveProfileToMem(profile, space.icc, &size))
        err_nomem(err, "a profile", size);
    space.icc_size = size;
    if (!err->status) encode(in, out, from_rec709, srgb_signal, &space, err);
    free(space.icc);
    if (profile) cmsCloseProfile(profile);
    cmsFreeToneCurve(one);
    return err->status;
}

static enum status encode_hlg(const char *in, const char *out, struct err *err)
{
    static const double from_rec709[3][3] = {/* ITU-R BT.2087 */
                                             {0.6274, 0.3293, 0.0433},
                                             {0.0691, 0.9195, 0.0114},
                                             {0.0164, 0.0880, 0.8956}};
    return encode(in, out, from_rec709, hlg_signal, NULL, err);
}

/* -------------------------------------------------------------------------------------------------------- differing */

static double lab_curve(double t) { return t > 216 / 24389.0 ? cbrt(t) : (24389 / 27.0 * t + 16) / 116; }

/* CIELAB under D65 of linear Rec.709. */
static void lab_of(double lab[3], const float *rgb)
{
    static const double xyz[3][3] = {
        {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
    static const double white[3] = {0.95047, 1, 1.08883};
    double f[3];
    for (int i = 0; i < 3; i++) {
        double v = 0;
        for (int c = 0; c < 3; c++) v += xyz[i][c] * (double)rgb[c];
        f[i] = lab_curve(v / white[i]);
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]);
    lab[2] = 200 * (f[1] - f[2]);
}

static double hue_of(double b, double a)
{
    const double h = a == 0 && b == 0 ? 0 : atan2(b, a) / DEGREE;
    return h < 0 ? h + 360 : h;
}

static double power7(double c) { return sqrt(pow(c, 7) / (pow(c, 7) + pow(25, 7))); }

static double ciede2000(const double p[3], const double q[3])
{
    const double g = 0.5 * (1 - power7((hypot(p[1], p[2]) + hypot(q[1], q[2])) / 2));
    const double a1 = (1 + g) * p[1], a2 = (1 + g) * q[1], c1 = hypot(a1, p[2]), c2 = hypot(a2, q[2]);
    const double h1 = hue_of(p[2], a1), h2 = hue_of(q[2], a2), grey = c1 * c2 == 0;
    const double turn = grey ? 0 : fmod(h2 - h1 + 540, 360) - 180;
    const double dl = q[0] - p[0], dc = c2 - c1, dh = 2 * sqrt(c1 * c2) * sin(turn / 2 * DEGREE);
    const double l = (p[0] + q[0]) / 2, c = (c1 + c2) / 2;
    const double far = fabs(h1 - h2) > 180, h = grey ? h1 + h2 : far ? fmod((h1 + h2 + 360) / 2, 360) : (h1 + h2) / 2;
    const double t = 1 - 0.17 * cos((h - 30) * DEGREE) + 0.24 * cos(2 * h * DEGREE) + 0.32 * cos((3 * h + 6) * DEGREE) -
                     0.20 * cos((4 * h - 63) * DEGREE);
    const double d = (l - 50) * (l - 50), sl = 1 + 0.015 * d / sqrt(20 + d), sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
    const double rt = -2 * power7(c) * sin(60 * exp(-pow((h - 275) / 25, 2)) * DEGREE);
    return sqrt(pow(dl / sl, 2) + pow(dc / sc, 2) + pow(dh / sh, 2) + rt * dc / sc * dh / sh);
}

static enum status print_delta(const char *a, const char *b, struct err *err)
{
    /* two of the pairs that the formula was published with */
    static const double pairs[2][2][3] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}}, {{50, -1, 2}, {50, 0, 0}}};
    static const double known[2] = {2.0425, 2.3669};
    struct image p = {0}, q = {0};
    double sum = 0;
    for (int i = 0; i < 2; i++)
        if (fabs(ciede2000(pairs[i][0], pairs[i][1]) - known[i]) > 1e-4)
            return err_set(err, ST_INTERNAL, "CIEDE2000 of pair %d is %g, wanted %g.", i,
                           ciede2000(pairs[i][0], pairs[i][1]), known[i]);
    if (!read_linear(&p, a, err) && !read_linear(&q, b, err) && (p.width != q.width || p.height != q.height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, %s %d x %d; wanted one size.", a, p.width, p.height, b, q.width,
                q.height);
    const size_t pixels = (size_t)p.width * (size_t)p.height;
    for (size_t i = 0; !err->status && i < pixels; i++) {
        double x[3], y[3];
        lab_of(x, p.data + 3 * i);
        lab_of(y, q.data + 3 * i);
        sum += ciede2000(x, y);
    }
    if (!err->status) printf("%.3f\n", sum / (double)pixels);
    image_release(&p);
    image_release(&q);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- a room */

static double value_at(int x, int y, int z, int key)
{
    uint32_t h = (uint32_t)x * 2654435761u + (uint32_t)y * 2246822519u + (uint32_t)z * 3266489917u + (uint32_t)key;
    h = (h ^ h >> 15) * 2654435761u;
    h = (h ^ h >> 13) * 3266489917u;
    return (h >> 8) / 16777216.0;
}

/* Smooth noise in space. */
static double noise(struct vec3 p, int key)
{
    const double u[3] = {p.x, p.y, p.z};
    double base[3], f[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        base[i] = floor(u[i]);
        f[i] = u[i] - base[i];
        f[i] *= f[i] * (3 - 2 * f[i]);
    }
    for (int k = 0; k < 8; k++) {
        double w = 1;
        for (int i = 0; i < 3; i++) w *= k >> i & 1 ? f[i] : 1 - f[i];
        sum += w * value_at((int)base[0] + (k & 1), (int)base[1] + (k >> 1 & 1), (int)base[2] + (k >> 2), key);
    }
    return sum;
}

/* sRGB of a room of 6 x 2.6 x 5 with a block in it, seen along a direction: x right, y down, z forward. */
static void room_colour(double rgb[3], struct vec3 from, struct vec3 way)
{
    const double o[3] = {from.x, from.y, from.z}, d[3] = {way.x, way.y, way.z}, half[3] = {3, 1.3, 2.5};
    const double low[3] = {0.8, -0.2, 0.9}, high[3] = {1.7, 1.3, 1.6};
    double near = INFINITY, in = -INFINITY, out = INFINITY;
    for (int i = 0; i < 3; i++) {
        if (d[i] != 0) near = fmin(near, ((d[i] > 0 ? half[i] : -half[i]) - o[i]) / d[i]);
        const double a = (low[i] - o[i]) / d[i], b = (high[i] - o[i]) / d[i];
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    const bool block = in < out && in > 0;
    const struct vec3 p = vec3_add(from, vec3_scale(way, block ? in : near));
    for (int c = 0; c < 3; c++) {
        double v = 0;
        for (int octave = 0; octave < 4; octave++) /* the finest is some pixels wide, so that resampling keeps it */
            v += noise(vec3_scale(p, 2 << octave), 31 * c + 7 * octave + (block ? 1000 : 0)) * (8 >> octave) / 15;
        rgb[c] = fmin(fmax(0.5 + 1.8 * (v - 0.5) + 0.1 * (c - 1), 0), 1);
    }
}

static struct vec3 place(int k)
{
    return vec3_make(-0.9 + 0.25 * k, 0.1 * sin(2.0 * k), -0.6 + 0.12 * k + 0.1 * cos(3.0 * k));
}

enum { SAMPLES = 3 };

/* side 0: a panorama of 1536 x 768 as JPEG; else a pinhole picture as PNG. */
static enum status draw_room(int k, double yaw, int side, const char *out, struct err *err)
{
    const int w = side ? side : 1536, h = side ? side : w / 2;
    unsigned char *rgb = malloc(3 * (size_t)w * (size_t)h);
    if (!rgb) return err_nomem(err, "a picture", 3 * (size_t)w * (size_t)h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            double sum[3] = {0}, one[3];
            for (int s = 0; s < SAMPLES * SAMPLES; s++) {
                const double u = (x + (s % SAMPLES + 0.5) / SAMPLES) / w, v = (y + (s / SAMPLES + 0.5) / SAMPLES) / h;
                const double longitude = side ? yaw * DEGREE + atan(2 * u - 1) : (u - 0.5) * 2 * PI;
                const double down = side ? (2 * v - 1) * cos(longitude - yaw * DEGREE) : tan((v - 0.5) * PI);
                room_colour(one, place(k), vec3_make(sin(longitude), down, cos(longitude)));
                for (int c = 0; c < 3; c++) sum[c] += one[c];
            }
            for (int c = 0; c < 3; c++)
                rgb[3 * ((size_t)y * (size_t)w + (size_t)x) + (size_t)c] =
                    (unsigned char)lrint(255 * sum[c] / (SAMPLES * SAMPLES));
        }
    if (side)
        png_write(out, rgb, w, h, 3, err);
    else
        jpeg_write(out, rgb, w, h, 97, err);
    free(rgb);
    return err->status;
}

int main(int argc, char **argv)
{
    struct err err = ERR_INIT;
    if (argc == 4 && !strcmp(argv[1], "p3"))
        encode_p3(argv[2], argv[3], &err);
    else if (argc == 4 && !strcmp(argv[1], "hlg"))
        encode_hlg(argv[2], argv[3], &err);
    else if (argc == 4 && !strcmp(argv[1], "delta"))
        print_delta(argv[2], argv[3], &err);
    else if (argc == 4 && !strcmp(argv[1], "panorama"))
        draw_room(atoi(argv[2]), 0, 0, argv[3], &err);
    else if (argc == 6 && !strcmp(argv[1], "pinhole"))
        draw_room(atoi(argv[2]), atof(argv[3]), atoi(argv[4]), argv[5], &err);
    else
        err_set(&err, ST_USAGE,
                "usage: picture_tool p3|hlg IN OUT, delta A B, panorama K OUT, pinhole K YAW SIDE OUT.");
    err_report(&err);
    return err_exit_code(&err);
}
