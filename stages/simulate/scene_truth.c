/* scene_truth.c - ground truth of a scene as a whole.
 *
 * Irradiance points: a random pixel of a random photo, its surface, and a point OFF_SURFACE in front of it, if there
 * is room for a probe. Random numbers are keyed by the point's index. */
#include "stages/simulate/scene_truth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/capture/sfm_model.h"
#include "common/product/product.h"
#include "stages/simulate/photos.h"

#define OFF_SURFACE 0.02 /* m: distance of an irradiance probe from its surface */
#define MAX_TRIES   1000

/* Kinds of cameras, as bits. */
enum { PHOTOS = 1u << SHOOT_PHOTO, REFERENCES = 1u << SHOOT_REFERENCE, WITNESSES = 1u << SHOOT_WITNESS };

/* ---------------------------------------------------------------------------------------------------------- cameras */

static void model_release(struct sfm_model *m)
{
    for (int i = 0; i < m->image_count; i++) free(m->images[i].name);
    free(m->images);
    free(m->cameras);
}

static bool lens_used(const struct shoot *s, unsigned kinds, int lens)
{
    for (int i = 0; i < s->photo_count; i++)
        if (s->photos[i].lens == lens && kinds >> s->photos[i].kind & 1) return true;
    return false;
}

/* The cameras of the kinds whose bits are set in `kinds`. */
static enum status write_cameras(const struct shoot *s, unsigned kinds, const char *folder,
                                 const struct provenance *prov, struct err *err)
{
    struct sfm_model m = {0};
    m.cameras = calloc((size_t)s->lens_count + 1, sizeof *m.cameras);
    m.images = calloc((size_t)s->photo_count + 1, sizeof *m.images);
    int *index = calloc((size_t)s->lens_count + 1, sizeof *index);
    if (!m.cameras || !m.images || !index) err_nomem(err, "cameras", (size_t)s->photo_count * sizeof *m.images);
    for (int i = 0; !err->status && i < s->lens_count; i++) {
        if (!lens_used(s, kinds, i)) continue;
        index[i] = m.camera_count;
        m.cameras[m.camera_count++] = (struct sfm_camera){i + 1, shoot_lens_camera(&s->lenses[i])};
    }
    for (int i = 0; !err->status && i < s->photo_count; i++) {
        const struct shoot_photo *photo = &s->photos[i];
        char *name = NULL;
        if (!(kinds >> photo->kind & 1)) continue;
        if (asprintf(&name, "%s.jpg", photo->name) < 0)
            err_nomem(err, "a name", strlen(photo->name));
        else
            m.images[m.image_count] =
                (struct sfm_image){m.image_count + 1, photo->cam_from_world, index[photo->lens], name, NULL, 0},
            m.image_count++;
    }
    if (!err->status) sfm_model_write_text(&m, folder, prov, err);
    model_release(&m);
    free(index);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- irradiance */

struct irradiance_job {
    struct irradiance_point *points;
    const struct world *world;
    const struct shoot *shoot;
    struct rng rng;
    int samples;
    bool *found;
    struct progress *progress;
};

/* A surface point that a photo sees, with room for a probe in front of it. */
static bool find_point(const struct irradiance_job *job, size_t index, struct irradiance_point *p)
{
    const struct shoot *s = job->shoot;
    for (uint64_t k = 0; k < MAX_TRIES; k++) {
        const struct shoot_photo *photo = &s->photos[(int)(rng_uniform(&job->rng, index, 3 * k) * s->photo_count)];
        const struct camera_view view = render_view_make(s, photo);
        const double u = rng_uniform(&job->rng, index, 3 * k + 1) * view.lens->width;
        const double v = rng_uniform(&job->rng, index, 3 * k + 2) * view.lens->height;
        struct path_ray ray;
        struct ray_hit hit;
        if (photo->kind != SHOOT_PHOTO || !render_view_ray(&view, u, v, &ray)) continue;
        if (!ray_scene_hit(&job->world->geometry.rays, ray.from, ray.direction, &hit)) continue;
        if (job->world->geometry.faces[hit.id].material < 0) continue;
        const struct vec3 off = vec3_add(hit.point, vec3_scale(hit.normal, job->world->geometry.rays.epsilon));
        if (ray_scene_blocked(&job->world->geometry.rays, off, hit.normal, 2 * OFF_SURFACE)) continue;
        p->point = vec3_add(hit.point, vec3_scale(hit.normal, OFF_SURFACE));
        p->normal = hit.normal;
        return true;
    }
    return false;
}

static void find_irradiance(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct irradiance_job *job = ctx;
    for (size_t i = begin; i < end; i++) {
        struct irradiance_point *p = &job->points[i];
        struct rgb sum = {0, 0, 0};
        uint64_t rays = 0;
        job->found[i] = find_point(job, i, p);
        struct sobol s = sobol_make(&job->rng, ~(uint64_t)i, job->samples);
        for (; job->found[i] && s.sample < (uint32_t)job->samples; s.sample++)
            sum = rgb_add(sum, path_irradiance(job->world, p->point, p->normal, &s, &rays));
        p->irradiance = rgb_scale(sum, 1.0 / job->samples);
        progress_add(job->progress, 1);
    }
}

enum status truth_irradiance(struct irradiance_point *points, int count, const struct world *w, const struct shoot *s,
                             const struct simulate_params *params, struct err *err)
{
    struct progress progress;
    bool *found = calloc((size_t)count + 1, sizeof *found);
    if (!found) err_nomem(err, "irradiance points", (size_t)count);
    if (!err->status) {
        struct irradiance_job job = {
            points, w,        s, rng_make((uint64_t)params->seed, "simulate", "irradiance"), params->irradiance_samples,
            found,  &progress};
        progress_start(&progress, "irradiance", count, "points");
        parallel_for((size_t)count, 1, find_irradiance, &job);
        progress_end(&progress);
    }
    for (int i = 0; !err->status && i < count; i++)
        if (!found[i])
            err_set(err, ST_DATA,
                    "the photos see no surface at which to compute irradiance; check where the cameras look, or set "
                    "[simulate] irradiance_points = 0.");
    free(found);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- text files */

struct text_job {
    const struct world *world;
    const struct shoot *shoot;
    const struct simulate_params *params;
    const struct irradiance_point *points;
    struct err *err; /* of a name without memory */
};

static void print_file_name(FILE *to, const char *before, const struct text_job *job, const struct shoot_photo *photo,
                            int exposure)
{
    char *name = photo_file_name(job->shoot, photo, exposure);
    if (name)
        fprintf(to, "%s%s", before, name);
    else
        err_nomem(job->err, "a photo's file name", strlen(photo->name));
    free(name);
}

static void print_faces(FILE *to, const struct text_job *job)
{
    const struct scene_geometry *g = &job->world->geometry;
    fputs("remodel-faces 1\n# id name area normal\n", to);
    for (int i = 0; i < g->face_count; i++) {
        const struct scene_face *f = &g->faces[i];
        fprintf(to, "%u %s %.9g %.9g %.9g %.9g\n", f->id, f->name, f->area, f->normal.x, f->normal.y, f->normal.z);
    }
}

static void print_irradiance(FILE *to, const struct text_job *job)
{
    fputs("# world position, normal, irradiance E rgb = integral L cos (same units as hdr radiance, no 1/pi); the "
          "point lies "
          "2 cm off the surface\n",
          to);
    for (int i = 0; i < job->params->irradiance_points; i++) {
        const struct irradiance_point *p = &job->points[i];
        fprintf(to, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p->point.x, p->point.y, p->point.z, p->normal.x,
                p->normal.y, p->normal.z, p->irradiance.r, p->irradiance.g, p->irradiance.b);
    }
}

static void print_exposures(FILE *to, const struct text_job *job)
{
    const struct shoot *s = job->shoot;
    fputs("# file seconds f-number iso neutral-density-factor\n", to);
    for (int i = 0; i < s->photo_count; i++)
        for (int k = 0; s->photos[i].kind == SHOOT_REFERENCE && k < shoot_exposures(s, &s->photos[i]).count; k++) {
            const struct shoot_exposure *e = &shoot_exposures(s, &s->photos[i]).list[k];
            print_file_name(to, "", job, &s->photos[i], k);
            fprintf(to, " %.9g %.9g %.9g %.9g\n", e->seconds, e->f_number, e->iso, e->filter);
        }
}

static void print_names(FILE *to, const char *variable, const struct shoot *s, unsigned kinds)
{
    fprintf(to, "%s :=", variable);
    for (int i = 0; i < s->photo_count; i++)
        if (kinds >> s->photos[i].kind & 1) fprintf(to, " %s", s->photos[i].name);
    fputc('\n', to);
}

/* For Make: the names of photos and reference images, the files of each, its JPEGs last; and the witnesses. */
static void print_lists(FILE *to, const struct text_job *job)
{
    print_names(to, "SHOTS", job->shoot, PHOTOS | REFERENCES);
    print_names(to, "TRUE_VIEWS", job->shoot, PHOTOS | WITNESSES);
    print_names(to, "WITNESSES", job->shoot, WITNESSES);
    for (int i = 0; i < job->shoot->photo_count; i++) {
        const struct shoot_photo *photo = &job->shoot->photos[i];
        const int exposures = shoot_exposures(job->shoot, photo).count;
        if (photo->kind == SHOOT_WITNESS) continue;
        fprintf(to, "SHOT_%s :=", photo->name);
        if (photo->kind == SHOOT_PHOTO && !strcmp(job->params->truth, "yes"))
            fprintf(to, " truth/depth/%s.exr truth/ids/%s.exr truth/hdr/%s.exr", photo->name, photo->name, photo->name);
        for (int k = 0; k < exposures; k++)
            print_file_name(to, photo->kind == SHOOT_REFERENCE ? " lri/" : " photos/", job, photo, k);
        fputc('\n', to);
    }
}

/* FOLDER stands for the product's. */
static enum status write_text(const char *folder, enum product_id id,
                              void (*print)(FILE *to, const struct text_job *job), const struct text_job *job,
                              const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, folder, id, NULL, err) && !outfile_open(&f, path, err)) {
        if (prov) provenance_print(prov, f.fp);
        print(f.fp, job);
        if (!err->status) outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

/* The described scene, whole, in the folder of a truth. */
static enum status write_scene(const struct world *w, const char *folder, const char *file, const char *truth,
                               struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, truth, PRODUCT_TRUE_SCENE, NULL, err)) return err->status;
    return scene_write(&w->scene, folder, file, path, err);
}

