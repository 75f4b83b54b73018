/* refine_cameras.c - which form of lens a model needs, and the adjustment with it.
 *
 * The forms are the lens models of COLMAP's perspective family, from none to two radial and two tangential
 * coefficients, each with three kinds of principal point (bundle.h). All are fitted to the same observations, from the
 * same start, and the one with the smallest BIC is chosen: a parameter must explain more than its price, log N / 2. So
 * photos of one lens keep one lens, and photos of a stabilised phone get a principal point each. Lenses of other models
 * (fisheyes, rational distortion) keep their model; whether its distortion is adjusted, and their principal point, are
 * chosen.
 *
 * A fall of the residual proves nothing where there is hardly a number more than unknowns, as with few points of two
 * views each: then cameras move to fit errors. So points are held out [Stone 1974]: they are divided into FOLDS parts,
 * the cameras are adjusted without one of them, and its points are placed again with these cameras. Their costs are
 * compared point by point. A principal point for each photo must be better than the best form with one for a lens, by
 * STRONG standard errors of the mean difference. Given poses are kept unless the adjusted ones are better than they
 * were by CONFIDENT standard errors. Poses that were found from the same points need no such proof, nor could it be
 * had: all points had their part in them.
 *
 * Photos of a multi-lens camera may contradict that its lenses keep their poses in its body: it zoomed, or a contact
 * sheet was cut unevenly. So the part is adjusted with the best form both ways, and the rig (rig.c) is dropped if the
 * noise of the residuals is more than MAX_RIG_NOISE times as large with it.
 *
 * The forms are compared on CHOICE_OBSERVATIONS, or CHOICE_OF_IMAGE per photo if that is more, evenly from all photos;
 * then everything is adjusted with the chosen form, twice, since the scale of the residuals falls with the first
 * adjustment. A form that fails or leaves its priors (bundle.c) is refused, and the next best one is taken. */
#include "stages/sfm_import/refine_cameras.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/capture/photo_match.h"
#include "common/math/numbers.h"
#include "common/product/product.h"

#define CHOICE_TOLERANCE 1e-5 /* of the fits that are compared */
#define CONFIDENT        2.0  /* standard errors */
#define STRONG           3.0
#define MAX_RIG_NOISE    1.1 /* times the noise without a rig, above which the images contradict it */
enum { FOLDS = 5 };
enum { CHOICE_OBSERVATIONS = 12000, CHOICE_OF_IMAGE = 300, COVARIANCE_OBSERVATIONS = 40000, MIN_OBSERVATIONS = 30 };

const char *refine_form_model(const struct lens_form *form)
{
    if (form->lens_kept) return "kept";
    if (form->model_kept) return form->focal_only ? "same_model_focal_only" : "same_model";
    return camera_model_name(form->model);
}

const char *refine_form_center(const struct lens_form *form)
{
    if (form->lens_kept || form->center == CENTER_KEPT) return "kept";
    return form->center == CENTER_SHARED ? "shared" : "per_photo";
}

static const enum camera_model models[] = {CAMERA_SIMPLE_PINHOLE, CAMERA_SIMPLE_RADIAL, CAMERA_RADIAL, CAMERA_OPENCV};
enum { MODELS = sizeof models / sizeof *models };

/* Whether the lenses are as one of `models` would have them. */
static bool is_listed(const struct bundle *b)
{
    bool known = false;
    for (int i = 0; i < MODELS; i++) known = known || b->lenses[0].camera.model == models[i];
    for (int i = 1; i < b->lens_count; i++) known = known && b->lenses[i].camera.model == b->lenses[0].camera.model;
    return known;
}

static void list_forms(struct refinement *r, const struct bundle *b, bool lens_kept, bool shifts)
{
    r->form_count = 0;
    if (lens_kept) {
        r->forms[r->form_count++].form = (struct lens_form){.lens_kept = true};
        return;
    }
    for (int center = CENTER_KEPT; center <= (shifts ? CENTER_PER_PHOTO : CENTER_SHARED); center++) {
        for (int i = 0; i < MODELS && bundle_can_convert(b); i++)
            r->forms[r->form_count++].form =
                (struct lens_form){.model = models[i], .center = (enum principal_point)center};
        for (int k = 0; k < 2 && !is_listed(b); k++)
            r->forms[r->form_count++].form =
                (struct lens_form){.model_kept = true, .focal_only = k == 0, .center = (enum principal_point)center};
    }
}

