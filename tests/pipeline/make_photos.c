/* make_photos.c - photographs of a small analytic room, with their true cameras, points and depths.
 *
 * The room has a slanted back wall, a floor and a rotated box. Value noise of several octaves and hard-edged marks
 * cover all surfaces, so that feature detectors and matchers find something everywhere. Pinhole cameras on a gentle arc
 * face the room's centre. Their focal length is 1.2 times the long side, COLMAP's initial value for a photo without
 * EXIF.
 * Scene units; x right, y down, z into the room. The same options give the same bytes.
 *
 * writes  DIR/photos/photo_N.jpg                          16 samples a pixel, quality 95
 *         DIR/photos/photo_N_eK.jpg                       instead of it with --brackets: exposures two stops apart;
 *                                                         time, f-number and ISO are in EXIF
 *         DIR/model/{cameras,images,points3D}.txt         COLMAP text: true poses, surface points and their tracks
 *         DIR/truth/photo_N.exr                           Z at the pixels' centres, id: 1 wall, 2 floor, 3 box */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/version.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/image/photo.h"

enum { SAMPLES = 4, CANDIDATES = 500, MAX_VIEWS = 99 }; /* samples along each side of a pixel; points tried per view */
enum surface { WALL = 1, FLOOR = 2, BOX = 3 };

static const double FLOOR_Y = 1.5;
static const struct vec3 WALL_NORMAL = {0.242535625036333, 0, -0.970142500145332}; /* unit: (1, 0, -4) / sqrt(17) */
static const double WALL_OFFSET = -8.0;                                            /* normal . p at the wall */
static const struct vec3 BOX_CENTER = {0.25, 0.7, 5.8}, BOX_HALF = {0.8, 0.8, 0.6};
static const double BOX_COS = 0.8, BOX_SIN = 0.6; /* its rotation about y */

struct room_view {
    char name[24];
    struct view view;
    bool sticker;
};

struct hit {
    double t; /* along the ray */
    enum surface surface;
    int face;    /* of the box: 0 x, 1 y, 2 z; else 0 */
    double s, r; /* coordinates on the surface, scene units */
};

