/* hdr_merge.c - merges the bracketed exposures of one view into linear radiance.
 *
 * reads   RECORDS/ID.txt    the photos of the view, with their exposures
 *         PHOTOS/FILE       the photos: JPEG, PNG, TIFF, EXR, raw files
 *         MODEL/cameras.txt, images.txt   the view's lens and pose, if the model has them
 *         VIEWS/cameras.txt, images.txt, lenses.txt, RECORDS-OF-THE-SCENE/ID.txt, or AXES   the frame of that pose
 *         MARKS, PLAN, AXES   corners of the room's model that are marked in the view, from which its pose is found
 *         OUTDOORS/cameras.txt, images.txt, VIEW.exr   views that show what an image in an opening shows
 *         RESPONSE          the response curve; without it the sRGB curve
 * writes  OUT/ID.jpg        the picture for structure from motion: by default the tone-mapped radiance
 *         OUT/ID.exr        R G B (half): 1 is white at the exposure remodel:white, the same for all views of a scene;
 *                           clipped (uint): 1 a colour saturates in every exposure, 2 a colour is dark in every
 *                           exposure that does not saturate, 3 both;
 *                           variance (float): of the luminance, divided by its square; 1 if unknown;
 *                           with MODEL or MARKS: worldToCamera and remodel:lens
 *
 * Each file appears complete or not at all, ID.exr last. */
#include <math.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "stages/hdr_merge/bracketed_view.h"

static void warn_of_disagreement(const struct bracketed_view *v)
{
    const struct exposure_agreement *a = &v->agreement;
    const struct photo_record *r = &v->record;
    if (a->pair && !v->agree)
        log_warn("view %s: %s should have %.3g times the light of %s, but shows %.3g times as much; its radiance is "
                 "not exact. "
                 "Correct the exposures (exposures.txt) or the response curve (response.txt, docs/formats.md).",
                 r->id, r->brackets[a->pair].file, a->stated, r->brackets[a->pair - 1].file, a->measured);
}

static void report_shifts(const struct bracketed_view *v, const struct merge_params *params)
{
    const struct photo_record *r = &v->record;
    for (int i = 0; i < r->bracket_count; i++) {
        const struct shift *s = &v->alignment.shifts[i];
        if (s->dx || s->dy)
            log_note("%s: %s is shifted by %d, %d px against %s%s", r->id, r->brackets[i].file, s->dx, s->dy,
                     r->brackets[r->middle].file, v->brackets.shifts ? "; corrected" : "");
        if (v->alignment.at_limit[i])
            log_warn("view %s: %s is shifted by at least [hdr_merge] max_shift = %d px; check it, and exclude it "
                     "(EXCLUDE) if it is of another view.",
                     r->id, r->brackets[i].file, params->max_shift);
    }
}

static void report_frame(const struct bracketed_view *v)
{
    const struct frame_agreement *f = &v->frame;
    if (f->photos)
        log_note("%s: placed in the scene by %d photographs; their places agree to %.2g %% of their extent (median; at "
                 "most %.2g %%), their axes to %.2g degrees (at most %.2g)",
                 v->record.id, f->photos, 100 * f->errors.center_median, 100 * f->errors.center_max,
                 f->errors.rotation_median, f->errors.rotation_max);
}

static void warn_of_other_pose(const char *id, const struct marked_pose *m)
{
    const struct resection_pose *other = &m->found.poses[1];
    const struct vec3 there = pose_center(&other->cam_from_world);
    log_warn("view %s: another pose fits its marks nearly as well (%.2g px, this one %.2g px), with the camera at "
             "%.3f %.3f %.3f; mark a point far off the plane of the others, or add a line \"near %s X Y Z\".",
             id, other->rms, m->found.poses[0].rms, there.x, there.y, there.z, id);
}

