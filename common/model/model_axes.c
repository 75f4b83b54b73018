/* model_axes.c - the frame of a room's model: transforms and its file. */
#include "common/model/model_axes.h"

#include <math.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/product/product.h"

static const double UNIT = 1e-6; /* tolerance of a quaternion's length */

/* ------------------------------------------------------------------------------------------------------- transforms */

struct vec3 model_from_world_point(const struct model_axes *axes, struct vec3 world)
{
    return vec3_add(vec3_scale(model_from_world_direction(axes, world), axes->scale), axes->translation);
}

struct vec3 world_from_model_point(const struct model_axes *axes, struct vec3 model)
{
    return world_from_model_direction(axes, vec3_scale(vec3_sub(model, axes->translation), 1 / axes->scale));
}

struct vec3 model_from_world_direction(const struct model_axes *axes, struct vec3 world)
{
    return mat3_apply(mat3_from_quat(axes->rotation), world);
}

struct vec3 world_from_model_direction(const struct model_axes *axes, struct vec3 model)
{
    return mat3_apply(mat3_transpose(mat3_from_quat(axes->rotation)), model);
}

/* The camera's axes are scaled with the world: s p_cam = Rc R^T p_model + (s tc - Rc R^T t). */
struct view model_from_world_view(const struct model_axes *axes, const struct view *world)
{
    struct view v = *world;
    v.cam_from_world = mat3_multiply(world->cam_from_world, mat3_transpose(mat3_from_quat(axes->rotation)));
    v.translation =
        vec3_sub(vec3_scale(world->translation, axes->scale), mat3_apply(v.cam_from_world, axes->translation));
    v.center = model_from_world_point(axes, world->center);
    return v;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static void print_or_none(FILE *to, const char *name, bool known, double value)
{
    if (known)
        fprintf(to, "%s %.17g\n", name, value);
    else
        fprintf(to, "%s none\n", name);
}

enum status model_axes_write(const struct model_axes *axes, const char *path, const struct provenance *prov,
                             struct err *err)
{
    struct outfile f = {0};
    const struct quat q = axes->rotation;
    const struct vec3 t = axes->translation;
    if (!product_begin(&f, PRODUCT_AXES, path, prov, err)) {
        fprintf(f.fp, "rotation %.17g %.17g %.17g %.17g\ntranslation %.17g %.17g %.17g\n", q.w, q.x, q.y, q.z, t.x, t.y,
                t.z);
        fprintf(f.fp, "scale %.17g %s\n", axes->scale, axes->metric ? "metres" : "unknown");
        print_or_none(f.fp, "ceiling", axes->ceiling > 0, axes->ceiling);
        print_or_none(f.fp, "thickness", axes->thickness > 0, axes->thickness);
        fprintf(f.fp, "error tilt %.17g\nerror heading %.17g\nerror floor %.17g\n", axes->tilt_error,
                axes->heading_error, axes->floor_error);
        print_or_none(f.fp, "error ceiling", axes->ceiling > 0, axes->ceiling_error);
        print_or_none(f.fp, "error scale", axes->metric, axes->scale_error);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_error(struct textfile *t, const char *which, double *value, struct err *err)
{
    if (textfile_expect_line(t, "error", err) || textfile_expect(t, which, err) ||
        textfile_number(t, "an error", 0, INFINITY, value, err))
        return err->status;
    return textfile_end(t, err);
}

/* Reads a number, or "none", which leaves *value unchanged and clears *known. */
static enum status number_or_none(struct textfile *t, const char *what, double *value, bool *known, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    *known = strcmp(word, "none");
    if (*known && !scan_double(word, value)) return textfile_error(t, err, word, "%s", what);
    return textfile_end(t, err);
}

static enum status read_length(struct textfile *t, const char *which, double *value, struct err *err)
{
    bool known;
    if (textfile_expect_line(t, which, err) || number_or_none(t, "a length, or none", value, &known, err))
        return err->status;
    return !known || *value > 0 ? ST_OK : textfile_wrong_number(t, *value, "a length above 0, or none", err);
}

/* The error of an optional value: a number if `given`, "none" otherwise. */
static enum status read_error_of(struct textfile *t, const char *which, bool given, double *value, struct err *err)
{
    bool known = false;
    if (textfile_expect_line(t, "error", err) || textfile_expect(t, which, err) ||
        number_or_none(t, "an error, or none", value, &known, err))
        return err->status;
    if (given && !known) return textfile_error(t, err, "none", "an error, as the file has a %s", which);
    if (!given && known) return textfile_wrong_number(t, *value, "none, as the file has no such value", err);
    return *value >= 0 ? ST_OK : textfile_wrong_number(t, *value, "an error of 0 or more", err);
}

static enum status read_similarity(struct textfile *t, struct model_axes *a, struct err *err)
{
    struct quat *q = &a->rotation;
    char *unit;
    if (textfile_expect_line(t, "rotation", err) || textfile_double(t, "w", &q->w, err) ||
        textfile_double(t, "x", &q->x, err) || textfile_double(t, "y", &q->y, err) ||
        textfile_double(t, "z", &q->z, err) || textfile_end(t, err))
        return err->status;
    const double length = sqrt(q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z);
    if (!(fabs(length - 1) <= UNIT)) return textfile_wrong_number(t, length, "a quaternion of length 1", err);
    if (textfile_expect_line(t, "translation", err) || textfile_double(t, "x", &a->translation.x, err) ||
        textfile_double(t, "y", &a->translation.y, err) || textfile_double(t, "z", &a->translation.z, err) ||
        textfile_end(t, err) || textfile_expect_line(t, "scale", err) ||
        textfile_double(t, "a scale", &a->scale, err) || textfile_word(t, "\"metres\" or \"unknown\"", &unit, err))
        return err->status;
    a->metric = !strcmp(unit, "metres");
    if (!a->metric && strcmp(unit, "unknown")) return textfile_error(t, err, unit, "\"metres\" or \"unknown\"");
    if (!(a->scale > 0)) return textfile_wrong_number(t, a->scale, "a scale above 0", err);
    if (!a->metric && a->scale != 1) return textfile_wrong_number(t, a->scale, "1, as the scale is unknown", err);
    return textfile_end(t, err);
}

enum status model_axes_read(struct model_axes *axes, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    struct model_axes a = {0};
    if (!product_open(&t, NULL, PRODUCT_AXES, path, prov, err) && !read_similarity(&t, &a, err) &&
        !read_length(&t, "ceiling", &a.ceiling, err))
        read_length(&t, "thickness", &a.thickness, err);
    if (!err->status && !read_error(&t, "tilt", &a.tilt_error, err) &&
        !read_error(&t, "heading", &a.heading_error, err) && !read_error(&t, "floor", &a.floor_error, err) &&
        !read_error_of(&t, "ceiling", a.ceiling > 0, &a.ceiling_error, err) &&
        !read_error_of(&t, "scale", a.metric, &a.scale_error, err))
        textfile_end_of_file(&t, err);
    textfile_release(&t);
    *axes = err->status ? (struct model_axes){0} : a;
    return err->status;
}