static uint32_t hash3(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t h = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^ (c + 0x165667b1u) * 0xc2b2ae35u;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

static double hash_unit(uint32_t seed, int x, int y)
{
    return hash3(seed, (uint32_t)x, (uint32_t)y) * (1.0 / 4294967296.0);
}

static double value_noise(uint32_t seed, double x, double y)
{
    double fx = floor(x), fy = floor(y), u = x - fx, v = y - fy;
    int ix = (int)fx, iy = (int)fy;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    double top = hash_unit(seed, ix, iy) * (1 - u) + hash_unit(seed, ix + 1, iy) * u;
    double bottom = hash_unit(seed, ix, iy + 1) * (1 - u) + hash_unit(seed, ix + 1, iy + 1) * u;
    return top * (1 - v) + bottom * v;
}

/* The colour of a disc or a rotated rectangle, wholly inside its cell of a grid; most cells have one. False outside. */
static bool mark(uint32_t seed, double s, double r, double cell, double rgb[3])
{
    int ix = (int)floor(s / cell), iy = (int)floor(r / cell);
    if (hash_unit(seed, ix, iy) > 0.7) return false;
    double size = cell * (0.12 + 0.16 * hash_unit(seed + 1, ix, iy)), room = cell - 2.9 * size;
    double x = s - ix * cell - 1.45 * size - room * hash_unit(seed + 2, ix, iy);
    double y = r - iy * cell - 1.45 * size - room * hash_unit(seed + 3, ix, iy);
    double angle = 3 * hash_unit(seed + 4, ix, iy), c = cos(angle), d = sin(angle);
    double a = c * x + d * y, b = c * y - d * x;
    bool disc = hash_unit(seed + 5, ix, iy) < 0.4;
    if (disc ? a * a + b * b > size * size : fabs(a) > size || fabs(b) > 0.6 * size) return false;
    double level = hash_unit(seed + 6, ix, iy) < 0.5 ? 0.03 : 0.6; /* dark or bright */
    for (uint32_t k = 0; k < 3; k++) rgb[k] = level * (0.6 + 0.8 * hash_unit(seed + 7 + k, ix, iy));
    return true;
}

static void shade(const struct hit *h, bool sticker, double rgb[3])
{
    static const double COLOURS[3][2][3] = {{{0.30, 0.22, 0.14}, {0.55, 0.60, 0.58}},
                                            {{0.16, 0.20, 0.12}, {0.55, 0.42, 0.30}},
                                            {{0.10, 0.16, 0.34}, {0.75, 0.55, 0.25}}};
    static const double LIGHT[3] = {0.7, 1.15, 0.95}; /* on the box's faces, so that its edges are visible */
    uint32_t seed = 1000 * (uint32_t)h->surface + 100 * (uint32_t)h->face;
    if (sticker && h->surface == WALL && fabs(h->s + 1.2) < 0.5 && fabs(h->r + 0.6) < 0.35) {
        for (int k = 0; k < 3; k++) rgb[k] = 0.9 - 0.2 * k * value_noise(7, h->s * 9, h->r * 9);
        return;
    }
    if (mark(seed + 20, h->s, h->r, 0.45, rgb) || mark(seed + 40, h->s, h->r, 0.21, rgb)) return;
    double sum = 0, frequency = 1.3, weight = 0.30;
    for (uint32_t octave = 0; octave < 4; octave++, frequency *= 2.1, weight *= 0.85)
        sum += weight * value_noise(seed + octave, h->s * frequency, h->r * frequency);
    double light = h->surface == BOX ? LIGHT[h->face] : 1, contrast = 2 * sum - 0.45;
    contrast = fmin(fmax(contrast, 0.03), 1.2);
    for (int k = 0; k < 3; k++) {
        const double(*c)[3] = COLOURS[h->surface - 1];
        rgb[k] = light * (c[0][k] + (c[1][k] - c[0][k]) * contrast) * (0.35 + 0.65 * contrast);
    }
}

static double axis(struct vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

static struct vec3 into_box(struct vec3 v)
{
    return vec3_make(BOX_COS * v.x - BOX_SIN * v.z, v.y, BOX_SIN * v.x + BOX_COS * v.z);
}

/* Every ray of a camera on the arc hits the wall, if nothing nearer. */
static struct hit trace(struct vec3 origin, struct vec3 ray)
{
    struct hit h = {(WALL_OFFSET - vec3_dot(WALL_NORMAL, origin)) / vec3_dot(WALL_NORMAL, ray), WALL, 0, 0, 0};
    double floor_t = (FLOOR_Y - origin.y) / ray.y;
    if (ray.y > 0 && floor_t < h.t) h.t = floor_t, h.surface = FLOOR;

    struct vec3 o = into_box(vec3_sub(origin, BOX_CENTER)), d = into_box(ray);
    double enter = 0, leave = h.t;
    int face = 0;
    for (int k = 0; k < 3; k++) {
        double a = (-axis(BOX_HALF, k) - axis(o, k)) / axis(d, k), b = (axis(BOX_HALF, k) - axis(o, k)) / axis(d, k);
        if (fmin(a, b) > enter) enter = fmin(a, b), face = k;
        leave = fmin(leave, fmax(a, b));
    }
    if (enter > 0 && enter < leave) h.t = enter, h.surface = BOX, h.face = face;

    struct vec3 p = vec3_add(origin, vec3_scale(ray, h.t));
    if (h.surface == BOX) {
        p = into_box(vec3_sub(p, BOX_CENTER));
        h.s = face == 0 ? p.z : p.x;
        h.r = face == 1 ? p.z : p.y;
    } else {
        h.s = h.surface == WALL ? p.x * 1.030776406404415 : p.x; /* sqrt(17) / 4: along the slanted wall */
        h.r = h.surface == WALL ? p.y : p.z;
    }
    return h;
}

/* The ray of a pixel; its component along the camera's axis is 1, so that t is depth. */
static struct vec3 pixel_ray(const struct view *v, double x, double y)
{
    return mat3_apply(mat3_transpose(v->cam_from_world), vec3_make((x - v->cx) / v->fx, (y - v->cy) / v->fy, 1));
}

static void place_view(struct room_view *rv, int number, int count, int width, int height)
{
    const struct vec3 target = {0, 0.1, 6};
    double angle = count > 1 ? 0.32 * ((number - 1.0) / (count - 1) - 0.5) : 0,
           f = 1.2 * (width > height ? width : height);
    struct view *v = &rv->view;
    snprintf(rv->name, sizeof rv->name, "photo_%d", number);
    *v = (struct view){rv->name, width, height, f, f, 0.5 * width, 0.5 * height, {{{0}}}, {0, 0, 0}, {0, 0, 0}};
    v->center = vec3_make(6 * sin(angle), number % 2 ? -0.25 : 0.05, 6 - 6 * cos(angle)); /* off one line */
    struct vec3 z = vec3_normalize(vec3_sub(target, v->center));
    struct vec3 x = vec3_normalize(vec3_cross(vec3_make(0, 1, 0), z)), y = vec3_cross(z, x);
    v->cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
}

struct render_job {
    const struct room_view *rv;
    struct image *picture;
    float *z;
    uint32_t *id;
};

static void render_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct render_job *job = ctx;
    const struct view *v = &job->rv->view;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < v->width; x++) {
            float *out = image_at(job->picture, x, (int)y);
            for (int k = 0; k < SAMPLES * SAMPLES; k++) {
                double rgb[3], dx = (k % SAMPLES + 0.5) / SAMPLES, dy = (k / SAMPLES + 0.5) / SAMPLES;
                struct hit h = trace(v->center, pixel_ray(v, x + dx, (double)y + dy));
                shade(&h, job->rv->sticker, rgb);
                for (int c = 0; c < 3; c++) out[c] += (float)(rgb[c] / (SAMPLES * SAMPLES));
            }
            struct hit h = trace(v->center, pixel_ray(v, x + 0.5, (double)y + 0.5));
            job->z[y * (size_t)v->width + (size_t)x] = (float)h.t;
            job->id[y * (size_t)v->width + (size_t)x] = h.surface;
        }
}

