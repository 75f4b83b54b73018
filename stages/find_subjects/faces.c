/* faces.c - detection of faces, checked across views [Colburn 2014, 3.4.2].
 *
 * The most central view is rotated upright, scaled to `side`, and searched with cascades of Haar features [Viola 2001].
 * Detections that overlap are merged into one face: the mean of the rectangles weighted by their scores, with the sum
 * of the scores.
 *
 * Cascades have false positives. So each face becomes a quadrilateral in space, at the median depth of its rectangle,
 * and other views from nearby directions check it: the surroundings of the quadrilateral, in its plane, are resampled
 * from their pictures, so that the face would appear in the middle, upright and of known size. A view confirms the face
 * if a cascade finds one there. Views from the same position are not used, since they add nothing about space. Objects
 * that look like a face from everywhere, such as a dormer, have few overlapping detection windows, so that the mean of
 * the views' scores must reach a minimum as well.
 *
 * What differs from the source: faces are checked across views; and if the most central view has no confirmed face, the
 * next ones outwards are searched. */
#include "stages/find_subjects/faces.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/central_views.h"
#include "common/film/regions.h"
#include "stages/find_subjects/region_depth.h"

#define PARAM_STRUCT struct find_params
const struct param find_param_table[] = {FIND_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define SAME_OVERLAP 0.3  /* intersection over union from which on two detections are one face */
#define INSIDE       0.5  /* part of a smaller detection inside a larger one from which on it is dropped */
#define MIN_ANGLE    0.25 /* degrees at the face between views from different positions */
#define PATCH_FACE   96   /* px: width of the quadrilateral in the resampled pictures */
#define PATCH_MARGIN 0.5  /* around the quadrilateral, in its widths */
#define SIZE_RATIO   1.5  /* maximum ratio of the widths of a confirming detection and the face, either way */
#define PLACE_ERROR  0.25 /* maximum distance between their centres, in widths */
#define MIN_PROMISE  0.3  /* part of min_score that a face must have in its own view to be checked */
#define MAX_SAMPLES  8    /* in each direction, per pixel of a reduced picture */

/* ---------------------------------------------------------------------------------------------- resampled pictures */

struct quad { /* a rectangle in space: its upper left corner and its sides */
    struct vec3 corner, across, down;
};

static struct quad quad_of(const struct subject *s, double margin)
{
    struct vec3 across = vec3_sub(s->corner[1], s->corner[0]), down = vec3_sub(s->corner[3], s->corner[0]);
    struct quad f = {s->corner[0], vec3_scale(across, 1 + 2 * margin), vec3_scale(down, 1 + 2 * margin)};
    f.corner = vec3_sub(f.corner, vec3_add(vec3_scale(across, margin), vec3_scale(down, margin)));
    return f;
}

static struct vec3 quad_at(const struct quad *f, double s, double t)
{
    return vec3_add(f->corner, vec3_add(vec3_scale(f->across, s), vec3_scale(f->down, t)));
}

/* Bilinear sample of a view's picture at a point in space; false outside the picture. */
static bool sample(const unsigned char *grey, const struct view *v, struct vec3 at, double *value)
{
    double x, y;
    if (!(view_project(v, at, &x, &y) > 0) || !(x >= 0 && x <= v->width && y >= 0 && y <= v->height)) return false;
    x = fmin(fmax(x - 0.5, 0), v->width - 1);
    y = fmin(fmax(y - 0.5, 0), v->height - 1);
    const int x0 = (int)x, y0 = (int)y, x1 = x0 + (x0 + 1 < v->width), y1 = y0 + (y0 + 1 < v->height);
    const unsigned char *upper = grey + (size_t)y0 * (size_t)v->width, *lower = grey + (size_t)y1 * (size_t)v->width;
    const double fx = x - x0, fy = y - y0;
    *value = (1 - fy) * ((1 - fx) * upper[x0] + fx * upper[x1]) + fy * ((1 - fx) * lower[x0] + fx * lower[x1]);
    return true;
}

/* Resamples the rectangle from a view's picture, with samples x samples points per pixel; 0 outside the picture. */
static void resample(unsigned char *out, int width, int height, const struct quad *f, const unsigned char *grey,
                     const struct view *v, int samples)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0, value;
            for (int i = 0; i < samples * samples; i++)
                if (sample(grey, v,
                           quad_at(f, (x + (i % samples + 0.5) / samples) / width,
                                   (y + (i / samples + 0.5) / samples) / height),
                           &value))
                    sum += value;
            out[(size_t)y * (size_t)width + (size_t)x] = (unsigned char)(sum / (samples * samples) + 0.5);
        }
}

