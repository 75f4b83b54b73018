/* shoot_file.c - the reader of cameras.txt, and the lens models.
 *
 * A pinhole has (u - cx) / fx = x / z. An equisolid fisheye has r = 2 f sin(theta / 2), theta the angle from the axis,
 * so that equal solid angles have equal areas. Its series in COLMAP's OPENCV_FISHEYE, whose radius is theta (1 + k1
 * theta^2 + k2 theta^4 + ...), is that of 2 sin(theta / 2): k = -1/24, 1/1920, -1/322560, 1/92897280. */
#include "stages/simulate/shoot_file.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/textfile.h"
#include "common/math/numbers.h"
#include "stages/simulate/description.h"

#define MAX_SIDE      16384
#define MAX_LINES     10000
#define MAX_EXPOSURES 16

struct reader {
    struct shoot *shoot;
    struct textfile file;
    double scale;
    bool has_sensor, has_quality;
};

/* A name that can begin a file's name: not with _ or -. */
static enum status new_name(struct reader *r, char **name, struct err *err)
{
    description_name(&r->file, name, err);
    if (!err->status && !isalnum((unsigned char)**name))
        textfile_error(&r->file, err, *name, "a name of letters, digits, _ and - that does not begin with _ or -");
    return err->status;
}

static int find_lens(const struct shoot *s, const char *name)
{
    for (int i = 0; i < s->lens_count; i++)
        if (!strcmp(s->lenses[i].name, name)) return i;
    return -1;
}

/* Radius of the image circle of an equisolid lens that has one, px. */
static double circle_radius(const struct shoot_lens *l) { return 2 * l->fx * sin(l->circle * DEGREE / 4); }

static enum status read_lens_numbers(struct reader *r, struct shoot_lens *l, struct err *err)
{
    int64_t width = 0, height = 0;
    double farthest = 0;
    const bool pinhole = l->kind == SHOOT_PINHOLE;
    if (!textfile_int(&r->file, "a width in pixels", 1, MAX_SIDE, &width, err) &&
        !textfile_int(&r->file, "a height in pixels", 1, MAX_SIDE, &height, err))
        textfile_number(&r->file, "a focal length in pixels", 1, 1e6, &l->fx, err);
    if (!err->status && pinhole) textfile_number(&r->file, "a focal length in pixels", 1, 1e6, &l->fy, err);
    if (!err->status && !textfile_number(&r->file, "the principal point's x in pixels", 0, (double)width, &l->cx, err))
        textfile_number(&r->file, "the principal point's y in pixels", 0, (double)height, &l->cy, err);
    if (!err->status && !pinhole && textfile_more(&r->file)) {
        if (!textfile_expect(&r->file, "circle", err))
            textfile_number(&r->file, "the degrees across the image circle", 1, 239, &l->circle, err);
    }
    if (err->status) return err->status;
    if (!pinhole) l->fy = l->fx;
    l->width = (int)fmax(1, round((double)width * r->scale));
    l->height = (int)fmax(1, round((double)height * r->scale));
    /* the scale that rounding really gave, so that the field of view stays the same */
    const double sx = l->width / (double)width, sy = l->height / (double)height;
    l->fx *= sx, l->cx *= sx, l->fy *= sy, l->cy *= sy;
    if (!pinhole) l->fx = l->fy = (l->fx + l->fy) / 2;
    for (int i = 0; i < 4; i++)
        farthest = fmax(farthest, hypot(l->cx - (i & 1 ? l->width : 0), l->cy - (i & 2 ? l->height : 0)));
    if (l->circle > 0) farthest = fmin(farthest, circle_radius(l));
    if (!pinhole && farthest >= 2 * l->fx * sin(PI / 3)) {
        char found[80];
        snprintf(found, sizeof found, "a corner %.1f px off the axis", farthest);
        return textfile_error(&r->file, err, found, "less than %.1f px: a field of view below 240 degrees",
                              2 * l->fx * sin(PI / 3));
    }
    return ST_OK;
}