/* An APP1 segment: EXIF with exposure time (1/denominator s), f/8 and ISO 100. */
static size_t make_exif(unsigned char exif[128], uint32_t denominator)
{
    static const unsigned char head[] = {
        0xff, 0xe1, 0,    92,   'E', 'x', 'i', 'f', 0,   0, 'I', 'I', 42, 0, 8, 0,
        0,    0, /* TIFF: little-endian, first directory at 8 */
        1,    0,    0x69, 0x87, 4,   0,   1,   0,   0,   0, 26,  0,   0,  0, 0, 0,
        0,    0,                                                             /* one entry: the EXIF directory, at 26 */
        3,    0,    0x9a, 0x82, 5,   0,   1,   0,   0,   0, 68,  0,   0,  0, /* exposure time: rational at 68 */
        0x9d, 0x82, 5,    0,    1,   0,   0,   0,   76,  0, 0,   0,          /* f-number: rational at 76 */
        0x27, 0x88, 3,    0,    1,   0,   0,   0,   100, 0, 0,   0,   0,  0, 0, 0, /* ISO 100; no more directories */
    };
    const uint32_t values[4] = {1, denominator, 8, 1};
    size_t size = sizeof head;
    memcpy(exif, head, size);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) exif[size++] = (unsigned char)(values[i] >> 8 * k);
    exif[2] = (unsigned char)((size - 2) >> 8);
    exif[3] = (unsigned char)(size - 2);
    return size;
}

/* Writes exposure `number` of `count` as a JPEG with EXIF behind the first marker; the middle one has the gain 1. */
static enum status write_bracket(const struct room_view *rv, const struct image *picture, int number, int count,
                                 const char *folder, struct err *err)
{
    struct image exposed = {0};
    struct outfile f = {0};
    char path[4096];
    unsigned char exif[128], *rgb = NULL, *jpeg = NULL;
    size_t samples = (size_t)picture->width * (size_t)picture->height * 3, size = 0;
    double gain = pow(4, number - (count - 1) / 2);
    size_t exif_size = make_exif(exif, (uint32_t)(4096 / gain));

    snprintf(path, sizeof path, "%s/photos/%s_e%d.jpg", folder, rv->name, number);
    image_init(&exposed, picture->width, picture->height, 3, err);
    if (!err->status && !(rgb = malloc(samples))) err_nomem(err, "a photo", samples);
    for (size_t i = 0; !err->status && i < samples; i++) exposed.data[i] = (float)gain * picture->data[i];
    if (!err->status) image_to_srgb8(&exposed, rgb);
    if (!err->status && !jpeg_encode(&jpeg, &size, rgb, picture->width, picture->height, 95, err))
        outfile_open(&f, path, err);
    if (!err->status && (fwrite(jpeg, 1, 2, f.fp) != 2 || fwrite(exif, 1, exif_size, f.fp) != exif_size ||
                         fwrite(jpeg + 2, 1, size - 2, f.fp) != size - 2))
        err_errno(err, "write", path);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    image_release(&exposed);
    free(rgb);
    free(jpeg);
    return err->status;
}