static int samples_for(double pixels, double of)
{
    const double ratio = ceil(pixels / of);
    return ratio < 1 ? 1 : ratio > MAX_SAMPLES ? MAX_SAMPLES : (int)ratio;
}

/* ---------------------------------------------------------------------------------------------- merging detections */

static double area_of(const struct face_box *f) { return (f->x1 - f->x0) * (f->y1 - f->y0); }

static double common_area(const struct face_box *a, const struct face_box *b)
{
    const double w = fmin(a->x1, b->x1) - fmax(a->x0, b->x0), h = fmin(a->y1, b->y1) - fmax(a->y0, b->y0);
    return w > 0 && h > 0 ? w * h : 0;
}

static int compare_scores(const void *a, const void *b)
{
    const struct face_box *p = a, *q = b;
    if (p->score != q->score) return p->score > q->score ? -1 : 1;
    if (p->x0 != q->x0) return p->x0 < q->x0 ? -1 : 1;
    if (p->y0 != q->y0) return p->y0 < q->y0 ? -1 : 1;
    return (p->x1 > q->x1) - (p->x1 < q->x1);
}

static int compare_areas(const void *a, const void *b)
{
    const double p = area_of(a), q = area_of(b);
    return p != q ? (p > q ? -1 : 1) : compare_scores(a, b);
}

/* Merges the detections in place; sorts them by size, the largest first. */
static void merge_faces(struct face_box *faces, int *count)
{
    int kept = 0;
    qsort(faces, (size_t)*count, sizeof *faces, compare_scores);
    for (int i = 0; i < *count; i++) {
        struct face_box merged = {0}, first = faces[i];
        double weight = 0;
        if (!(first.score > 0)) continue;
        for (int k = i; k < *count; k++) {
            struct face_box *f = &faces[k];
            const double both = common_area(&first, f), all = area_of(&first) + area_of(f) - both;
            if (!(f->score > 0)) continue;
            if (both > SAME_OVERLAP * all) {
                merged.x0 += f->score * f->x0;
                merged.y0 += f->score * f->y0;
                merged.x1 += f->score * f->x1;
                merged.y1 += f->score * f->y1;
                weight += f->score;
                f->score = 0;
            } else if (both > INSIDE * fmin(area_of(&first), area_of(f))) {
                f->score = 0;
            }
        }
        faces[kept++] =
            (struct face_box){merged.x0 / weight, merged.y0 / weight, merged.x1 / weight, merged.y1 / weight, weight};
    }
    *count = kept;
    qsort(faces, (size_t)kept, sizeof *faces, compare_areas);
}

/* ------------------------------------------------------------------------------------------------------- the search */

struct face_search {
    const struct camera_set *set;
    const struct vec3 *ups;
    const struct face_source *source;
    const struct find_params *params;
    unsigned char **pictures; /* one per view; NULL: not read yet */
    unsigned char *patch;
};

static enum status view_picture(struct face_search *s, int view_idx, const unsigned char **grey, struct err *err)
{
    if (!s->pictures[view_idx]) s->source->picture(s->source->ctx, view_idx, &s->pictures[view_idx], err);
    *grey = s->pictures[view_idx];
    return err->status;
}

/* The faces in a view's pixels, merged. */
static enum status faces_of_view(struct face_search *s, int view_idx, struct face_box **faces, int *count,
                                 struct err *err)
{
    const struct view *v = &s->set->views[view_idx];
    const unsigned char *grey;
    struct subject whole = {.x1 = v->width, .y1 = v->height, .depth = 1};
    if (view_picture(s, view_idx, &grey, err)) return err->status;
    subject_set_corners(&whole, v, s->ups ? &s->ups[view_idx] : NULL);
    const bool turned = s->ups && fabs(s->ups[view_idx].x) > fabs(s->ups[view_idx].y);
    const int side = v->width > v->height ? v->width : v->height;
    const double scale = fmin(1, (double)s->params->side / side);
    const int width = (int)fmax(1, round(scale * (turned ? v->height : v->width)));
    const int height = (int)fmax(1, round(scale * (turned ? v->width : v->height)));
    unsigned char *upright = malloc((size_t)width * (size_t)height);
    if (!upright) return err_nomem(err, "an upright picture", (size_t)width * (size_t)height);
    const struct quad frame = quad_of(&whole, 0);
    resample(upright, width, height, &frame, grey, v, samples_for(side, fmax(width, height)));
    const double min_width = s->params->min_face * (width > height ? width : height);
    s->source->detect(s->source->ctx, upright, width, height, min_width, width > height ? width : height, faces, count,
                      err);
    for (int i = 0; !err->status && i < *count; i++) {
        struct face_box *f = &(*faces)[i];
        double x[2], y[2];
        view_project(v, quad_at(&frame, f->x0 / width, f->y0 / height), &x[0], &y[0]);
        view_project(v, quad_at(&frame, f->x1 / width, f->y1 / height), &x[1], &y[1]);
        *f = (struct face_box){fmin(x[0], x[1]), fmin(y[0], y[1]), fmax(x[0], x[1]), fmax(y[0], y[1]), f->score};
    }
    if (!err->status) merge_faces(*faces, count);
    free(upright);
    return err->status;
}

