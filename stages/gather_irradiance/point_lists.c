/* point_lists.c - see point_lists.h. */
#include "stages/gather_irradiance/point_lists.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/light/surface_points.h"
#include "common/product/product.h"
#include "stages/gather_irradiance/light_summary.h"

enum { MAX_POINTS = 10000000 };

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status open_list(struct outfile *f, const struct gather_job *j, const char *name, enum product_id id,
                             const char *head, struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, j->out, id, &(struct product_key){.gathered = name}, err) ||
        product_begin(f, id, path, &j->prov, err))
        return err->status;
    fputs(head, f->fp);
    return ST_OK;
}

static enum status write_parts(const struct gather_job *j, const char *name, const struct irradiance *e, int count,
                               struct err *err)
{
    struct outfile f = {0};
    open_list(&f, j, name, PRODUCT_IRRADIANCE_PARTS,
              "# standard error r g b, rays, nearest distance and 1 / (harmonic mean distance) in model "
              "units, shares of the light: none texture synthesised sky sky-guessed lamp material object\n",
              err);
    for (int i = 0; !err->status && i < count; i++) {
        const double nearest = isfinite(e[i].nearest) ? e[i].nearest : 0;
        fprintf(f.fp, "%.6g %.6g %.6g %d %.6g %.6g", e[i].error.r, e[i].error.g, e[i].error.b, e[i].rays, nearest,
                e[i].mean_inverse);
        for (int s = 0; s < LIGHT_SOURCES; s++) fprintf(f.fp, " %.6f", e[i].from[s]);
        fputc('\n', f.fp);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static enum status write_points(const struct gather_job *j, const char *name, const struct surface_points *points,
                                const struct irradiance *e, struct err *err)
{
    struct outfile f = {0};
    open_list(&f, j, name, PRODUCT_IRRADIANCE, "# x y z, normal, irradiance r g b; in the frame of the views\n", err);
    for (int i = 0; !err->status && i < points->count; i++) {
        const struct surface_point *p = &points->list[i];
        fprintf(f.fp, "%.17g %.17g %.17g %.17g %.17g %.17g %.9g %.9g %.9g\n", p->at.x, p->at.y, p->at.z, p->normal.x,
                p->normal.y, p->normal.z, e[i].value.r, e[i].value.g, e[i].value.b);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* Gathers at points in the scene's frame and writes both lists. */
static enum status gather_points(struct gather_job *j, const char *name, const struct surface_points *points,
                                 struct err *err)
{
    const size_t count = (size_t)points->count;
    struct gather_point *at = malloc((count + 1) * sizeof *at);
    struct irradiance *found = calloc(count + 1, sizeof *found);
    if (!at || !found) err_nomem(err, "points", count * (sizeof *at + sizeof *found));
    for (size_t i = 0; !err->status && i < count; i++)
        at[i] = (struct gather_point){model_from_world_point(&j->axes, points->list[i].at),
                                      model_from_world_direction(&j->axes, points->list[i].normal)};
    if (!err->status && !gather_all(found, at, count, j, "irradiance", err) &&
        !light_summary_of_points(j, name, at, found, count, err) && !write_parts(j, name, found, points->count, err))
        write_points(j, name, points, found, err);
    free(at);
    free(found);
    return err->status;
}

enum status gather_points_of_file(struct gather_job *j, const char *path, struct err *err)
{
    struct surface_points points = {0};
    if (!provenance_add_file(&j->prov, "points", path, err) && !surface_points_read(&points, path, err))
        gather_points(j, "irradiance", &points, err);
    surface_points_release(&points);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- a face */

enum status gather_read_step(double *step, const char *text, struct err *err)
{
    char *end;
    *step = strtod(text, &end);
    if (end != text && !*end && *step > 0 && isfinite(*step)) return ST_OK;
    return err_set(err, ST_USAGE, "--step %s: wanted a number above 0, the distance of points in units of the model.",
                   text);
}

/* A lattice on the planes of a face: (i, j) is at base + i right + j down. */
struct lattice {
    struct vec3 base, right, down, normal;
    int width, height;
};

static enum status make_lattice(struct lattice *l, const struct solid_mesh *mesh, int face, double step,
                                struct err *err)
{
    const struct solid_face *f = &mesh->faces[face];
    const struct vec3 up = fabs(f->normal.z) > 0.9 ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    const struct vec3 u = vec3_normalize(vec3_cross(up, f->normal)), v = vec3_cross(u, f->normal);
    double low[2], high[2];
    solid_face_box(mesh, face, u, v, low, high);
    /* points on whole multiples of the step, so that faces of one plane share a lattice */
    const double left = ceil(low[0] / step), top = ceil(low[1] / step);
    const double width = floor(high[0] / step) - left + 1, height = floor(high[1] / step) - top + 1;
    if (width * height > MAX_POINTS)
        return err_set(err, ST_DATA, "face %d has %.0f points at a step of %g, wanted at most %d; give a larger step.",
                       solid_face_id(mesh, face), width * height, step, MAX_POINTS);
    l->width = width > 0 ? (int)width : 0;
    l->height = height > 0 ? (int)height : 0;
    l->right = vec3_scale(u, step);
    l->down = vec3_scale(v, step);
    l->normal = f->normal;
    l->base =
        vec3_add(vec3_add(vec3_scale(u, left * step), vec3_scale(v, top * step)), vec3_scale(f->normal, f->offset));
    return ST_OK;
}

static bool is_on_face(const struct gather_job *j, int face, struct vec3 p, struct vec3 normal)
{
    const double off = 8 * j->field.model.rays.epsilon;
    struct ray_hit hit;
    if (!ray_scene_hit(&j->field.model.rays, vec3_add(p, vec3_scale(normal, off)), vec3_scale(normal, -1), &hit))
        return false;
    return (int)hit.id == face && hit.front && hit.t < 2 * off;
}

static enum status add_face(struct surface_points *points, const struct gather_job *j, int face, double step,
                            struct err *err)
{
    struct lattice l = {0};
    if (make_lattice(&l, &j->field.model.mesh, face, step, err)) return err->status;
    for (int y = 0; y < l.height; y++)
        for (int x = 0; x < l.width; x++) {
            const struct vec3 p = vec3_add(l.base, vec3_add(vec3_scale(l.right, x), vec3_scale(l.down, y)));
            if (!is_on_face(j, face, p, l.normal)) continue;
            if (array_append(&points->list, (size_t)points->count, sizeof *points->list, "points", err))
                return err->status;
            points->list[points->count++] = (struct surface_point){world_from_model_point(&j->axes, p),
                                                                   world_from_model_direction(&j->axes, l.normal)};
        }
    return ST_OK;
}

enum status gather_points_of_face(struct gather_job *j, int face, double step, struct err *err)
{
    const struct solid_mesh *mesh = &j->field.model.mesh;
    struct surface_points points = {0};
    char name[64];
    bool found = false;
    for (int i = 0; !err->status && i < mesh->face_count; i++) {
        if (solid_face_id(mesh, i) != face) continue;
        found = true;
        add_face(&points, j, i, step, err);
    }
    if (!err->status && !found)
        err_set(err, ST_USAGE, "--face %d: the model has no such face; its ids go up to %d.", face,
                j->field.model.ids - 1);
    if (!err->status && !points.count)
        err_set(err, ST_DATA, "face %d has no point at a step of %g; give a smaller step.", face, step);
    snprintf(name, sizeof name, "irradiance/face-%d", face);
    if (!err->status) gather_points(j, name, &points, err);
    surface_points_release(&points);
    return err->status;
}