static enum status write_view(const struct room_view *rv, int brackets, const char *folder,
                              const struct provenance *prov, struct err *err)
{
    char path[4096];
    struct image picture = {0};
    struct exr_image truth = {0};
    struct exr_plane *plane;
    unsigned char *rgb = malloc((size_t)rv->view.width * (size_t)rv->view.height * 3);
    enum status st = rgb ? ST_OK : err_nomem(err, "a photo", (size_t)rv->view.width * (size_t)rv->view.height * 3);

    if (st || (st = image_init(&picture, rv->view.width, rv->view.height, 3, err)) ||
        (st = exr_image_init(&truth, rv->view.width, rv->view.height, err)) ||
        (st = exr_add_plane(&truth, "Z", EXR_FLOAT, &plane, err)) ||
        (st = exr_add_plane(&truth, "id", EXR_UINT, &plane, err)))
        goto done;
    struct render_job job = {rv, &picture, exr_find(&truth, "Z")->f, exr_find(&truth, "id")->u};
    parallel_for((size_t)rv->view.height, 8, render_rows, &job);
    image_to_srgb8(&picture, rgb);
    view_image_set_camera(&truth, &rv->view);
    snprintf(path, sizeof path, "%s/truth/%s.exr", folder, rv->name);
    if ((st = exr_write(&truth, path, prov, err))) goto done;
    for (int k = 0; k < brackets && !st; k++) st = write_bracket(rv, &picture, k, brackets, folder, err);
    snprintf(path, sizeof path, "%s/photos/%s.jpg", folder, rv->name);
    if (!st && !brackets) st = jpeg_write(path, rgb, rv->view.width, rv->view.height, 95, err);
done:
    free(rgb);
    image_release(&picture);
    exr_image_release(&truth);
    return st;
}

/* True if the point is in the picture, at least two pixels from its border, and not occluded. */
static bool sees(const struct view *v, struct vec3 p, double *x, double *y)
{
    double z = view_project(v, p, x, y);
    if (!(z > 0) || *x < 2 || *y < 2 || *x > v->width - 2 || *y > v->height - 2) return false;
    return fabs(trace(v->center, pixel_ray(v, *x, *y)).t - z) < 1e-6 * z;
}

/* Samples points at pixels of each view in turn (a low-discrepancy sequence) and keeps those that two views see. */
static enum status write_model(const struct room_view *views, int count, const char *folder, struct err *err)
{
    static const char *const FILES[3] = {"cameras", "images", "points3D"};
    struct outfile f[3] = {{0}};
    char path[4096], track[MAX_VIEWS * 24], *lines[MAX_VIEWS] = {NULL};
    size_t sizes[MAX_VIEWS] = {0};
    int seen[MAX_VIEWS] = {0}, points = 0;
    FILE *observations[MAX_VIEWS] = {NULL};

    for (int k = 0; k < 3 && !err->status; k++) {
        snprintf(path, sizeof path, "%s/model/%s.txt", folder, FILES[k]);
        outfile_open(&f[k], path, err);
    }
    for (int i = 0; i < count && !err->status; i++)
        if (!(observations[i] = open_memstream(&lines[i], &sizes[i]))) err_nomem(err, "observations", 1);
    if (err->status) goto done;