/* The cameras of one or more kinds, if there are any, in OUT/SUB. */
static enum status write_cameras_of(const struct shoot *s, unsigned kinds, const char *out, const char *sub,
                                    const struct provenance *prov, struct err *err)
{
    char folder[FILE_PATH];
    bool any = false;
    for (int i = 0; i < s->photo_count; i++) any = any || kinds >> s->photos[i].kind & 1;
    if (!any || file_path(folder, out, sub, "", err)) return err->status;
    return write_cameras(s, kinds, folder, prov, err);
}

static enum status write_references(const struct shoot *s, const char *out, const struct provenance *prov,
                                    const struct text_job *job, struct err *err)
{
    bool any = false;
    for (int i = 0; i < s->photo_count; i++) any = any || s->photos[i].kind == SHOOT_REFERENCE;
    if (!any) return ST_OK;
    return write_cameras_of(s, PHOTOS | REFERENCES, out, "truth/lri", prov, err) ||
                   write_text(out, PRODUCT_SIMULATED_EXPOSURES, print_exposures, job, NULL, err)
               ? err->status
               : ST_OK;
}

enum status truth_write(const struct world *w, const struct shoot *s, const char *folder, const char *out,
                        const struct simulate_params *params, const struct provenance *prov, struct err *err)
{
    const int count = params->irradiance_points;
    struct irradiance_point *points = calloc((size_t)count + 1, sizeof *points);
    struct text_job job = {w, s, params, points, err};
    char truth[FILE_PATH];
    if (!points) err_nomem(err, "irradiance points", (size_t)count * sizeof *points);
    if (!err->status && !file_path(truth, out, "truth", "", err) && !write_scene(w, folder, "scene.txt", truth, err) &&
        !write_text(truth, PRODUCT_TRUE_FACES, print_faces, &job, prov, err) &&
        !write_cameras_of(s, PHOTOS, out, "truth", prov, err) &&
        !write_cameras_of(s, WITNESSES, out, "truth/novel", prov, err))
        write_references(s, out, prov, &job, err);
    if (!err->status && count && !truth_irradiance(points, count, w, s, params, err))
        write_text(truth, PRODUCT_TRUE_IRRADIANCE_POINTS, print_irradiance, &job, prov, err);
    if (!err->status) write_text(out, PRODUCT_SIMULATED_MK, print_lists, &job, NULL, err);
    free(points);
    return err->status;
}

enum status truth_write_edited(const struct world *w, const struct shoot *s, const char *folder, const char *out,
                               const char *edit, const struct provenance *prov, struct err *err)
{
    struct text_job job = {.world = w, .err = err};
    char from[FILE_PATH], below[FILE_PATH], truth[FILE_PATH];
    snprintf(from, sizeof from, "scene-%s.txt", edit);
    snprintf(below, sizeof below, "truth/edited-%s", edit);
    if (file_path(truth, out, below, "", err) || write_scene(w, folder, from, truth, err) ||
        write_text(truth, PRODUCT_TRUE_FACES, print_faces, &job, prov, err))
        return err->status;
    return write_cameras_of(s, PHOTOS | WITNESSES, out, below, prov, err);
}
