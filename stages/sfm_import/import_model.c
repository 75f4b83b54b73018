/* import_model.c - from a structure-from-motion model to rectified views.
 *
 * Images are matched to photos by name and cameras are scaled to the photos' sizes (importer_photos.c); every
 * observation's reprojection error is recomputed and outliers are dropped (importer_residuals.c); each photo's lens
 * becomes one pinhole view or several (view_cameras.h); the remaining observations are mapped through the lens into the
 * views that see them; points that are seen by two different photos are kept. */
#include "stages/sfm_import/import_model.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/product/product.h"
#include "stages/sfm_import/importer.h"

#define PARAM_STRUCT struct sfm_import_params
const struct param sfm_import_param_table[] = {SFM_IMPORT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { MIN_POINTS = 10 };     /* photos that see fewer are reported */
enum { MOST_UNSEEN = 20000 }; /* points that no two photos observe, evenly from all */

static int compare_views(const void *a, const void *b)
{
    return strcmp(((const struct output_view *)a)->name, ((const struct output_view *)b)->name);
}

static enum status make_views(struct importer *imp, struct err *err)
{
    const size_t max_views = (size_t)imp->in->image_count * MAX_PHOTO_VIEWS;
    int wide = 0;
    imp->views = calloc(max_views + 1, sizeof *imp->views);
    if (!imp->views) return err_nomem(err, "views", max_views * sizeof *imp->views);
    for (int i = 0; i < imp->in->image_count; i++) {
        const struct input_image *im = &imp->images[i];
        struct photo_view parts[MAX_PHOTO_VIEWS];
        int count = 0;
        if (im->photo < 0) continue;
        const struct photo_record *photo = &imp->photos->photos[im->photo];
        if (view_cameras_of_photo(parts, &count, &im->lens, imp->params->max_megapixels, imp->params->max_field, err))
            return err_context(err, "photo \"%s\"", photo->file);
        wide += parts[0].part >= 0;
        for (int k = 0; k < count; k++) {
            struct output_view *v = &imp->views[imp->view_count++];
            size_t size = strlen(photo->id) + 4;
            *v = (struct output_view){.image = i, .photo = im->photo, .view = parts[k]};
            camera_focal(&v->view.camera, &v->fx, &v->fy, &v->cx, &v->cy);
            v->view_from_photo = mat3_from_quat(v->view.view_from_photo);
            if (!(v->name = malloc(size))) return err_nomem(err, "a view's name", size);
            if (parts[k].part < 0)
                snprintf(v->name, size, "%s", photo->id);
            else
                snprintf(v->name, size, "%s@%d", photo->id, parts[k].part);
        }
    }
    qsort(imp->views, (size_t)imp->view_count, sizeof *imp->views, compare_views);
    for (int i = 0; i < imp->view_count; i++) {
        struct input_image *im = &imp->images[imp->views[i].image];
        im->views[im->view_count++] = i;
    }
    if (wide)
        log_note("%d photos have a field of view above %g degrees; each becomes several views", wide,
                 imp->params->max_field);
    return ST_OK;
}

static enum status make_cameras(const struct importer *imp, struct imported *out, struct err *err)
{
    size_t n = (size_t)imp->view_count;
    struct sfm_model *m = &out->model;
    m->cameras = calloc(n, sizeof *m->cameras);
    m->images = calloc(n, sizeof *m->images);
    out->lenses.lenses = calloc(n, sizeof *out->lenses.lenses);
    if (!m->cameras || !m->images || !out->lenses.lenses) return err_nomem(err, "views", n * sizeof *m->images);
    for (int i = 0; i < imp->view_count; i++) {
        const struct output_view *v = &imp->views[i];
        const struct pose *photo = &imp->in->images[v->image].cam_from_world;
        struct sfm_image *im = &m->images[m->image_count++];
        struct lens *l = &out->lenses.lenses[out->lenses.count++];
        size_t size = strlen(v->name) + 5;
        m->cameras[m->camera_count++] = (struct sfm_camera){i + 1, v->view.camera};
        im->id = i + 1;
        im->camera_idx = i;
        im->cam_from_world = *photo;
        if (v->view.part > 0) {
            im->cam_from_world.rotation = quat_multiply(v->view.view_from_photo, photo->rotation);
            im->cam_from_world.translation = mat3_apply(v->view_from_photo, photo->translation);
        }
        l->camera = imp->images[v->image].lens;
        l->view_from_photo = v->view.view_from_photo;
        im->name = malloc(size);
        l->view = strdup(v->name);
        l->photo = strdup(imp->photos->photos[v->photo].id);
        if (!im->name || !l->view || !l->photo) return err_nomem(err, "names", size);
        snprintf(im->name, size, "%s.exr", v->name);
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------- the points */

struct sighting { /* an observation of one point in one view; u, v in rectified pixels */
    int view, image;
    double u, v;
};

static int compare_sightings(const void *a, const void *b)
{
    const struct sighting *x = a, *y = b;
    if (x->view != y->view) return x->view < y->view ? -1 : 1;
    if (x->u != y->u) return x->u < y->u ? -1 : 1;
    return (x->v > y->v) - (x->v < y->v);
}

static bool same_camera(const struct camera *a, const struct camera *b)
{
    return a->model == b->model && a->width == b->width && a->height == b->height &&
           !memcmp(a->params, b->params, (size_t)camera_model_params(a->model) * sizeof *a->params);
}

/* Maps an observation in a photo to one of its views. False: it is outside the view. */
static bool rectify_observation(const struct importer *imp, const struct sfm_observation *o, int view,
                                struct sighting *s)
{
    const struct output_view *out = &imp->views[view];
    const struct input_image *im = &imp->images[out->image];
    const struct camera *c = &out->view.camera;
    double u = o->u * im->scale_u, v = o->v * im->scale_v;
    struct vec3 ray;
    if (out->view.part > 0 || !same_camera(c, &im->lens)) {
        if (!camera_unproject(&im->lens, u, v, &ray)) return false;
        ray = mat3_apply(out->view_from_photo, ray);
        if (!(ray.z > 0)) return false;
        u = out->fx * (ray.x / ray.z) + out->cx;
        v = out->fy * (ray.y / ray.z) + out->cy;
    }
    *s = (struct sighting){view, out->image, u, v};
    return u >= 0 && v >= 0 && u <= c->width && v <= c->height;
}

static enum status add_observation(struct sfm_model *m, const struct sighting *s, int64_t id, struct err *err)
{
    struct sfm_image *im = &m->images[s->view];
    if (array_append(&im->observations, (size_t)im->observation_count, sizeof *im->observations, "observations", err))
        return err->status;
    im->observations[im->observation_count++] = (struct sfm_observation){s->u, s->v, id};
    return ST_OK;
}

static enum status add_point(struct sfm_model *m, const struct sfm_point *p, const struct sighting *sightings,
                             int count, double error, struct err *err)
{
    struct sfm_point *out = &m->points[m->point_count];
    *out = *p;
    out->error = error;
    out->track_count = 0;
    out->track = malloc((size_t)count * sizeof *out->track);
    if (!out->track) return err_nomem(err, "a track", (size_t)count * sizeof *out->track);
    m->point_count++;
    for (int i = 0; i < count; i++) {
        if (add_observation(m, &sightings[i], p->id, err)) return err->status;
        out->track[out->track_count++] =
            (struct sfm_track){sightings[i].view, m->images[sightings[i].view].observation_count - 1};
    }
    return ST_OK;
}

static bool is_in_frame(const struct input_image *im, struct vec3 point)
{
    double u, v;
    const struct vec3 at = vec3_add(mat3_apply(im->cam_from_world, point), im->translation);
    return camera_project(&im->lens, at, &u, &v) && u >= 0 && v >= 0 && u <= im->lens.width && v <= im->lens.height;
}

/* Points that no two photos observe say at least where the scene is: keeps those in the frame of a photo, without
 * tracks. */
static enum status keep_unseen_points(const struct importer *imp, struct imported *out, struct err *err)
{
    const struct sfm_model *in = imp->in;
    const int stride = in->point_count / MOST_UNSEEN + 1;
    if (!in->point_count) return ST_OK;
    free(out->model.points);
    out->model.points = malloc(((size_t)in->point_count / (size_t)stride + 1) * sizeof *out->model.points);
    if (!out->model.points) return err_nomem(err, "points", (size_t)in->point_count * sizeof *out->model.points);
    for (int i = 0; i < in->point_count; i += stride) {
        bool framed = false;
        for (int k = 0; !framed && k < in->image_count; k++)
            framed = imp->images[k].photo >= 0 && is_in_frame(&imp->images[k], in->points[i].position);
        if (!framed) continue;
        struct sfm_point *p = &out->model.points[out->model.point_count++];
        *p = in->points[i];
        p->track = NULL;
        p->track_count = 0;
    }
    if (out->model.point_count)
        log_note("no two photos observe a point of the model: %d points only say between which depths the scene lies",
                 out->model.point_count);
    return ST_OK;
}

static enum status make_points(const struct importer *imp, struct imported *out, struct err *err)
{
    const struct sfm_model *in = imp->in;
    struct sighting *sightings = NULL;
    int longest = 0;
    for (int i = 0; i < in->point_count; i++)
        if (in->points[i].track_count > longest) longest = in->points[i].track_count;
    sightings = malloc(((size_t)longest * MAX_PHOTO_VIEWS + 1) * sizeof *sightings);
    out->model.points = malloc(((size_t)in->point_count + 1) * sizeof *out->model.points);
    if (!sightings || !out->model.points) err_nomem(err, "points", (size_t)in->point_count * sizeof *out->model.points);
    const double *error = imp->errors;
    for (int i = 0; !err->status && i < in->point_count; i++) {
        const struct sfm_point *p = &in->points[i];
        double sum = 0;
        int kept = 0, count = 0;
        for (int k = 0; k < p->track_count; k++, error++) {
            const struct sfm_track *t = &p->track[k];
            const struct input_image *im = &imp->images[t->image_idx];
            if (*error < 0 || *error > imp->params->max_error) continue;
            sum += *error;
            kept++;
            for (int j = 0; j < im->view_count; j++)
                count += rectify_observation(imp, &in->images[t->image_idx].observations[t->observation_idx],
                                             im->views[j], &sightings[count]);
        }
        bool two_photos = false;
        for (int k = 1; k < count; k++) two_photos |= sightings[k].image != sightings[0].image;
        if (!two_photos) continue;
        qsort(sightings, (size_t)count, sizeof *sightings, compare_sightings);
        add_point(&out->model, p, sightings, count, sum / kept, err);
    }
    free(sightings);
    if (!err->status && !out->model.point_count) keep_unseen_points(imp, out, err);
    return err->status;
}

static void warn_about_few_points(const struct importer *imp, const struct sfm_model *m)
{
    if (!m->point_count || !m->points[0].track_count) return;
    for (int i = 0; i < imp->in->image_count; i++) {
        const struct input_image *im = &imp->images[i];
        int seen = 0;
        for (int k = 0; k < im->view_count; k++) seen += m->images[im->views[k]].observation_count;
        if (im->view_count && seen < MIN_POINTS)
            log_warn("photo \"%s\" sees only %d points of the model; its depth may be poor",
                     imp->photos->photos[im->photo].file, seen);
    }
}

enum status import_model(struct imported *out, const struct sfm_model *model, const struct photo_list *photos,
                         const struct sfm_import_params *params, struct err *err)
{
    struct importer imp = {.in = model, .photos = photos, .params = params};
    struct import_stats *stats = &out->stats;
    *out = (struct imported){0};
    imp.images = calloc((size_t)model->image_count + 1, sizeof *imp.images);
    if (!imp.images) err_nomem(err, "images", (size_t)model->image_count * sizeof *imp.images);
    if (!err->status && !importer_match_photos(&imp, stats, err) && !importer_fit_lenses(&imp, err) &&
        !importer_measure_errors(&imp, stats, &out->residuals, err) && !importer_judge_errors(&imp, stats, err) &&
        !make_views(&imp, err) && !make_cameras(&imp, out, err))
        make_points(&imp, out, err);
    if (!err->status) {
        stats->points = out->model.point_count;
        stats->points_dropped = model->point_count - out->model.point_count;
        warn_about_few_points(&imp, &out->model);
        log_note("%d views of %d photos, %d points (%d seen by fewer than two photos are left out)", imp.view_count,
                 stats->registered, stats->points, stats->points_dropped);
    }
    for (int i = 0; i < imp.view_count; i++) free(imp.views[i].name);
    free(imp.views);
    free(imp.images);
    free(imp.errors);
    if (err->status) import_release(out);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------- writing */

static enum status write_views_mk(const struct imported *in, const char *path, struct err *err)
{
    struct outfile f = {0};
    if (!outfile_open(&f, path, err)) {
        fputs("VIEWS :=", f.fp);
        for (int i = 0; i < in->lenses.count; i++) fprintf(f.fp, " %s", in->lenses.lenses[i].view);
        fputc('\n', f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

enum status import_write(const struct imported *in, const char *folder, const struct provenance *prov, struct err *err)
{
    char lenses[FILE_PATH], views[FILE_PATH];
    if (!product_path_in(lenses, folder, PRODUCT_LENSES, NULL, err) &&
        !product_path_in(views, folder, PRODUCT_VIEWS_MK, NULL, err) &&
        !sfm_model_write_text(&in->model, folder, prov, err) && !lens_list_write(&in->lenses, lenses, prov, err))
        write_views_mk(in, views, err);
    return err->status;
}

void import_release(struct imported *in)
{
    if (!in) return;
    sfm_model_release(&in->model);
    lens_list_release(&in->lenses);
    residual_table_release(&in->residuals);
    *in = (struct imported){0};
}