static enum status read_lens(struct reader *r, struct err *err)
{
    struct shoot *s = r->shoot;
    struct shoot_lens made = {0};
    char *kind = NULL;
    new_name(r, &made.name, err);
    if (!err->status && find_lens(s, made.name) >= 0)
        textfile_error(&r->file, err, made.name, "a name that no other lens has");
    if (!err->status) textfile_word(&r->file, "a kind of lens: pinhole or equisolid", &kind, err);
    if (!err->status && strcmp(kind, "pinhole") && strcmp(kind, "equisolid"))
        textfile_error(&r->file, err, kind, "a kind of lens: pinhole or equisolid");
    if (!err->status) made.kind = strcmp(kind, "pinhole") ? SHOOT_EQUISOLID : SHOOT_PINHOLE;
    if (!err->status && !read_lens_numbers(r, &made, err) && !textfile_end(&r->file, err))
        description_append(&r->file, &s->lenses, s->lens_count, MAX_LINES, sizeof made, err);
    if (!err->status) {
        s->lenses[s->lens_count++] = made;
    } else {
        free(made.name);
    }
    return err->status;
}

static enum status read_exposure(struct reader *r, struct shoot_exposure_list *e, struct err *err)
{
    struct shoot_exposure made = {0, 8, 100, 1};
    textfile_number(&r->file, "an exposure time in seconds", 1e-6, 1e4, &made.seconds, err);
    if (!err->status && textfile_more(&r->file)) {
        if (!textfile_number(&r->file, "an f-number", 0.5, 128, &made.f_number, err))
            textfile_number(&r->file, "an ISO speed", 1, 65535, &made.iso, err);
    }
    if (!err->status && textfile_more(&r->file))
        textfile_number(&r->file, "a filter's neutral-density factor", 1, 1e9, &made.filter, err);
    if (!err->status && !textfile_end(&r->file, err))
        description_append(&r->file, &e->list, e->count, MAX_EXPOSURES, sizeof made, err);
    if (err->status) return err->status;
    e->list[e->count++] = made;
    return ST_OK;
}

static enum status read_sensor(struct reader *r, struct err *err)
{
    struct shoot_sensor *sensor = &r->shoot->sensor;
    int64_t seed = 0;
    if (r->has_sensor) return textfile_error(&r->file, err, "a second sensor line", "one");
    if (!textfile_number(&r->file, "a full well in electrons", 10, 1e9, &sensor->full_well, err) &&
        !textfile_number(&r->file, "a read noise in electrons", 0, 1e6, &sensor->read_noise, err) &&
        !textfile_number(&r->file, "a gain", 1e-9, 1e9, &sensor->gain, err) &&
        !textfile_int(&r->file, "a seed", 0, INT64_MAX, &seed, err))
        textfile_end(&r->file, err);
    sensor->seed = (uint64_t)seed;
    r->has_sensor = !err->status;
    return err->status;
}

static enum status read_quality(struct reader *r, struct err *err)
{
    int64_t quality = 0;
    if (r->has_quality) return textfile_error(&r->file, err, "a second quality line", "one");
    if (!textfile_int(&r->file, "a JPEG quality", 1, 100, &quality, err)) textfile_end(&r->file, err);
    r->shoot->quality = (int)quality;
    r->has_quality = !err->status;
    return err->status;
}

/* World z points up in the image; for a camera that looks straight up or down, world y does. */
static struct pose pose_looking(struct vec3 at, struct vec3 look_at, double roll)
{
    const struct vec3 forward = vec3_normalize(vec3_sub(look_at, at));
    const struct vec3 up = hypot(forward.x, forward.y) > 1e-9 ? vec3_make(0, 0, 1) : vec3_make(0, 1, 0);
    const struct vec3 right = vec3_normalize(vec3_cross(forward, up)), down = vec3_cross(forward, right);
    const double c = cos(roll * PI / 180), s = sin(roll * PI / 180);
    const struct vec3 x = vec3_add(vec3_scale(right, c), vec3_scale(down, s));
    const struct vec3 y = vec3_add(vec3_scale(right, -s), vec3_scale(down, c));
    const struct mat3 turn = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {forward.x, forward.y, forward.z}}};
    const struct quat q = quat_from_mat3(turn);
    /* from the rounded rotation, so that the pose written to files has this exact centre */
    return (struct pose){q, vec3_scale(mat3_apply(mat3_from_quat(q), at), -1)};
}