static void report_turn(const struct bracketed_view *v)
{
    const struct outdoors_turn *t = &v->turn;
    const struct outdoors_rotation *r = &t->found;
    const char *id = v->record.id, *opening = v->marked.opening;
    if (r->verdict == OUTDOORS_TURNED)
        log_note(
            "%s: turned by %.2f degrees by what photos show through %s: of %d matches %d agree, from %d photos, to "
            "%.2g degrees each; standard error of the rotation %.2g degrees",
            id, r->turned, opening, r->sights, r->agree, r->photos, r->spread, r->error);
    else if (!t->views)
        log_note("%s: no photo looks out of %s, so that nothing tells how the image is turned", id, opening);
    else if (r->verdict == OUTDOORS_FEW)
        log_warn("view %s: it is not turned by what photos show through %s: found %d matches in %d views, of which %d "
                 "agree, wanted %d. Mark corners or a horizon, or check the opening and the lens in lri.txt.",
                 id, opening, r->sights, t->views, r->agree, r->wanted);
    else
        log_warn("view %s: it is not turned by what photos show through %s: of %d matches %d agree, with a rotation of "
                 "%.2g degrees that is known to %.2g degrees only. State where in the opening the camera was (at U V), "
                 "mark corners or a horizon, or raise [hdr_merge] outdoors_error.",
                 id, opening, r->sights, r->agree, r->turned, r->error);
}

static void report_marks(const struct bracketed_view *v)
{
    const struct marked_pose *m = &v->marked;
    if (m->in_window)
        log_note("%s: placed in an opening of the wall %s, looking straight out, %s%s", v->record.id, m->wall,
                 m->level ? "level" : "level by its horizon",
                 v->turn.tried && v->turn.found.verdict == OUTDOORS_TURNED
                     ? ""
                     : "; what it shows is turned by as much as the camera was. Marked corners place it better.");
    if (v->turn.tried) report_turn(v);
    if (!m->marks) return;
    const char *id = v->record.id, *unit = m->metric ? "m" : "units";
    const struct resection_pose *p = &m->found.poses[m->chosen];
    const struct vec3 at = pose_center(&p->cam_from_world), e = p->error;
    log_note(
        "%s: placed by %d marks, which are %.2g px (%.2g degrees) off the model's points (root mean square; at most "
        "%.2g px, line %d)",
        id, m->marks, p->rms, p->degrees, p->max, m->worst_line);
    log_note(
        "%s: its camera is at %.3f %.3f %.3f %s in the model, 95 %% interval +- %.2g %.2g %.2g %s; its direction is "
        "known to %.2g degrees",
        id, at.x, at.y, at.z, unit, e.x, e.y, e.z, unit, p->turn_error);
    if (*m->wall)
        log_note("%s: that is %.2f %s %s the inner face of the wall %s; if it is on the wrong side, left and right are "
                 "exchanged",
                 id, fabs(m->before_wall), unit, m->before_wall < 0 ? "behind" : "in front of", m->wall);
    if (m->marks == RESECTION_MIN)
        log_warn("view %s: three marks always fit, so that nothing checks its pose; mark a fourth point.", id);
    else if (m->found.count > 1 && !m->by_hand)
        warn_of_other_pose(id, m);
}

static void report(const struct bracketed_view *v, const struct merge_params *params)
{
    size_t pixels = (size_t)v->merged.radiance.width * (size_t)v->merged.radiance.height, bright = 0, dark = 0;
    for (size_t i = 0; i < pixels; i++) {
        bright += (v->merged.marks[i] & PHOTO_BRIGHT) != 0;
        dark += (v->merged.marks[i] & PHOTO_DARK) != 0;
    }
    log_note("%s: %d exposure%s; %.2f %% of the pixels saturate in all of them, %.2f %% are dark in all of them",
             v->record.id, v->record.bracket_count, v->record.bracket_count == 1 ? "" : "s",
             100.0 * (double)bright / (double)pixels, 100.0 * (double)dark / (double)pixels);
    if (v->noise_measured)
        log_note("%s: noise is %.2f %% of white at white, %.3f %% in the dark", v->record.id,
                 100 * sqrt(v->noise[0].photon + v->noise[0].read2), 100 * sqrt(v->noise[0].read2));
    report_shifts(v, params);
    report_frame(v);
    report_marks(v);
    warn_of_disagreement(v);
}

struct request { /* the options of these names */
    const char *id, *photos, *records, *response, *model, *out;
    struct reference_frame frame;
};