/* Whether the view's picture contains the whole quadrilateral. */
static bool contains_face(const struct view *v, const struct subject *face)
{
    for (int i = 0; i < 4; i++) {
        double x, y;
        if (!(view_project(v, face->corner[i], &x, &y) > 0)) return false;
        if (!(x >= 0 && x <= v->width && y >= 0 && y <= v->height)) return false;
    }
    return true;
}

struct other_view {
    double angle;
    int view;
};

static int compare_other_views(const void *a, const void *b)
{
    const struct other_view *p = a, *q = b;
    return p->angle != q->angle ? (p->angle < q->angle ? -1 : 1) : p->view - q->view;
}

/* The score of the faces detected in the view at the place of `face`; 0 if there are none. */
static enum status score_in_view(struct face_search *s, int view_idx, const struct subject *face, double *score,
                                 struct err *err)
{
    const struct view *v = &s->set->views[view_idx];
    const struct quad frame = quad_of(face, PATCH_MARGIN);
    const double aspect = vec3_length(frame.down) / vec3_length(frame.across);
    const int width = (int)((1 + 2 * PATCH_MARGIN) * PATCH_FACE);
    const int height = (int)fmin(fmax(round(aspect * width), PATCH_FACE / 2), 4 * PATCH_FACE);
    const unsigned char *grey;
    struct face_box *faces = NULL;
    int count = 0;
    *score = 0;
    if (view_picture(s, view_idx, &grey, err)) return err->status;
    resample(s->patch, width, height, &frame, grey, v, samples_for(subject_size_in(face, v), aspect * PATCH_FACE));
    s->source->detect(s->source->ctx, s->patch, width, height, PATCH_FACE / SIZE_RATIO, PATCH_FACE * SIZE_RATIO, &faces,
                      &count, err);
    for (int i = 0; !err->status && i < count; i++) {
        const double x = (faces[i].x0 + faces[i].x1 - width) / 2, y = (faces[i].y0 + faces[i].y1 - height) / 2;
        if (hypot(x, y) <= PLACE_ERROR * PATCH_FACE) *score += faces[i].score;
    }
    free(faces);
    return err->status;
}

/* Checks the face in other views: sets `confirmed` and `asked`, and averages the score over all views. */
static enum status check_views(struct face_search *s, int view_idx, struct subject *face, struct err *err)
{
    const struct vec3 at = subject_center(face);
    const struct vec3 to_view = vec3_normalize(vec3_sub(s->set->views[view_idx].center, at));
    struct other_view *views = malloc(((size_t)s->set->view_count + 1) * sizeof *views);
    int count = 0;
    if (!views) return err_nomem(err, "the views that check a face", (size_t)s->set->view_count * sizeof *views);
    for (int i = 0; i < s->set->view_count; i++) {
        const struct vec3 other = vec3_normalize(vec3_sub(s->set->views[i].center, at));
        const double angle = atan2(vec3_length(vec3_cross(to_view, other)), vec3_dot(to_view, other)) * 180 / M_PI;
        if (i != view_idx && angle >= MIN_ANGLE && angle <= s->params->max_angle &&
            contains_face(&s->set->views[i], face))
            views[count++] = (struct other_view){angle, i};
    }
    qsort(views, (size_t)count, sizeof *views, compare_other_views);
    face->asked = count < s->params->confirm_views ? count : s->params->confirm_views;
    double sum = face->score, score;
    for (int i = 0; !err->status && i < face->asked; i++) {
        if (score_in_view(s, views[i].view, face, &score, err)) break;
        face->confirmed += score > 0;
        sum += score;
    }
    face->score = sum / (1 + face->asked);
    free(views);
    return err->status;
}

