/* importer_residuals.c - reprojection errors of a model in the photos, and what they say about it. */
#include <math.h>
#include <stdlib.h>

#include "common/base/log.h"
#include "common/base/sort.h"
#include "stages/sfm_import/importer.h"

/* Below this focal length for 35 mm film, in mm, a lens is likely to be a fisheye. */
static const double FISHEYE_FOCAL35 = 14;
/* Residuals that are measured and even up to this radius outweigh the focal length in EXIF. */
static const double PROVEN_RADIUS = 0.8;

/* INFINITY in error: the point is behind the camera or outside its lens; nothing else is set then. */
static struct lens_residual reproject(const struct input_image *im, const struct sfm_observation *o, struct vec3 world)
{
    const struct vec3 p = vec3_add(mat3_apply(im->cam_from_world, world), im->translation);
    const double seen_u = o->u * im->scale_u, seen_v = o->v * im->scale_v;
    const double x = seen_u - im->lens.width / 2.0, y = seen_v - im->lens.height / 2.0, distance = hypot(x, y);
    double u, v;
    if (!camera_project(&im->lens, p, &u, &v)) return (struct lens_residual){.error = INFINITY};
    return (struct lens_residual){
        .radius = distance / (hypot(im->lens.width, im->lens.height) / 2),
        .error = hypot(u - seen_u, v - seen_v),
        .radial = distance > 0 ? ((seen_u - u) * x + (seen_v - v) * y) / distance : 0,
    };
}