static enum status check_request(const struct request *r, struct err *err)
{
    const struct reference_frame *f = &r->frame;
    if (f->outdoors && !f->marks)
        return err_set(err, ST_USAGE, "--outdoors wants --marks, --plan and --axes; give these, too.");
    if (!f->marks != !f->plan || (f->marks && (!f->axes || f->views)))
        return err_set(err, ST_USAGE, "--marks, --plan and --axes belong together, without --views; give all three.");
    if (!f->views == !f->records && !(f->views && f->axes) && (r->model || f->marks || (!f->views && !f->axes)))
        return ST_OK;
    return err_set(err, ST_USAGE,
                   "--views wants --scene-records, and either these two or --axes state the frame of --model; give "
                   "one of them.");
}

static void warn_without_pose(const struct request *r)
{
    if (r->frame.marks)
        log_warn("view %s: %s has no mark of it; its radiance is written without lens and pose.", r->id,
                 r->frame.marks);
    else
        log_warn("view %s: %s/images.txt has no image of it; its radiance is written without lens and pose.", r->id,
                 r->model);
}

static enum status hdr_merge(const struct request *r, const struct merge_params *params, struct provenance *prov,
                             struct err *err)
{
    struct bracketed_view v = {0};
    size_t clamped = 0;
    bool placed = false;
    const bool wanted = r->model || r->frame.marks;
    if (!check_request(r, err)) bracketed_view_read(&v, r->id, r->photos, r->records, r->response, prov, err);
    if (!err->status && wanted) bracketed_view_place(&v, &placed, r->model, &r->frame, params, prov, err);
    if (!err->status && wanted && !placed) warn_without_pose(r);
    if (!err->status && !bracketed_view_merge(&v, params, err) &&
        !bracketed_view_turn(&v, &r->frame, params, prov, err) &&
        !bracketed_view_write_picture(&v, r->photos, r->out, params, err))
        bracketed_view_write_radiance(&v, r->out, prov, &clamped, err);
    if (!err->status && clamped)
        log_warn("view %s: %zu samples exceed 65504 times white, the largest half value, and are clamped to it.", r->id,
                 clamped);
    if (!err->status) report(&v, params);
    bracketed_view_release(&v);
    return err->status;
}

int main(int argc, char **argv)
{
    struct request r = {0};
    struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Merges the bracketed exposures of one view into linear radiance."),
        CLI_STR("id", &r.id, CLI_REQUIRED, "id of the view to merge"),
        CLI_STR("photos", &r.photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &r.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("response", &r.response, CLI_OPTIONAL, "response.txt, the response curve; default: the sRGB curve"),
        CLI_STR("model", &r.model, CLI_OPTIONAL, "COLMAP text model with the view's camera, to be written to ID.exr"),
        CLI_STR("views", &r.frame.views, CLI_OPTIONAL,
                "folder of the scene's cameras.txt, images.txt and lenses.txt: the pose in the model is moved to the "
                "scene's frame by the photographs that both have; default: it is in that frame"),
        CLI_STR("scene-records", &r.frame.records, CLI_OPTIONAL, "folder of the records of the scene's photographs"),
        CLI_STR("axes", &r.frame.axes, CLI_OPTIONAL, "axes.txt: the pose is in the frame of the room's model"),
        CLI_STR("marks", &r.frame.marks, CLI_OPTIONAL,
                "lri.txt: corners of the room's model that are marked in the view; they give its pose, with --plan and "
                "--axes, and --model is read for lenses only"),
        CLI_STR("plan", &r.frame.plan, CLI_OPTIONAL, "plan.txt of the room's model"),
        CLI_STR(
            "outdoors", &r.frame.outdoors, CLI_OPTIONAL,
            "folder of the scene's cameras and rectified views: with --marks, an image that is placed in an opening "
            "is turned by what they show through it"),
        CLI_STR("out", &r.out, CLI_REQUIRED, "folder to write ID.jpg and ID.exr into"),
        CLI_PARAMS(merge_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "hdr_merge", opts, &prov, &err) != CLI_RUN || hdr_merge(&r, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