    for (int n = 0; n < CANDIDATES * count; n++) {
        const struct view *from = &views[n % count].view;
        double a = (n + 1) * 0.7548776662466927, b = (n + 1) * 0.5698402909980532, rgb[3], x, y;
        struct vec3 ray = pixel_ray(from, (a - floor(a)) * from->width, (b - floor(b)) * from->height);
        struct hit h = trace(from->center, ray);
        struct vec3 p = vec3_add(from->center, vec3_scale(ray, h.t));
        int by = 0, length = 0;
        for (int i = 0; i < count; i++) by += sees(&views[i].view, p, &x, &y);
        if (by < 2) continue;
        points++;
        for (int i = 0; i < count; i++) {
            if (!sees(&views[i].view, p, &x, &y)) continue;
            fprintf(observations[i], "%s%.17g %.17g %d", seen[i] ? " " : "", x, y, points);
            length += snprintf(track + length, sizeof track - (size_t)length, " %d %d", i + 1, seen[i]++);
        }
        shade(&h, false, rgb);
        fprintf(f[2].fp, "%d %.17g %.17g %.17g", points, p.x, p.y, p.z);
        for (int k = 0; k < 3; k++) fprintf(f[2].fp, " %d", (int)(255 * srgb_from_linear((float)rgb[k]) + 0.5f));
        fprintf(f[2].fp, " 0%s\n", track);
    }
    const struct view *v = &views[0].view;
    fprintf(f[0].fp, "1 PINHOLE %d %d %.17g %.17g %.17g %.17g\n", v->width, v->height, v->fx, v->fy, v->cx, v->cy);
    for (int i = 0; i < count; i++) {
        v = &views[i].view;
        struct quat q = quat_from_mat3(v->cam_from_world);
        if (fclose(observations[i])) err_nomem(err, "observations", sizes[i]);
        observations[i] = NULL;
        if (err->status) goto done;
        fprintf(f[1].fp, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 %s.jpg\n%s\n", i + 1, q.w, q.x, q.y, q.z,
                v->translation.x, v->translation.y, v->translation.z, views[i].name, lines[i]);
    }
    for (int k = 2; k >= 0 && !err->status; k--) outfile_commit(&f[k], err);
done:
    for (int i = 0; i < count; i++) {
        if (observations[i]) fclose(observations[i]);
        free(lines[i]);
    }
    for (int k = 0; k < 3; k++) outfile_discard(&f[k]);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *out = NULL, *size = "320x240";
    int views = 5, change = 0, brackets = 0, width = 0, height = 0, end = 0;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Renders photographs of a small analytic room, with true cameras, points and depths."),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write photos, model and truth into"),
        CLI_INT("views", &views, CLI_OPTIONAL, "number of photos, 1 to 99 (5)"),
        CLI_STR("size", &size, CLI_OPTIONAL, "pixels of a photo, WIDTHxHEIGHT (320x240)"),
        CLI_INT("change", &change, CLI_OPTIONAL,
                "number of the photo with a bright sticker on the wall, from 1 (none)"),
        CLI_INT("brackets", &brackets, CLI_OPTIONAL,
                "number of exposures of each view, 1 to 9 (one photo without EXIF)"),
        CLI_END,
    };
    static struct room_view room[MAX_VIEWS];
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "make_photos", opts, &prov, &err);

    if (verdict == CLI_RUN) {
        if (views < 1 || views > MAX_VIEWS || change < 0 || change > views)
            err_set(&err, ST_USAGE, "--views %d --change %d: wanted 1 to %d views, and one of them to change.", views,
                    change, MAX_VIEWS);
        else if (brackets < 0 || brackets > 9)
            err_set(&err, ST_USAGE, "--brackets %d: wanted 1 to 9.", brackets);
        else if (sscanf(size, "%dx%d%n", &width, &height, &end) != 2 || size[end] || width < 16 || height < 16 ||
                 width > 4096 || height > 4096)
            err_set(&err, ST_USAGE, "--size %s: wanted WIDTHxHEIGHT, each 16 to 4096.", size);
        for (int i = 0; i < views && !err.status; i++) {
            place_view(&room[i], i + 1, views, width, height);
            room[i].sticker = i + 1 == change;
            write_view(&room[i], brackets, out, &prov, &err);
        }
        if (!err.status) write_model(room, views, out, &err);
    }
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