/* ------------------------------------------------------------------------------------------------------- the choice */

struct choice {
    struct refinement *r;
    const struct bundle *start;      /* a part of the observations */
    struct bundle fitted[MAX_FORMS]; /* the start, adjusted with each form */
    struct err errs[MAX_FORMS];
    double shift_sigma; /* px */
    struct progress progress;
};

static void fit_forms(void *ctx, size_t begin, size_t end, int thread)
{
    struct choice *c = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct form_result *f = &c->r->forms[i];
        f->usable = !bundle_copy(&c->fitted[i], c->start, &c->errs[i]) &&
                    !bundle_adjust(&f->fit, &c->fitted[i], &f->form, c->shift_sigma, &c->errs[i]);
    }
    progress_add(&c->progress, (int64_t)(end - begin));
}

static int best_form(const struct refinement *r)
{
    int best = -1;
    for (int i = 0; i < r->form_count; i++)
        if (r->forms[i].usable && (best < 0 || r->forms[i].fit.bic < r->forms[best].fit.bic)) best = i;
    return best;
}

/* -------------------------------------------------------------------------------------------------- held-out points */

struct fold_job {
    const struct bundle *start;
    const struct lens_form *form; /* NULL: the cameras as they are */
    double shift_sigma, *cost;
    struct err errs[FOLDS];
};

/* Places the points of the fold again, with cameras that were adjusted without them, and notes their costs. */
static void hold_out_folds(void *ctx, size_t begin, size_t end, int thread)
{
    struct fold_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct bundle b = {0}, held = {0};
        struct bundle_fit fit;
        struct err *err = &job->errs[i];
        if (!bundle_copy(&b, job->start, err) && job->form) {
            bundle_keep_fold(&b, (int)i, FOLDS, true);
            bundle_adjust(&fit, &b, job->form, job->shift_sigma, err);
        }
        if (!err->status && !bundle_copy(&held, job->start, err)) {
            bundle_take_cameras(&held, &b);
            held.noise = job->start->noise;
            bundle_keep_fold(&held, (int)i, FOLDS, false);
            if (!bundle_adjust_points(&held, err)) bundle_add_costs(job->cost, &held);
        }
        bundle_release(&held);
        bundle_release(&b);
    }
}

/* *cost: of each point of `start`; the caller frees it. ST_DATA: the adjustment failed without a part of the points. */
static enum status hold_out(double **cost, const struct bundle *start, const struct lens_form *form, double shift_sigma,
                            struct err *err)
{
    struct fold_job job = {.start = start, .form = form, .shift_sigma = shift_sigma};
    *cost = job.cost = calloc((size_t)start->point_count + 1, sizeof *job.cost);
    if (!job.cost) return err_nomem(err, "costs of points", (size_t)start->point_count * sizeof *job.cost);
    parallel_for(FOLDS, 1, hold_out_folds, &job);
    for (int i = 0; i < FOLDS && !err->status; i++)
        if (job.errs[i].status) err_set(err, job.errs[i].status, "%s", job.errs[i].text);
    if (err->status) {
        free(*cost);
        *cost = NULL;
    }
    return err->status;
}

static struct held_out_gain gain_of(const double *before, const double *after, int count)
{
    struct held_out_gain g = {0, 0};
    double square = 0;
    for (int i = 0; i < count; i++) g.mean += (before[i] - after[i]) / count;
    for (int i = 0; i < count; i++) square += (before[i] - after[i] - g.mean) * (before[i] - after[i] - g.mean);
    if (count > 1) g.error = sqrt(square / (count - 1) / count);
    return g;
}

/* ------------------------------------------------------------------------------------------------------- everything */

/* Takes lenses, poses, shifts and points of `part`; other points stay where they were. place: point_count numbers of
 * scratch. */
static void take_solution(struct bundle *all, const int *point_of, const struct bundle *part, const int *of_part,
                          int *place, int point_count)
{
    bundle_take_cameras(all, part);
    for (int i = 0; i < point_count; i++) place[i] = -1;
    for (int i = 0; i < part->point_count; i++) place[of_part[i]] = i;
    for (int i = 0; i < all->point_count; i++)
        for (int k = 0; k < 3 && place[point_of[i]] >= 0; k++) all->points[i][k] = part->points[place[point_of[i]]][k];
    bundle_prune(all);
}

