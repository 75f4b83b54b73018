/* find_subjects.c - the subjects of camera moves: faces found in several photographs, or rectangles drawn by the user.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         FILM_VIEWS                                    with --film-views: the views that are used
 *         VIEWS/lenses.txt                              with --subjects or --records: the views' photos
 *         RECORDS/ID.txt                                with --records: the photos' orientations
 *         VIEWS/VIEW.exr                                without --subjects: the most central views and those that check
 * faces
 *         DEPTH/VIEW.exr, VIEW.txt                      of the views with subjects
 * writes  OUT                                           the subjects: the two largest faces, or the user's in their
 * order */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/capture/lens_list.h"
#include "common/capture/upright.h"
#include "common/capture/view_image.h"
#include "common/film/film_views.h"
#include "common/film/regions.h"
#include "common/image/luminance.h"
#include "common/product/product.h"
#include "stages/find_subjects/faces.h"
#include "stages/find_subjects/region_depth.h"

enum { MIN_SIZE = 8 };   /* px: smaller subjects have an uncertain size */
#define WHOLE_PART 0.999 /* of a drawn rectangle; with more of it inside a view it is not clipped */

#define CASCADES "/usr/share/opencv4/haarcascades"

struct inputs {
    const char *views, *film_views, *depth, *records, *subjects, *cascades;
    struct camera_set set;
    struct vec3 *ups; /* NULL: the photos are assumed to be stored upright */
    struct face_detector *detector;
    struct provenance *prov;
};

static enum status read_depth(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    struct inputs *in = ctx;
    const struct view *v = &in->set.views[view_idx];
    char path[FILE_PATH];
    if (product_path_in(path, in->depth, PRODUCT_DEPTH, &(struct product_key){.view = v->name}, err) ||
        layered_depth_read(d, path, in->prov, err))
        return err->status;
    if (d->width == v->width && d->height == v->height) return ST_OK;
    err_set(err, ST_DATA, "%s has %d x %d pixels, but its camera has %d x %d; make the depth maps again.", path,
            d->width, d->height, v->width, v->height);
    layered_depth_release(d);
    return err->status;
}

static enum status read_picture(void *ctx, int view_idx, unsigned char **grey, struct err *err)
{
    struct inputs *in = ctx;
    const struct view *v = &in->set.views[view_idx];
    struct image im = {0};
    if (view_image_read(&im, in->views, v, in->prov, err)) return err->status;
    const size_t pixels = (size_t)im.width * (size_t)im.height;
    *grey = malloc(pixels);
    for (size_t i = 0; *grey && i < pixels; i++) {
        (*grey)[i] = (unsigned char)(255 * srgb_from_linear(luminance_of(im.data + 4 * i)) + 0.5F);
    }
    image_release(&im);
    return *grey ? ST_OK : err_nomem(err, "a grey picture", pixels);
}

static enum status detect(void *ctx, const unsigned char *grey, int width, int height, double min_width,
                          double max_width, struct face_box **faces, int *count, struct err *err)
{
    struct inputs *in = ctx;
    return face_detect(in->detector, grey, width, height, min_width, max_width, faces, count, err);
}

/* --------------------------------------------------------------------------------------------------------- outcomes */

static void log_face(const struct face_sighting *f)
{
    const struct subject *s = &f->subject;
    char what[256];
    snprintf(what, sizeof what, "view %.100s, face of %.0f x %.0f px at %.0f %.0f (score %.0f)", s->view, s->x1 - s->x0,
             s->y1 - s->y0, s->x0, s->y0, s->score);
    switch (f->verdict) {
    case FACE_KEPT:
    case FACE_SURPLUS:
        if (f->unchecked)
            log_warn("%s: %d other views can check it, which is too few; kept because of its score", what, s->asked);
        else
            log_note("%s: %d of %d views confirm it%s", what, s->confirmed, s->asked,
                     f->verdict == FACE_KEPT ? "" : "; left out because two larger faces are kept");
        break;
    case FACE_NO_DEPTH:
        log_warn("%s: no pixel of it has a depth; left out", what);
        break;
    case FACE_UNCONFIRMED:
        log_note("%s: only %d of %d views confirm it; left out", what, s->confirmed, s->asked);
        break;
    case FACE_LOW_SCORE:
        log_note("%s: its score is too low%s; left out", what,
                 f->unchecked ? " for a face that too few other views can check" : "");
        break;
    }
}

static enum status subjects_from_faces(struct subject_list *list, struct inputs *in, const struct find_params *params,
                                       struct err *err)
{
    const struct face_source source = {in, read_picture, read_depth, detect};
    struct face_report report = {0};
    char path[FILE_PATH];
    face_detector_open(&in->detector, in->cascades, err);
    for (int i = 0; !err->status && face_cascades[i]; i++)
        provenance_add_in(in->prov, "opencv", in->cascades, face_cascades[i], "", path, err);
    if (!err->status) faces_find(list, &report, &in->set, in->ups, &source, params, err);
    int far_off = 0; /* chance detections, in windows and leaves, share one line of the log */
    for (int i = 0; !err->status && i < report.count; i++) {
        const struct face_sighting *f = &report.sightings[i];
        if ((f->verdict == FACE_LOW_SCORE || f->verdict == FACE_UNCONFIRMED) &&
            f->subject.score < params->min_score / 2)
            far_off++;
        else
            log_face(f);
    }
    if (far_off)
        log_note("%d detection%s in a single view, hardly confirmed by others; left out", far_off,
                 far_off == 1 ? "" : "s");
    if (!err->status && !list->count) log_note("no face in the %d most central views", report.views);
    face_report_release(&report);
    face_detector_release(in->detector);
    return err->status;
}