static enum status add_sighting(struct face_report *report, struct face_sighting *sighting, struct err *err)
{
    if (array_append(&report->sightings, (size_t)report->count, sizeof *report->sightings, "faces", err))
        return err->status;
    report->sightings[report->count++] = *sighting;
    *sighting = (struct face_sighting){0};
    return ST_OK;
}

/* Finds the face's depth and place, checks it, and sets the verdict. */
static enum status judge_face(struct face_search *s, int view_idx, const struct layered_depth *depth,
                              struct face_sighting *sighting, struct err *err)
{
    struct subject *face = &sighting->subject;
    if (region_depth(&face->depth, depth, face, err)) return err->status;
    sighting->verdict = FACE_NO_DEPTH;
    if (!(face->depth > 0)) return ST_OK;
    subject_set_corners(face, &s->set->views[view_idx], s->ups ? &s->ups[view_idx] : NULL);
    if (check_views(s, view_idx, face, err)) return err->status;
    sighting->unchecked = face->asked < 2;
    if (!sighting->unchecked && face->confirmed < s->params->min_confirmed * face->asked)
        sighting->verdict = FACE_UNCONFIRMED;
    else if (face->score < (sighting->unchecked ? s->params->min_lone_score : s->params->min_score))
        sighting->verdict = FACE_LOW_SCORE;
    else
        sighting->verdict = FACE_KEPT;
    return ST_OK;
}

static enum status add_subject(struct subject_list *list, const struct subject *face, struct err *err)
{
    struct subject s = *face;
    s.view = strdup(face->view);
    return s.view ? subject_list_add(list, &s, err) : err_nomem(err, "a view's name", strlen(face->view));
}

static enum status search_view(struct face_search *s, int view_idx, struct subject_list *list,
                               struct face_report *report, struct err *err)
{
    const struct view *v = &s->set->views[view_idx];
    struct layered_depth depth = {0};
    struct face_box *faces = NULL;
    int count = 0;
    bool promising = false;
    faces_of_view(s, view_idx, &faces, &count, err);
    for (int i = 0; !err->status && i < count; i++)
        promising = promising || faces[i].score >= MIN_PROMISE * s->params->min_score;
    if (!err->status && promising) s->source->depth(s->source->ctx, view_idx, &depth, err);
    for (int i = 0; !err->status && i < count; i++) {
        const struct face_box *f = &faces[i];
        struct face_sighting sighting = {
            .subject = {.x0 = f->x0, .y0 = f->y0, .x1 = f->x1, .y1 = f->y1, .score = f->score}};
        if (f->score < MIN_PROMISE * s->params->min_score) continue;
        if (!region_clip(&sighting.subject, v->width, v->height)) continue;
        sighting.subject.view = strdup(v->name);
        if (sighting.subject.view)
            judge_face(s, view_idx, &depth, &sighting, err);
        else
            err_nomem(err, "a view's name", strlen(v->name));
        if (!err->status && sighting.verdict == FACE_KEPT) {
            if (list->count == MAX_FACES)
                sighting.verdict = FACE_SURPLUS;
            else
                add_subject(list, &sighting.subject, err);
        }
        if (!err->status) add_sighting(report, &sighting, err);
        subject_release(&sighting.subject);
    }
    layered_depth_release(&depth);
    free(faces);
    return err->status;
}

enum status faces_find(struct subject_list *list, struct face_report *report, const struct camera_set *set,
                       const struct vec3 *ups, const struct face_source *source, const struct find_params *params,
                       struct err *err)
{
    const size_t n = (size_t)set->view_count, patch = (size_t)((1 + 2 * PATCH_MARGIN) * PATCH_FACE) * 4 * PATCH_FACE;
    struct face_search s = {.set = set, .ups = ups, .source = source, .params = params};
    int *order = malloc((n + 1) * sizeof *order);
    *report = (struct face_report){0};
    s.pictures = calloc(n + 1, sizeof *s.pictures);
    s.patch = malloc(patch);
    if (order && s.pictures && s.patch)
        central_views(order, set, err);
    else
        err_nomem(err, "a search for faces", patch);
    for (int i = 0; !err->status && i < set->view_count && i < params->max_views && !list->count; i++) {
        search_view(&s, order[i], list, report, err);
        report->views = i + 1;
    }
    for (size_t i = 0; s.pictures && i < n; i++) free(s.pictures[i]);
    free(s.pictures);
    free(s.patch);
    free(order);
    if (err->status) face_report_release(report);
    return err->status;
}

void face_report_release(struct face_report *report)
{
    if (!report) return;
    for (int i = 0; i < report->count; i++) subject_release(&report->sightings[i].subject);
    free(report->sightings);
    *report = (struct face_report){0};
}
