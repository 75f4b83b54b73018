/* evaluate_texture_cover.c - whether atlases hold all that declared edits can show: texture.covered, and for the VITA
 * all of the model and of its edits: texture.vita.covered.
 *
 * What edits reveal to a view is O/reveal/VIEW.exr, a point for each pixel and layer; it must have a colour in an atlas
 * of the view's viewpoint. Every face of the model, and every face of an edit that lies in the plane of the model's
 * face of that id, must have one in the VITA; it is sampled at the centres of equal parts of its triangles. */
#include "stages/evaluate/texture/texture_metrics.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/model/model_axes.h"
#include "common/texture/view_ids.h"
#include "stages/evaluate/texture/loaded_atlas.h"

enum { CHUNK = 4096, SAMPLES = 100000 };
#define SAME_PLANE 1e-6 /* of the model's size: planes that differ by more are not the same */

struct cover_point {
    struct vec3 p; /* in the model's frame */
    int face;
    double weight;
    bool filled;
};

struct cover_points {
    struct cover_point *list; /* owned */
    size_t count;
};

struct cover_sum {
    double filled, all;
};

static enum status add_point(struct cover_points *c, struct cover_point p, struct err *err)
{
    if (array_append(&c->list, c->count, sizeof *c->list, "points", err)) return err->status;
    c->list[c->count++] = p;
    return ST_OK;
}

struct look_up_job {
    struct cover_points *points;
    const struct loaded_atlas *atlas;
};

static void look_up(void *ctx, size_t begin, size_t end, int thread)
{
    const struct look_up_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct cover_point *p = &job->points->list[i];
        float rgb[3];
        p->filled = loaded_atlas_look_up(rgb, job->atlas, p->face, p->p) && (rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0);
    }
}

static void add_sum(struct cover_sum *sum, struct cover_points *points, const struct loaded_atlas *atlas)
{
    struct look_up_job job = {points, atlas};
    parallel_for(points->count, CHUNK, look_up, &job);
    for (size_t i = 0; i < points->count; i++) {
        sum->all += points->list[i].weight;
        if (points->list[i].filled) sum->filled += points->list[i].weight;
    }
}

/* ------------------------------------------------------------------------------------------------- what is revealed */

static enum status add_layer(struct cover_points *c, const struct view_reveal *r, int k, const struct view *view,
                             const struct model_axes *axes, struct err *err)
{
    const size_t width = (size_t)r->width, pixels = width * (size_t)r->height;
    for (size_t i = 0; i < pixels; i++) {
        if (!r->id[k][i]) continue;
        const struct vec3 scene =
            view_unproject(view, (double)(i % width) + 0.5, (double)(i / width) + 0.5, r->z[k][i]);
        const struct cover_point p = {model_from_world_point(axes, scene), (int)r->id[k][i], 1, false};
        if (add_point(c, p, err)) return err->status;
    }
    return ST_OK;
}

/* Without a file nothing is revealed to the view. */
static enum status read_revealed(struct cover_points *c, struct evaluation *e, const struct view *view,
                                 const struct model_axes *axes, struct err *err)
{
    struct view_reveal revealed = {0};
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_REVEAL, &(struct product_key){.view = view->name}, err)) return err->status;
    if (!path_is_file(path)) return ST_OK;
    view_reveal_read(&revealed, view, path, e->prov, err);
    for (int k = 0; !err->status && k < revealed.layers; k++) add_layer(c, &revealed, k, view, axes, err);
    view_reveal_release(&revealed);
    return err->status;
}

static enum status cover_viewpoint(struct cover_sum *sum, struct evaluation *e, const char *name,
                                   const struct model_axes *axes, struct err *err)
{
    struct loaded_atlas atlas = {0};
    struct cover_points points = {0};
    loaded_atlas_read(&atlas, e, name, err);
    for (int i = 0; !err->status && i < atlas.atlas.view_count; i++) {
        const int view = camera_set_find(&e->views.cameras, atlas.atlas.views[i]);
        if (view < 0)
            err_set(err, ST_DATA, "%s: view %s is none of the scene's; bake it again.", name, atlas.atlas.views[i]);
        else
            read_revealed(&points, e, &e->views.cameras.views[view], axes, err);
    }
    if (!err->status) add_sum(sum, &points, &atlas);
    free(points.list);
    loaded_atlas_release(&atlas);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------- whole models */

static double mesh_size(const struct solid_mesh *mesh)
{
    double most = 0;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        most = fmax(most, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
    }
    return most;
}

/* The model before edits has the face, in the same plane. */
static bool in_model(const struct textures *t, const struct solid_mesh *mesh, int face)
{
    const int of = textures_face(t, solid_face_id(mesh, face));
    if (of < 0) return false;
    const struct solid_face *a = &t->mesh.faces[of], *b = &mesh->faces[face];
    return vec3_dot(a->normal, b->normal) > 1 - SAME_PLANE &&
           fabs(a->offset - b->offset) <= SAME_PLANE * mesh_size(&t->mesh);
}

/* Points at the centres of n x n equal parts of a triangle. */
static enum status sample_triangle(struct cover_points *c, const struct vec3 corner[3], int face, double spacing,
                                   struct err *err)
{
    const struct vec3 u = vec3_sub(corner[1], corner[0]), v = vec3_sub(corner[2], corner[0]);
    const double area = vec3_length(vec3_cross(u, v)) / 2;
    const int n = (int)fmin(fmax(ceil(sqrt(area) / spacing), 1), SAMPLES);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < 2 * (n - j) - 1; i++) {
            const double third = (i & 1 ? 2 : 1) / 3.0, a = (i / 2 + third) / n, b = (j + third) / n;
            const struct vec3 p = vec3_add(corner[0], vec3_add(vec3_scale(u, a), vec3_scale(v, b)));
            if (add_point(c, (struct cover_point){p, face, area / n / n, false}, err)) return err->status;
        }
    return ST_OK;
}