/* Mean and median of the errors. */
static enum status summarize(struct import_stats *stats, const struct lens_residual *residuals, size_t count,
                             double sum, struct err *err)
{
    double *sorted = malloc((count + 1) * sizeof *sorted);
    if (!sorted) return err_nomem(err, "reprojection errors", count * sizeof *sorted);
    for (size_t i = 0; i < count; i++) sorted[i] = residuals[i].error;
    if (count) {
        sort_doubles(sorted, count);
        stats->mean_error = sum / (double)count;
        stats->median_error = (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
    }
    free(sorted);
    return ST_OK;
}

enum status importer_measure_errors(struct importer *imp, struct import_stats *stats, struct residual_table *table,
                                    struct err *err)
{
    const struct sfm_model *m = imp->in;
    size_t total = 0, finite = 0, at = 0;
    double sum = 0, model_sum = 0, stated = 0, stated_weight = 0;
    for (int i = 0; i < m->point_count; i++) total += (size_t)m->points[i].track_count;
    imp->errors = malloc((total + 1) * sizeof *imp->errors);
    struct lens_residual *residuals = malloc((total + 1) * sizeof *residuals);
    int *photo = malloc((total + 1) * sizeof *photo);
    if (!imp->errors || !residuals || !photo) {
        free(residuals);
        free(photo);
        return err_nomem(err, "reprojection errors", total * sizeof *residuals);
    }
    for (int i = 0; i < m->point_count; i++) {
        const struct sfm_point *p = &m->points[i];
        for (int k = 0; k < p->track_count; k++, at++) {
            const struct input_image *im = &imp->images[p->track[k].image_idx];
            const struct sfm_observation *o =
                &m->images[p->track[k].image_idx].observations[p->track[k].observation_idx];
            imp->errors[at] = -1;
            if (im->photo < 0) continue;
            const struct lens_residual r = reproject(im, o, p->position);
            imp->errors[at] = r.error;
            stats->observations++;
            if (r.error > imp->params->max_error) stats->dropped++;
            if (r.error < INFINITY) {
                photo[finite] = im->photo;
                residuals[finite++] = r;
                sum += r.error;
                model_sum += r.error / sqrt(im->scale_u * im->scale_v);
            }
        }
        if (p->error >= 0 && p->track_count) {
            stated += p->error * p->track_count;
            stated_weight += p->track_count;
        }
    }
    stats->stated_error = stated_weight > 0 ? stated / stated_weight : -1;
    if (model_sum > 0 && stated_weight > 0) stats->stated_error *= sum / model_sum; /* to pixels of the photos */
    if (!summarize(stats, residuals, finite, sum, err) && !lens_fit_measure(&stats->lens, residuals, finite, err))
        residual_table_make(table, residuals, photo, finite, imp->photos->count, err);
    free(residuals);
    free(photo);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------- the lens model */

/* Models to try in place of one that does not fit. */
static const char *fisheye_models(enum camera_model model)
{
    return camera_model_is_fisheye(model) ? "EQUISOLID" : "EQUISOLID or OPENCV_FISHEYE";
}

static const char *other_models(enum camera_model model)
{
    if (model == CAMERA_RADIAL) return "OPENCV";
    return model == CAMERA_OPENCV ? "FULL_OPENCV" : "OPENCV or RADIAL";
}

/* The first photo whose EXIF suggests a fisheye but whose lens model is not one; NULL: none. */
static const struct input_image *unmodelled_fisheye(const struct importer *imp)
{
    for (int i = 0; i < imp->in->image_count; i++) {
        const struct input_image *im = &imp->images[i];
        if (im->photo < 0 || camera_model_is_fisheye(im->lens.model)) continue;
        const double focal = imp->photos->photos[im->photo].info.focal35_mm;
        if (focal > 0 && focal < FISHEYE_FOCAL35) return im;
    }
    return NULL;
}

static void warn_about_lens(const struct importer *imp, const struct lens_fit *fit)
{
    const struct input_image *first = NULL;
    double diagonal = 0;
    for (int i = imp->in->image_count - 1; i >= 0; i--)
        if (imp->images[i].photo >= 0) {
            first = &imp->images[i];
            diagonal = fmax(diagonal, hypot(first->lens.width, first->lens.height));
        }
    const bool grows = lens_fit_grows(fit, diagonal);
    const char *model = camera_model_name(first->lens.model);
    if (grows || lens_fit_is_biased(fit, diagonal)) {
        char found[160];
        if (grows)
            snprintf(found, sizeof found, "grow from %.1f px in the middle to %.1f px at the rim", fit->middle,
                     fit->rim);
        else
            snprintf(found, sizeof found, "point %s by %.1f px (median) at %.2f of the distance from centre to corner",
                     fit->bias > 0 ? "outwards" : "inwards", fabs(fit->bias), fit->bias_radius);
        log_warn(
            "the lens model %s does not fit: the residuals %s. Set [sfm] camera_model = %s for a fisheye lens, %s for "
            "other lenses",
            model, found, fisheye_models(first->lens.model), other_models(first->lens.model));
        return;
    }
    const struct input_image *im = unmodelled_fisheye(imp);
    if (!im || (fit->measured && fit->rim_radius >= PROVEN_RADIUS)) return;
    const struct photo_record *photo = &imp->photos->photos[im->photo];
    log_warn("the lens model %s may not fit: EXIF of photo \"%s\" states a focal length of %.3g mm for 35 mm film, as "
             "fisheye lenses have. If it is one, set [sfm] camera_model = %s",
             camera_model_name(im->lens.model), photo->file, photo->info.focal35_mm, fisheye_models(im->lens.model));
}

enum status importer_judge_errors(const struct importer *imp, const struct import_stats *stats, struct err *err)
{
    if (!stats->observations) {
        if (imp->photos->count > 1) /* of one photo the depth is given */
            log_warn("%s; depth estimation will have no starting points",
                     imp->in->point_count ? "these photos observe none of the model's points"
                                          : "the model has no points");
        warn_about_lens(imp, &stats->lens);
        return ST_OK;
    }
    if (stats->dropped == stats->observations)
        return err_set(
            err, ST_DATA,
            "none of the model's %lld observations is within %g px of its reprojected point: cameras and points "
            "do not belong together, or their conventions differ from COLMAP's.",
            stats->observations, imp->params->max_error);
    log_note("reprojection error, recomputed: mean %.3f px, median %.3f px over %lld observations", stats->mean_error,
             stats->median_error, stats->observations);
    if (stats->dropped)
        log_note("%lld observations are dropped: behind their camera, outside its lens or with an error above %g px",
                 stats->dropped, imp->params->max_error);
    if (stats->stated_error > 0 &&
        (stats->mean_error > 2 * stats->stated_error || 2 * stats->mean_error < stats->stated_error))
        log_warn(
            "the model states a mean reprojection error of %.3f px, but it is %.3f px; was the model made by another "
            "program, or edited?",
            stats->stated_error, stats->mean_error);
    if (2 * stats->dropped > stats->observations)
        log_warn("more than half of the observations are dropped: the model fits these photos poorly");
    warn_about_lens(imp, &stats->lens);
    return ST_OK;
}