/* exposure K: of those above, counted from 0. */
static enum status read_only_exposure(struct reader *r, struct shoot_photo *p, struct err *err)
{
    int64_t k = 0;
    p->exposure = -1;
    const int count = shoot_exposures(r->shoot, p).count;
    if (!count) return textfile_error(&r->file, err, "exposure", "an exposure line above the photo");
    textfile_int(&r->file, "the number of an exposure above, counted from 0", 0, count - 1, &k, err);
    p->exposure = (int)k;
    return err->status;
}

static enum status read_photo_option(struct reader *r, struct shoot_photo *p, struct err *err)
{
    const bool witness = p->kind == SHOOT_WITNESS;
    char *word = NULL;
    if (textfile_word(&r->file, "an option of a photo", &word, err)) return err->status;
    if (!strcmp(word, "roll")) return textfile_number(&r->file, "an angle in degrees", -360, 360, &p->roll, err);
    if (!strcmp(word, "exposure") && !witness) return read_only_exposure(r, p, err);
    if (strcmp(word, "sun"))
        return textfile_error(&r->file, err, word, "roll, sun%s or the end of the line", witness ? "" : ", exposure");
    p->own_sun = true;
    return textfile_number(&r->file, "the sun's azimuth in degrees", -360, 360, &p->sun_azimuth, err) ||
                   textfile_number(&r->file, "the sun's elevation in degrees", -90, 90, &p->sun_elevation, err)
               ? err->status
               : ST_OK;
}

static enum status read_photo(struct reader *r, enum shoot_kind kind, struct err *err)
{
    struct shoot *s = r->shoot;
    struct shoot_photo made = {.kind = kind, .exposure = -1};
    char *word = NULL;
    new_name(r, &made.name, err);
    if (!err->status && shoot_find(s, made.name) >= 0)
        textfile_error(&r->file, err, made.name, "a name that no other photo has");
    if (!err->status) textfile_word(&r->file, "the name of a lens above", &word, err);
    if (!err->status && (made.lens = find_lens(s, word)) < 0)
        textfile_error(&r->file, err, word, "the name of a lens above");
    if (!err->status && !description_point(&r->file, "the camera's position", &made.at, err))
        description_point(&r->file, "the point that the camera looks at", &made.look_at, err);
    if (!err->status && vec3_length(vec3_sub(made.look_at, made.at)) < 1e-9)
        textfile_error(&r->file, err, "the camera's own position", "another point to look at");
    while (!err->status && textfile_more(&r->file)) read_photo_option(r, &made, err);
    if (!err->status) description_append(&r->file, &s->photos, s->photo_count, MAX_LINES, sizeof made, err);
    if (!err->status) {
        made.cam_from_world = pose_looking(made.at, made.look_at, made.roll);
        s->photos[s->photo_count++] = made;
    } else {
        free(made.name);
    }
    return err->status;
}

static enum status read_line(struct reader *r, struct err *err)
{
    char *word = NULL;
    if (textfile_word(&r->file, "a line of cameras.txt", &word, err)) return err->status;
    if (!strcmp(word, "lens")) return read_lens(r, err);
    if (!strcmp(word, "exposure")) return read_exposure(r, &r->shoot->exposures[0], err);
    if (!strcmp(word, "reference-exposure")) return read_exposure(r, &r->shoot->exposures[1], err);
    if (!strcmp(word, "sensor")) return read_sensor(r, err);
    if (!strcmp(word, "quality")) return read_quality(r, err);
    if (!strcmp(word, "photo")) return read_photo(r, SHOOT_PHOTO, err);
    if (!strcmp(word, "reference")) return read_photo(r, SHOOT_REFERENCE, err);
    if (!strcmp(word, "witness")) return read_photo(r, SHOOT_WITNESS, err);
    return textfile_error(&r->file, err, word,
                          "one of lens, exposure, reference-exposure, sensor, quality, photo, reference, witness");
}

static enum status check_complete(const struct reader *r, struct err *err)
{
    const char *missing = NULL;
    int photos = 0;
    for (int i = 0; i < r->shoot->photo_count; i++) photos += r->shoot->photos[i].kind == SHOOT_PHOTO;
    if (!photos) missing = "photo NAME LENS X Y Z LOOK_X LOOK_Y LOOK_Z";
    if (!r->has_sensor) missing = "sensor FULL_WELL READ_NOISE GAIN SEED";
    if (!r->shoot->exposures[0].count) missing = "exposure SECONDS";
    if (!missing) return ST_OK;
    return err_set(err, ST_DATA, "%s is incomplete; add a line: %s.", r->file.path, missing);
}

