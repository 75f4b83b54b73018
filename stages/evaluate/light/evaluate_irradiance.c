/* evaluate_irradiance.c - irradiance at points against the truth: irradiance.*
 *
 * FOLDER/relight/irradiance.txt is in the frame of O/views and in the radiance unit of the views, and holds the points
 * of TRUTH/irradiance.txt, which FOLDER/evaluate/irradiance_points.txt has in that frame. irradiance_pictures.c
 * measures pictures of irradiance. */
#include "stages/evaluate/light/light_metrics.h"

#include <stdlib.h>

#include "common/base/outfile.h"
#include "common/light/model_rays.h"
#include "stages/evaluate/light/irradiance_error.h"
#include "stages/evaluate/light/irradiance_pictures.h"
#include "stages/evaluate/scene/model_frame.h"

#define MIN_COSINE 0.93969262078590838 /* cos 20 degrees: between a point's normal and that of the face it lies on */

/* The true points in the frame of O/views. */
static enum status write_points(const struct evaluation *e, const struct irradiance_list *truth, struct err *err)
{
    const struct similarity *s = &e->truth_from_scene;
    const struct mat3 turn = mat3_transpose(s->rotation);
    struct outfile f = {0};
    char path[FILE_PATH];
    if (!evaluation_path(path, e, PRODUCT_TRUTH_POINTS, NULL, err)) outfile_open(&f, path, err);
    if (!err->status) {
        struct provenance prov = *e->prov; /* shares its arrays with e->prov */
        prov.count = e->shared_inputs;
        provenance_print(&prov, f.fp);
        fputs("# x y z, normal: the points of TRUTH/irradiance.txt in the frame of views\n", f.fp);
        for (int i = 0; i < truth->count; i++) {
            const struct vec3 p =
                vec3_scale(mat3_apply(turn, vec3_sub(truth->points[i].point, s->translation)), 1 / s->scale);
            const struct vec3 n = mat3_apply(turn, truth->points[i].normal);
            fprintf(f.fp, "%.17g %.17g %.17g %.17g %.17g %.17g\n", p.x, p.y, p.z, n.x, n.y, n.z);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

static void bring_to_truth(struct irradiance_list *found, const struct similarity *s)
{
    for (int i = 0; i < found->count; i++) {
        struct irradiance_at *p = &found->points[i];
        p->point = vec3_add(vec3_scale(mat3_apply(s->rotation, p->point), s->scale), s->translation);
        p->normal = mat3_apply(s->rotation, p->normal);
    }
}

/* Whether a face of the model with the point's normal is within `reach` (m) of it. */
static bool on_model(const struct model_rays *m, const struct model_frame *frame, const struct irradiance_at *p,
                     double reach)
{
    const double unit = model_frame_truth_per_unit(frame);
    const struct vec3 up = model_from_truth_direction(frame, p->normal);
    const struct vec3 from = vec3_add(model_from_truth_point(frame, p->point), vec3_scale(up, reach / unit));
    struct ray_hit hit;
    if (!ray_scene_hit(&m->rays, from, vec3_scale(up, -1), &hit)) return false;
    return hit.front && hit.t <= 2 * reach / unit && vec3_dot(hit.normal, up) >= MIN_COSINE;
}

/* on[i]: point i lies on the model. *known: there is a model. */
static enum status mark_model(bool *on, bool *known, struct evaluation *e, const struct irradiance_list *truth,
                              struct err *err)
{
    static const struct mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    struct model_rays model = {0};
    struct model_frame frame;
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_MODEL, NULL, err)) return err->status;
    *known = path_is_file(path);
    if (!*known)
        return metric_note(&e->table, err, "skipped irradiance on surfaces of the model: model/model.txt is missing");
    if (!model_rays_read(&model, path, MODEL_WITHOUT_GLASS, e->prov, err))
        model_frame_read(&frame, e, same, vec3_make(0, 0, 0), err);
    for (int i = 0; !err->status && i < truth->count; i++)
        on[i] = on_model(&model, &frame, &truth->points[i], e->params->surface_distance);
    model_rays_release(&model);
    return err->status;
}

static enum status add_errors(struct evaluation *e, const char *prefix, const char *suffix,
                              const struct irradiance_errors *r, struct err *err)
{
    char name[64];
    snprintf(name, sizeof name, "points%s", suffix);
    if (evaluation_metric(e, NULL, prefix, name, r->points, err)) return err->status;
    if (!r->points) return ST_OK;
    snprintf(name, sizeof name, "rms%s", suffix);
    if (evaluation_metric(e, NULL, prefix, name, 100 * r->rms, err)) return err->status;
    snprintf(name, sizeof name, "error50%s", suffix);
    if (evaluation_metric(e, NULL, prefix, name, 100 * r->error50, err)) return err->status;
    snprintf(name, sizeof name, "error90%s", suffix);
    return evaluation_metric(e, NULL, prefix, name, 100 * r->error90, err);
}

/* What is compared: the lists, each true point's partner, and whether it lies on the model. */
struct irradiance_job {
    struct irradiance_list truth, found;
    int *partner;
    bool *all, *on, *off;
};

static enum status find_scale(double *scale, struct evaluation *e, const struct irradiance_job *job, struct err *err)
{
    *scale = e->radiance_scale;
    if (*scale > 0) return ST_OK;
    if (irradiance_scale(scale, &job->truth, &job->found, job->partner, err)) return err->status;
    if (!(*scale > 0)) return ST_OK;
    return metric_note(&e->table, err,
                       "note: the scale of irradiance is the median ratio %.5g of its points, because no view of a "
                       "photo with a true radiance gives it",
                       *scale);
}

static enum status compare(struct evaluation *e, struct irradiance_job *job, struct err *err)
{
    struct irradiance_errors all, on, off;
    int missing = 0, black = 0;
    bool known = false;
    double scale;
    for (int i = 0; i < job->truth.count; i++) {
        const double *rgb = job->truth.points[i].rgb;
        black += !(rgb[0] + rgb[1] + rgb[2] > 0);
        missing += job->partner[i] < 0;
        job->all[i] = true;
    }
    if (missing == job->truth.count)
        return metric_note(&e->table, err,
                           "skipped irradiance: no point of relight/irradiance.txt is one of the truth "
                           "(evaluate/irradiance_points.txt has them)");
    if (find_scale(&scale, e, job, err) || mark_model(job->on, &known, e, &job->truth, err)) return err->status;
    if (!(scale > 0)) return metric_note(&e->table, err, "skipped irradiance: it is 0 at every point");
    for (int i = 0; i < job->truth.count; i++) job->off[i] = !job->on[i];
    if (irradiance_errors(&all, &job->truth, &job->found, job->partner, job->all, scale, err) ||
        irradiance_errors(&on, &job->truth, &job->found, job->partner, job->on, scale, err) ||
        irradiance_errors(&off, &job->truth, &job->found, job->partner, job->off, scale, err) ||
        add_errors(e, "irradiance", "", &all, err) || evaluation_metric(e, NULL, "irradiance", "missing", missing, err))
        return err->status;
    if (known && (add_errors(e, "irradiance", "_model", &on, err) || add_errors(e, "irradiance", "_other", &off, err)))
        return err->status;
    if (!black) return ST_OK;
    return metric_note(&e->table, err, "note: %d points without any true irradiance are left out of irradiance.*",
                       black);
}

static enum status evaluate_points(struct evaluation *e, struct err *err)
{
    struct irradiance_job job = {0};
    char path[FILE_PATH], found[FILE_PATH];
    if (file_path(path, e->truth_folder, "irradiance.txt", "", err) ||
        evaluation_path(found, e, PRODUCT_IRRADIANCE, NULL, err))
        return err->status;
    if (!path_is_file(path)) return metric_note(&e->table, err, "skipped irradiance: the truth has no irradiance.txt");
    if (!e->aligned)
        return metric_note(&e->table, err, "skipped irradiance: the cameras do not tell where the truth is");
    if (!provenance_add_in(e->prov, "truth", e->truth_folder, "irradiance.txt", "", NULL, err) &&
        !irradiance_list_read(&job.truth, path, err))
        write_points(e, &job.truth, err);
    if (!err->status && !path_is_file(found)) {
        metric_note(&e->table, err, "skipped irradiance: relight/irradiance.txt is missing");
    } else if (!err->status) {
        const size_t capacity = (size_t)job.truth.count + 1;
        bool *marks = calloc(3 * capacity, sizeof *marks);
        job.partner = calloc(capacity, sizeof *job.partner);
        job.all = marks;
        if (marks && job.partner) {
            job.on = marks + capacity;
            job.off = marks + 2 * capacity;
        } else {
            err_nomem(err, "irradiance points", capacity * sizeof *job.partner);
        }
        if (!err->status && !provenance_add_file(e->prov, product_name(PRODUCT_IRRADIANCE, found), found, err))
            irradiance_list_read(&job.found, found, err);
        if (!err->status) {
            bring_to_truth(&job.found, &e->truth_from_scene);
            irradiance_partners(job.partner, &job.truth, &job.found);
            compare(e, &job, err);
        }
    }
    free(job.all);
    free(job.partner);
    irradiance_list_release(&job.found);
    irradiance_list_release(&job.truth);
    return err->status;
}

enum status evaluate_irradiance(struct evaluation *e, struct err *err)
{
    return evaluate_points(e, err) || evaluate_irradiance_pictures(e, err) ? err->status : ST_OK;
}