static enum status sample_mesh(struct cover_points *c, const struct textures *t, const struct solid_mesh *mesh,
                               struct err *err)
{
    struct solid_triangles triangles = {0};
    double area = 0;
    for (int i = 0; i < mesh->face_count; i++) area += solid_mesh_area(mesh, i);
    const double spacing = sqrt(area / SAMPLES);
    solid_mesh_triangulate(&triangles, mesh, err);
    for (int i = 0; !err->status && i < triangles.count; i++) {
        const struct solid_triangle *f = &triangles.triangles[i];
        struct vec3 corner[3];
        if (!in_model(t, mesh, f->face)) continue;
        for (int k = 0; k < 3; k++) corner[k] = mesh->vertices[f->v[k]].p;
        sample_triangle(c, corner, solid_face_id(mesh, f->face), spacing, err);
    }
    solid_triangles_release(&triangles);
    return err->status;
}

static enum status sample_edit(struct cover_points *c, const struct textures *t, struct evaluation *e, const char *edit,
                               struct err *err)
{
    struct solid_mesh mesh = {0};
    char where[FILE_PATH], path[FILE_PATH];
    if (!file_path(where, "remodel", edit, "", err) &&
        !evaluation_path(path, e, PRODUCT_MODEL, &(struct product_key){.model = where}, err) &&
        !solid_mesh_read(&mesh, path, e->prov, err))
        sample_mesh(c, t, &mesh, err);
    solid_mesh_release(&mesh);
    return err->status;
}

/* The model, and the models of all edits O/remodel/E. */
static enum status sample_models(struct cover_points *c, const struct textures *t, struct evaluation *e,
                                 struct err *err)
{
    struct dirent **entries = NULL;
    char folder[FILE_PATH], path[FILE_PATH];
    if (!sample_mesh(c, t, &t->mesh, err)) file_path(folder, e->folder, "remodel", "", err);
    if (err->status || !path_is_folder(folder)) return err->status;
    const int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0) return err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        if (!err->status && entries[i]->d_name[0] != '.') {
            file_path(path, folder, entries[i]->d_name, "/model.txt", err);
            if (!err->status && path_is_file(path)) sample_edit(c, t, e, entries[i]->d_name, err);
        }
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

static enum status cover_vita(struct cover_sum *sum, struct evaluation *e, const struct textures *t, struct err *err)
{
    struct loaded_atlas atlas = {0};
    struct cover_points points = {0};
    if (!loaded_atlas_read(&atlas, e, NULL, err) && !sample_models(&points, t, e, err)) add_sum(sum, &points, &atlas);
    free(points.list);
    loaded_atlas_release(&atlas);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------- the table */

static enum status add_share(struct evaluation *e, const char *prefix, const struct cover_sum *sum, struct err *err)
{
    if (!(sum->all > 0))
        return metric_note(&e->table, err, "skipped %s.covered: the declared edits reveal nothing (no reveal/VIEW.exr)",
                           prefix);
    return evaluation_metric(e, NULL, prefix, "covered", 100 * sum->filled / sum->all, err);
}

enum status evaluate_texture_cover(struct evaluation *e, struct err *err)
{
    struct textures t = {0};
    struct model_axes axes;
    struct cover_sum revealed = {0, 0}, whole = {0, 0};
    char path[FILE_PATH];
    textures_find(&t, e, err);
    const bool some = !err->status && (t.viewpoint_count || t.vita);
    if (some) evaluation_path(path, e, PRODUCT_AXES, NULL, err);
    if (some && !err->status) model_axes_read(&axes, path, e->prov, err);
    for (int i = 0; !err->status && i < t.viewpoint_count; i++)
        cover_viewpoint(&revealed, e, t.viewpoints[i], &axes, err);
    if (!err->status && t.viewpoint_count) add_share(e, "texture", &revealed, err);
    if (!err->status && t.vita) cover_vita(&whole, e, &t, err);
    if (!err->status && t.vita) add_share(e, "texture.vita", &whole, err);
    textures_release(&t);
    return err->status;
}