enum status shoot_read(struct shoot *s, const char *folder, double scale, struct provenance *prov, struct err *err)
{
    struct reader r = {.shoot = s, .scale = scale};
    char *path = NULL;
    int version = 0;
    *s = (struct shoot){.quality = 94};
    if (asprintf(&path, "%s/cameras.txt", folder) < 0) return err_nomem(err, "a file name", strlen(folder));
    if (!textfile_open(&r.file, path, err)) description_header(&r.file, "remodel-shoot", 1, &version, err);
    while (!err->status && textfile_next(&r.file)) read_line(&r, err);
    if (!err->status) check_complete(&r, err);
    if (!err->status && prov) provenance_add_file(prov, "cameras.txt", path, err);
    textfile_release(&r.file);
    free(path);
    if (err->status) shoot_release(s);
    return err->status;
}

void shoot_release(struct shoot *s)
{
    if (!s) return;
    for (int i = 0; i < s->lens_count; i++) free(s->lenses[i].name);
    for (int i = 0; i < s->photo_count; i++) free(s->photos[i].name);
    free(s->lenses);
    for (int i = 0; i < 2; i++) free(s->exposures[i].list);
    free(s->photos);
    *s = (struct shoot){0};
}

struct shoot_exposure_list shoot_exposures(const struct shoot *s, const struct shoot_photo *photo)
{
    const struct shoot_exposure_list *all = &s->exposures[photo->kind == SHOOT_REFERENCE && s->exposures[1].count];
    return photo->exposure < 0 ? *all : (struct shoot_exposure_list){&all->list[photo->exposure], 1};
}

int shoot_find(const struct shoot *s, const char *name)
{
    for (int i = 0; i < s->photo_count; i++)
        if (!strcmp(s->photos[i].name, name)) return i;
    return -1;
}

/* ----------------------------------------------------------------------------------------------------------- lenses */

bool shoot_lens_ray(const struct shoot_lens *l, double u, double v, struct vec3 *ray)
{
    const double x = (u - l->cx) / l->fx, y = (v - l->cy) / l->fy;
    if (l->kind == SHOOT_PINHOLE) {
        *ray = vec3_normalize(vec3_make(x, y, 1));
        return true;
    }
    /* with r = 2 sin(theta / 2): cos(theta) = 1 - r^2 / 2 and sin(theta) / r = sqrt(1 - r^2 / 4) */
    const double rr = x * x + y * y;
    if (rr > 4) return false;
    if (l->circle > 0 && rr * l->fx * l->fx > circle_radius(l) * circle_radius(l)) return false;
    const double s = sqrt(1 - rr / 4);
    *ray = vec3_make(x * s, y * s, 1 - rr / 2);
    return true;
}

bool shoot_lens_project(const struct shoot_lens *l, struct vec3 p, double *u, double *v)
{
    double scale;
    if (l->kind == SHOOT_PINHOLE) {
        if (!(p.z > 0)) return false;
        scale = 1 / p.z;
    } else {
        const double aside = hypot(p.x, p.y), theta = atan2(aside, p.z);
        if (!(aside > 0) && !(p.z > 0)) return false;
        scale = aside > 0 ? 2 * sin(theta / 2) / aside : 1 / p.z;
    }
    *u = l->fx * p.x * scale + l->cx;
    *v = l->fy * p.y * scale + l->cy;
    return true;
}

struct camera shoot_lens_camera(const struct shoot_lens *l)
{
    struct camera c = {CAMERA_PINHOLE, l->width, l->height, {l->fx, l->fy, l->cx, l->cy}};
    if (l->kind == SHOOT_EQUISOLID) {
        const double k[4] = {-1.0 / 24, 1.0 / 1920, -1.0 / 322560, 1.0 / 92897280};
        c.model = CAMERA_OPENCV_FISHEYE;
        for (int i = 0; i < 4; i++) c.params[4 + i] = k[i];
    }
    return c;
}