static enum status subject_from_region(struct subject_list *list, struct inputs *in, const struct region *region,
                                       const struct lens_list *lenses, struct err *err)
{
    struct subject s = {0};
    struct layered_depth depth = {0};
    int view_idx = 0;
    double part = 1;
    if (!region_in_view(&s, &view_idx, &part, region, in->subjects, &in->set, lenses, err) &&
        !read_depth(in, view_idx, &depth, err))
        region_depth(&s.depth, &depth, &s, err);
    if (!err->status && !(s.depth > 0))
        err_set(err, ST_DATA,
                "%s:%d: nothing in the rectangle from %.9g %.9g to %.9g %.9g of %s has a depth (masked, or outside "
                "the lens), so it has no place in space; draw it elsewhere or in another photo.",
                in->subjects, region->line, region->x0, region->y0, region->x1, region->y1, region->view);
    if (!err->status) {
        subject_set_corners(&s, &in->set.views[view_idx], in->ups ? &in->ups[view_idx] : NULL);
        log_note("subject %d: view %s, %.0f x %.0f px at %.0f %.0f, depth %.4g", list->count + 1, s.view, s.x1 - s.x0,
                 s.y1 - s.y0, s.x0, s.y0, s.depth);
        if (part < WHOLE_PART)
            log_warn("%s:%d: only %.0f %% of the rectangle is inside view %s; it is clipped to that part", in->subjects,
                     region->line, 100 * part, s.view);
        if (fmin(s.x1 - s.x0, s.y1 - s.y0) < MIN_SIZE)
            log_warn("%s:%d: so small a subject has an uncertain size; draw it at least %d px wide and high",
                     in->subjects, region->line, MIN_SIZE);
        subject_list_add(list, &s, err);
    }
    layered_depth_release(&depth);
    subject_release(&s);
    return err->status;
}

static enum status subjects_from_regions(struct subject_list *list, struct inputs *in, struct err *err)
{
    struct region_list regions = {0};
    struct lens_list lenses = {0};
    char path[FILE_PATH];
    if (!region_list_read(&regions, in->subjects, in->prov, err) &&
        !product_path_in(path, in->views, PRODUCT_LENSES, NULL, err))
        lens_list_read(&lenses, path, in->prov, err);
    if (!err->status && !regions.count) log_note("%s names no subject", in->subjects);
    for (int i = 0; !err->status && i < regions.count; i++)
        subject_from_region(list, in, &regions.regions[i], &lenses, err);
    lens_list_release(&lenses);
    region_list_release(&regions);
    return err->status;
}

static enum status find(struct inputs *in, const char *out, const struct find_params *params, struct err *err)
{
    struct subject_list list = {0};
    if (!camera_set_read(&in->set, in->views, in->prov, err)) film_views_keep(&in->set, in->film_views, in->prov, err);
    if (!err->status && in->records) {
        in->ups = calloc((size_t)in->set.view_count + 1, sizeof *in->ups);
        if (in->ups)
            upright_read(in->ups, &in->set, in->views, in->records, in->prov, err);
        else
            err_nomem(err, "the views' directions", (size_t)in->set.view_count * sizeof *in->ups);
    }
    if (!err->status) {
        if (in->subjects)
            subjects_from_regions(&list, in, err);
        else
            subjects_from_faces(&list, in, params, err);
    }
    if (!err->status) subject_list_write(&list, out, in->prov, err);
    subject_list_release(&list);
    camera_set_release(&in->set);
    free(in->ups);
    return err->status;
}

int main(int argc, char **argv)
{
    struct provenance prov = {0};
    struct inputs in = {.cascades = CASCADES, .prov = &prov};
    const char *out = NULL;
    struct find_params params = FIND_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the subjects of camera moves: faces, or rectangles drawn by the user."),
        CLI_STR("views", &in.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("film-views", &in.film_views, CLI_OPTIONAL,
                "views that films are made from (choose_views); default: all"),
        CLI_STR("depth", &in.depth, CLI_REQUIRED, "folder of the views' depth"),
        CLI_STR("records", &in.records, CLI_OPTIONAL, "folder of the photos' records, for their orientation"),
        CLI_STR("subjects", &in.subjects, CLI_OPTIONAL, "file of rectangles on photos, used in place of faces"),
        CLI_STR("cascades", &in.cascades, CLI_OPTIONAL, "folder of OpenCV's face cascades (" CASCADES ")"),
        CLI_STR("out", &out, CLI_REQUIRED, "list of subjects to write"),
        CLI_PARAMS(find_param_table, &params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "find_subjects", opts, &prov, &err) != CLI_RUN || find(&in, out, &params, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