/* Adjusts everything with a form. ST_DATA: the form is refused. */
static enum status adjust_all(struct refinement *r, struct bundle *all, int form, double noise, double shift_sigma,
                              struct err *err)
{
    all->noise = noise;
    for (int round = 0; !err->status && round < 2; round++) {
        bundle_adjust(&r->after, all, &r->forms[form].form, shift_sigma, err);
        all->noise = r->after.noise;
    }
    const double limit = r->before.noise * (r->rig.lenses ? MAX_RIG_NOISE : 1);
    if (!err->status && !(r->after.noise < limit)) err_set(err, ST_DATA, "it does not lower the reprojection error");
    return err->status;
}

/* Notes the shifts and their deviations. Thins the bundle: with fewer observations the deviations are larger, so they
 * are on the safe side. */
static enum status note_shifts(struct refinement *r, struct bundle *b, struct err *err)
{
    double *sigma = calloc(2 * (size_t)b->image_count + 1, sizeof *sigma);
    struct err none = ERR_INIT;
    r->shifts = calloc((size_t)b->image_count + 1, sizeof *r->shifts);
    if (!sigma || !r->shifts) {
        free(sigma);
        return err_nomem(err, "principal points", (size_t)b->image_count * sizeof *r->shifts);
    }
    bundle_thin(b, COVARIANCE_OBSERVATIONS); /* memory and time of a covariance grow fast */
    const bool known = !ceres_bundle_shift_sigma(sigma, b, &none);
    r->shift_count = b->image_count;
    for (int i = 0; i < b->image_count; i++) {
        const double *shift = b->images[i].shift, *s = sigma + 2 * i;
        r->shifts[i] = (struct principal_shift){shift[0], shift[1], known ? s[0] : INFINITY, known ? s[1] : INFINITY};
    }
    free(sigma);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- refinement */

struct refine_job {
    struct refinement *r;
    struct sfm_model *m;
    enum bundle_poses poses;
    struct bundle all, part;
    int *point_of, *of_part; /* points of the model */
    int *place;
    struct rig rig;     /* lens_count 0: none */
    double shift_sigma; /* px */
    double *held_out;   /* costs of the part's points with the cameras as they were */
};

/* The costs of held-out points with a form, computed once. ST_DATA: the form fails without a part of the points. */
static enum status cost_of_form(struct refine_job *job, int form, struct err *err)
{
    struct form_result *f = &job->r->forms[form];
    if (f->held_out) return ST_OK;
    return hold_out(&f->held_out, &job->part, &f->form, job->shift_sigma, err);
}

/* Whether a form with a principal point for each photo is better on held-out points than the best one without. If not,
 * all forms with such are refused. */
static bool shifts_are_proved(struct refine_job *job, int form, struct err *err)
{
    struct refinement *r = job->r;
    struct err why = ERR_INIT;
    int rival = -1;
    for (int i = 0; i < r->form_count; i++)
        if (r->forms[i].usable && r->forms[i].form.center != CENTER_PER_PHOTO &&
            (rival < 0 || r->forms[i].fit.bic < r->forms[rival].fit.bic))
            rival = i;
    if (rival < 0) return true;
    if (cost_of_form(job, rival, &why)) r->forms[rival].usable = why.status == ST_NOMEM;
    if (why.status == ST_NOMEM) err_set(err, ST_NOMEM, "%s", why.text);
    if (why.status) return !err->status && shifts_are_proved(job, form, err);
    const struct held_out_gain g = gain_of(r->forms[rival].held_out, r->forms[form].held_out, job->part.point_count);
    if (g.mean > STRONG * g.error) return true;
    log_note("a principal point for each photo is not proved: the cost of held-out points falls by %.3f +- %.3f",
             g.mean, g.error);
    for (int i = 0; i < r->form_count; i++)
        if (r->forms[i].form.center == CENTER_PER_PHOTO) r->forms[i].usable = false;
    return false;
}

/* Whether held-out points fit better with a form where that must be proved: with shifts, and of given poses. */
static bool form_is_proved(struct refine_job *job, int form, struct err *err)
{
    struct refinement *r = job->r;
    struct err why = ERR_INIT;
    const bool shifts = r->forms[form].form.center == CENTER_PER_PHOTO && !r->forms[form].form.lens_kept;
    if (!shifts && job->poses != POSES_GIVEN) return true;
    if (cost_of_form(job, form, &why)) {
        if (why.status == ST_NOMEM) err_set(err, ST_NOMEM, "%s", why.text);
        return false;
    }
    if (shifts && !shifts_are_proved(job, form, err)) return false;
    if (job->poses != POSES_GIVEN) return !err->status;
    if (!job->held_out && hold_out(&job->held_out, &job->part, NULL, 0, err)) return false;
    r->gain = gain_of(job->held_out, r->forms[form].held_out, job->part.point_count);
    return r->gain.mean > CONFIDENT * r->gain.error;
}

/* Makes the images of a bundle part of the rig and ties them, as far as this noise, px, lets a lens move. */
static enum status tie_images(double *angle, struct bundle *b, const struct rig *rig, double noise, struct err *err)
{
    return rig_apply(angle, b, rig, err) || bundle_trust_rig(b, noise, err) ? err->status : ST_OK;
}

/* From here on images are adjusted on their own. Costs of points that were held out with the rig are forgotten. */
static void drop_rig(struct refine_job *job)
{
    job->rig.lens_count = 0;
    job->part.mount_sigma = job->all.mount_sigma = 0;
    job->r->rig = (struct rig_result){0};
    for (int i = 0; i < job->r->form_count; i++) {
        free(job->r->forms[i].held_out);
        job->r->forms[i].held_out = NULL;
    }
}

static void warn_about_rig(const struct rig *rig, const struct bundle_fit *alone, const struct bundle_fit *tied,
                           const struct err *why)
{
    char found[sizeof why->text + 64];
    if (why->status)
        snprintf(found, sizeof found, "one rig cannot be fitted: %s", why->text);
    else
        snprintf(found, sizeof found, "the noise of the residuals is %.3f px with one rig, %.3f px without",
                 tied->noise, alone->noise);
    log_warn("the %d lenses of the multi-lens camera are not at the same places in its %d photos: %s. Each picture is "
             "adjusted on its own. If the camera is rigid and was not zoomed, check SPLIT and [import_photos] "
             "split_border, split_gap and split_dark",
             rig->lens_count, rig->capture_count, found);
}

/* Adjusts `fitted`, the part as a form fits it, further, with the rig and without. If the noise permits the rig, the
 * images of everything and of the part are tied, and `fitted` becomes the one with the rig; else the rig is dropped. */
static enum status weigh_rig(struct refine_job *job, struct bundle *fitted, const struct form_result *f,
                             struct err *err)
{
    struct rig_result *r = &job->r->rig;
    struct bundle with = {0}, without = {0};
    struct bundle_fit tied = {0}, alone = {0};
    struct err why = ERR_INIT, why_alone = ERR_INIT;
    double angle;
    if (!bundle_copy(&without, fitted, err) && !bundle_copy(&with, fitted, err) &&
        !tie_images(&r->angle, &with, &job->rig, f->fit.noise, err)) {
        with.noise = without.noise = f->fit.noise;
        if (bundle_adjust(&alone, &without, &f->form, job->shift_sigma, &why_alone)) alone = f->fit;
        bundle_adjust(&tied, &with, &f->form, job->shift_sigma, &why);
        if (why_alone.status == ST_NOMEM) why = why_alone;
        if (why.status == ST_NOMEM) err_set(err, ST_NOMEM, "%s", why.text);
    }
    if (!err->status && (why.status || tied.noise > MAX_RIG_NOISE * alone.noise)) {
        warn_about_rig(&job->rig, &alone, &tied, &why);
        drop_rig(job);
    } else if (!err->status && !tie_images(&angle, &job->part, &job->rig, f->fit.noise, err) &&
               !tie_images(&angle, &job->all, &job->rig, f->fit.noise, err)) {
        r->lenses = job->rig.lens_count;
        r->captures = job->rig.capture_count;
        bundle_release(fitted);
        *fitted = with;
        with = (struct bundle){0};
    }
    bundle_release(&with);
    bundle_release(&without);
    return err->status;
}

static enum status try_forms(struct refine_job *job, struct choice *c, struct err *err)
{
    struct refinement *r = job->r;
    for (int i = 0; !err->status && i < r->form_count; i++)
        if (c->errs[i].status == ST_NOMEM) err_set(err, ST_NOMEM, "%s", c->errs[i].text);
    for (int at; !err->status && r->chosen < 0 && (at = best_form(r)) >= 0;) {
        struct bundle b = {0};
        struct err why = ERR_INIT;
        if (job->rig.lens_count && weigh_rig(job, &c->fitted[at], &r->forms[at], err)) break;
        r->forms[at].usable = form_is_proved(job, at, err);
        if (!r->forms[at].usable) continue;
        if (bundle_copy(&b, &job->all, err)) break;
        take_solution(&b, job->point_of, &c->fitted[at], job->of_part, job->place, job->m->point_count);
        const enum status adjusted = adjust_all(r, &b, at, r->forms[at].fit.noise, job->shift_sigma, &why);
        if (adjusted == ST_NOMEM) err_set(err, ST_NOMEM, "%s", why.text);
        r->forms[at].usable = !adjusted;
        if (!adjusted) {
            r->chosen = at;
            if (!bundle_store(job->m, &b, job->point_of, err) && b.shift_sigma > 0) note_shifts(r, &b, err);
        }
        bundle_release(&b);
    }
    if (r->chosen < 0) r->rig = (struct rig_result){0};
    return err->status;
}

static enum status run_job(struct refine_job *job, bool lens_kept, struct err *err)
{
    struct refinement *r = job->r;
    struct choice *c = calloc(1, sizeof *c);
    job->place = malloc(((size_t)job->m->point_count + 1) * sizeof *job->place);
    if (!c || !job->place) err_nomem(err, "forms of lenses", sizeof *c);
    if (!err->status) bundle_measure(&r->before, &job->all, err);
    if (!err->status && job->poses == POSES_GIVEN) bundle_trust_poses(&job->all, r->before.noise, err);
    const int of_images = CHOICE_OF_IMAGE * job->m->image_count;
    const int wanted = of_images > CHOICE_OBSERVATIONS ? of_images : CHOICE_OBSERVATIONS;
    if (!err->status && !bundle_make(&job->part, &job->of_part, job->m, job->poses, (size_t)wanted, err)) {
        job->part.noise = r->before.noise;
        job->part.center_sigma = job->all.center_sigma;
        job->part.turn_sigma = job->all.turn_sigma;
        job->part.tolerance = CHOICE_TOLERANCE;
        list_forms(r, &job->all, lens_kept, job->shift_sigma > 0);
        c->r = r;
        c->start = &job->part;
        c->shift_sigma = job->shift_sigma;
        progress_start(&c->progress, "lens forms", r->form_count, "forms");
        parallel_for((size_t)r->form_count, 1, fit_forms, c);
        progress_end(&c->progress);
        try_forms(job, c, err);
    }
    for (int i = 0; c && i < MAX_FORMS; i++) bundle_release(&c->fitted[i]);
    free(c);
    return err->status;
}

/* One line about what was chosen, and one about the next best form. */
static void log_choice(const struct refinement *r)
{
    if (r->chosen < 0) {
        if (r->gain.error > 0)
            log_note(
                "the cameras are kept: on held-out points the cost falls by %.3f +- %.3f, which does not prove that "
                "others are better",
                r->gain.mean, r->gain.error);
        else
            log_note("the cameras are kept: no form of lens fits the observations better");
        return;
    }
    const struct form_result *f = &r->forms[r->chosen], *next = NULL;
    char center[160] = "principal point kept", rival[160] = "";
    if (f->form.center == CENTER_SHARED)
        snprintf(center, sizeof center, "principal point adjusted, one for all photos");
    if (r->shifts) {
        double sum = 0, sigma = 0;
        for (int i = 0; i < r->shift_count; i++) {
            sum += r->shifts[i].u * r->shifts[i].u + r->shifts[i].v * r->shifts[i].v;
            sigma = fmax(sigma, fmax(r->shifts[i].sigma_u, r->shifts[i].sigma_v));
        }
        const int n = snprintf(center, sizeof center, "a principal point for each photo, shifted by %.1f px (RMS)",
                               sqrt(sum / r->shift_count));
        if (isfinite(sigma)) snprintf(center + n, sizeof center - (size_t)n, " +- %.1f px or less", sigma);
    }
    if (f->form.lens_kept) snprintf(center, sizeof center, "as it was given");
    for (int i = 0; i < r->form_count; i++)
        if (i != r->chosen && r->forms[i].usable && (!next || r->forms[i].fit.bic < next->fit.bic)) next = &r->forms[i];
    if (next)
        snprintf(rival, sizeof rival, "; the next form, %s %s, has a BIC higher by %.0f",
                 refine_form_model(&next->form), refine_form_center(&next->form), next->fit.bic - f->fit.bic);
    log_note("cameras refined: lens %s, %s; median reprojection error %.3f -> %.3f px%s", refine_form_model(&f->form),
             center, r->before.median, r->after.median, rival);
    if (r->rig.lenses)
        log_note("the %d lenses of the multi-lens camera have the same poses relative to each other in its %d photos; "
                 "before, these differed by %.3f degrees (median)",
                 r->rig.lenses, r->rig.captures, r->rig.angle / DEGREE);
    if (r->gain.error > 0)
        log_note("the cost of held-out points is lower than with the given poses by %.3f +- %.3f", r->gain.mean,
                 r->gain.error);
}

enum status refine_cameras(struct refinement *out, struct sfm_model *m, enum given_cameras given,
                           struct split_size split, const struct sfm_import_params *params, struct err *err)
{
    struct refine_job job = {.r = out, .m = m, .poses = given == GIVEN_MODEL ? POSES_GIVEN : POSES_FOUND};
    const bool asked = !strcmp(params->refine, "yes");
    double side = 0;
    *out = (struct refinement){.chosen = -1};
    if (!strcmp(params->refine, "no")) return ST_OK;
    if (given == GIVEN_MODEL && !asked) {
        log_note("the cameras are kept as they were given; [sfm_import] refine = yes refines them");
        return ST_OK;
    }
    for (int i = 0; i < m->camera_count; i++)
        side = fmax(side, fmax(m->cameras[i].camera.width, m->cameras[i].camera.height));
    job.shift_sigma = params->principal_shift * side;
    if (!bundle_make(&job.all, &job.point_of, m, job.poses, 0, err) && split.columns)
        rig_find(&job.rig, m, &job.all, split, err);
    if (!err->status && job.all.observation_count >= MIN_OBSERVATIONS) {
        if (!run_job(&job, given == GIVEN_LENS && !asked, err)) log_choice(out);
    } else if (!err->status) {
        log_note("the cameras are kept: they have only %zu observations of points", job.all.observation_count);
    }
    bundle_release(&job.all);
    bundle_release(&job.part);
    rig_release(&job.rig);
    free(job.point_of);
    free(job.of_part);
    free(job.place);
    free(job.held_out);
    return err->status;
}

void refine_cameras_release(struct refinement *r)
{
    if (!r) return;
    free(r->shifts);
    for (int i = 0; i < r->form_count; i++) free(r->forms[i].held_out);
    *r = (struct refinement){.chosen = -1};
}

static void print_forms(FILE *to, const struct refinement *r)
{
    double best = INFINITY;
    for (int i = 0; i < r->form_count; i++)
        if (r->forms[i].usable) best = fmin(best, r->forms[i].fit.bic);
    fputs("# form LENS PRINCIPAL_POINT parameters median_px noise_px BIC-lowest verdict\n", to);
    for (int i = 0; i < r->form_count; i++) {
        const struct form_result *form = &r->forms[i];
        fprintf(to, "form %s %s ", refine_form_model(&form->form), refine_form_center(&form->form));
        if (form->usable)
            fprintf(to, "%d %.9g %.9g %.9g %s\n", form->fit.parameters, form->fit.median, form->fit.noise,
                    form->fit.bic - best, i == r->chosen ? "chosen" : "-");
        else
            fputs("- - - - refused\n", to);
    }
}

static void print_shifts(FILE *to, const struct refinement *r, const struct sfm_model *m,
                         const struct photo_list *photos)
{
    fputs("# shift PHOTO u v sigma_u sigma_v px\n", to);
    for (int i = 0; i < r->shift_count; i++) {
        const int photo = photo_list_match(photos, m->images[i].name);
        const struct principal_shift *s = &r->shifts[i];
        if (photo < 0) continue;
        fprintf(to, "shift %s %.9g %.9g ", photos->photos[photo].id, s->u, s->v);
        if (isfinite(s->sigma_u) && isfinite(s->sigma_v))
            fprintf(to, "%.9g %.9g\n", s->sigma_u, s->sigma_v);
        else
            fputs("- -\n", to);
    }
}

enum status refine_cameras_write(const struct refinement *r, const struct sfm_model *m, const struct photo_list *photos,
                                 const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_LENS_FORMS, path, prov, err);
    if (!err->status) {
        print_forms(f.fp, r);
        if (r->shifts) print_shifts(f.fp, r, m, photos);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}
