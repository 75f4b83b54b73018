/* faces.c - see faces.h.
 *
 * The centremost view is turned upright, scaled to `side`, and looked through for faces (thesis 3.4.2). What the
 * cascades find several times at one place is one face: the mean of its rectangles, weighted by their scores, which are
 * added.
 *
 * Cascades also see faces that are not there. So each face becomes a quadrilateral in space, at the median depth of its
 * rectangle, and other views that see it from nearby directions are asked: what lies around the quadrilateral, in its
 * plane, is resampled from their pictures, where a face of that place and size would stand in the middle, as large as
 * the quadrilateral and as upright as in the first view. A view confirms if a cascade finds one there. Views from the
 * same place are not asked: they tell nothing of space. What looks like a face by chance, a dormer say, does so from
 * everywhere: it differs by how few overlapping windows see it, so that the mean of the views' scores decides as well.
 * If a view has no confirmed face the next one outwards is looked at; the thesis has the centremost alone. */
#include "stages/find_subjects/faces.h"

#include <stdlib.h>
#include <string.h>

#include "common/capture/central_views.h"
#include "stages/find_subjects/region_depth.h"

#define PARAM_STRUCT struct find_params
const struct param find_param_table[] = {FIND_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define SAME_OVERLAP 0.3  /* intersection over union of two rectangles of one face */
#define INSIDE       0.5  /* part of the smaller one that lies in the larger: a face has no second one in it */
#define LEAST_ANGLE  0.25 /* degrees at the face between two views that are not at the same place */
#define PATCH_FACE   96   /* px: width of the quadrilateral in the pictures that confirm */
#define PATCH_MARGIN 0.5  /* around it, in its widths */
#define SIZE_RATIO   1.5  /* of a face that confirms to the one it confirms, at most, either way */
#define PLACE_ERROR  0.25 /* between their middles, in widths */
#define WORTH_ASKING 0.3  /* part of least_score that its own view must give a face */
#define MOST_SAMPLES 8    /* of a picture, each way, for a pixel of a smaller one */

/* ------------------------------------------------------------------------------------------- pictures of rectangles */

struct frame { /* a rectangle in space, from its upper left corner */
    struct vec3 corner, across, down;
};

static struct frame frame_of(const struct subject *s, double margin)
{
    struct vec3 across = vec3_sub(s->corner[1], s->corner[0]), down = vec3_sub(s->corner[3], s->corner[0]);
    struct frame f = {s->corner[0], vec3_scale(across, 1 + 2 * margin), vec3_scale(down, 1 + 2 * margin)};
    f.corner = vec3_sub(f.corner, vec3_add(vec3_scale(across, margin), vec3_scale(down, margin)));
    return f;
}

static struct vec3 frame_at(const struct frame *f, double s, double t)
{
    return vec3_add(f->corner, vec3_add(vec3_scale(f->across, s), vec3_scale(f->down, t)));
}

/* Between the four nearest pixels; false outside. */
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

/* What a view shows of the rectangle, `samples` by `samples` places averaged for a pixel; 0 where it shows nothing. */
static void resample(unsigned char *out, int width, int height, const struct frame *f, const unsigned char *grey,
                     const struct view *v, int samples)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0, value;
            for (int i = 0; i < samples * samples; i++)
                if (sample(grey, v,
                           frame_at(f, (x + (i % samples + 0.5) / samples) / width,
                                    (y + (i / samples + 0.5) / samples) / height),
                           &value))
                    sum += value;
            out[(size_t)y * (size_t)width + (size_t)x] = (unsigned char)(sum / (samples * samples) + 0.5);
        }
}

static int samples_for(double pixels, double of)
{
    const double ratio = ceil(pixels / of);
    return ratio < 1 ? 1 : ratio > MOST_SAMPLES ? MOST_SAMPLES : (int)ratio;
}

/* ---------------------------------------------------------------------------------------------- one face of several */

static double area_of(const struct face *f) { return (f->x1 - f->x0) * (f->y1 - f->y0); }

static double common_area(const struct face *a, const struct face *b)
{
    const double w = fmin(a->x1, b->x1) - fmax(a->x0, b->x0), h = fmin(a->y1, b->y1) - fmax(a->y0, b->y0);
    return w > 0 && h > 0 ? w * h : 0;
}

static int compare_scores(const void *a, const void *b)
{
    const struct face *p = a, *q = b;
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

/* Merges in place; the largest first. */
static void merge_faces(struct face *faces, int *count)
{
    int kept = 0;
    qsort(faces, (size_t)*count, sizeof *faces, compare_scores);
    for (int i = 0; i < *count; i++) {
        struct face merged = {0}, first = faces[i];
        double weight = 0;
        if (!(first.score > 0)) continue;
        for (int k = i; k < *count; k++) {
            struct face *f = &faces[k];
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
            (struct face){merged.x0 / weight, merged.y0 / weight, merged.x1 / weight, merged.y1 / weight, weight};
    }
    *count = kept;
    qsort(faces, (size_t)kept, sizeof *faces, compare_areas);
}

/* --------------------------------------------------------------------------------------------------------- a search */

struct search {
    const struct camera_set *set;
    const struct vec3 *ups;
    const struct face_source *source;
    const struct find_params *params;
    unsigned char **pictures; /* a view; NULL: not read yet */
    unsigned char *patch;
};

static enum status picture_of(struct search *s, int view_idx, const unsigned char **grey, struct err *err)
{
    enum status st = ST_OK;
    if (!s->pictures[view_idx]) st = s->source->picture(s->source->ctx, view_idx, &s->pictures[view_idx], err);
    *grey = s->pictures[view_idx];
    return st;
}

/* The faces in a view's pixels, merged. */
static enum status faces_of_view(struct search *s, int view_idx, struct face **faces, int *count, struct err *err)
{
    const struct view *v = &s->set->views[view_idx];
    const unsigned char *grey;
    struct subject whole = {.x1 = v->width, .y1 = v->height, .depth = 1};
    if (picture_of(s, view_idx, &grey, err)) return err->status;
    subject_set_corners(&whole, v, s->ups ? &s->ups[view_idx] : NULL);
    const bool turned = s->ups && fabs(s->ups[view_idx].x) > fabs(s->ups[view_idx].y);
    const int side = v->width > v->height ? v->width : v->height;
    const double scale = fmin(1, (double)s->params->side / side);
    const int width = (int)fmax(1, round(scale * (turned ? v->height : v->width)));
    const int height = (int)fmax(1, round(scale * (turned ? v->width : v->height)));
    unsigned char *upright = malloc((size_t)width * (size_t)height);
    if (!upright) return err_nomem(err, "an upright picture", (size_t)width * (size_t)height);
    const struct frame frame = frame_of(&whole, 0);
    resample(upright, width, height, &frame, grey, v, samples_for(side, fmax(width, height)));
    const double least = s->params->least_face * (width > height ? width : height);
    enum status st = s->source->detect(s->source->ctx, upright, width, height, least, width > height ? width : height,
                                       faces, count, err);
    for (int i = 0; !st && i < *count; i++) {
        struct face *f = &(*faces)[i];
        double x[2], y[2];
        view_project(v, frame_at(&frame, f->x0 / width, f->y0 / height), &x[0], &y[0]);
        view_project(v, frame_at(&frame, f->x1 / width, f->y1 / height), &x[1], &y[1]);
        *f = (struct face){fmin(x[0], x[1]), fmin(y[0], y[1]), fmax(x[0], x[1]), fmax(y[0], y[1]), f->score};
    }
    if (!st) merge_faces(*faces, count);
    free(upright);
    return st;
}

/* The view's picture holds all of the quadrilateral. */
static bool shows(const struct view *v, const struct subject *face)
{
    for (int i = 0; i < 4; i++) {
        double x, y;
        if (!(view_project(v, face->corner[i], &x, &y) > 0)) return false;
        if (!(x >= 0 && x <= v->width && y >= 0 && y <= v->height)) return false;
    }
    return true;
}

struct candidate {
    double angle;
    int view;
};

static int compare_candidates(const void *a, const void *b)
{
    const struct candidate *p = a, *q = b;
    return p->angle != q->angle ? (p->angle < q->angle ? -1 : 1) : p->view - q->view;
}

/* Score of the faces that the view shows in the place of `face`; 0: none. */
static enum status score_in(struct search *s, int view_idx, const struct subject *face, double *score, struct err *err)
{
    const struct view *v = &s->set->views[view_idx];
    const struct frame frame = frame_of(face, PATCH_MARGIN);
    const double aspect = vec3_length(frame.down) / vec3_length(frame.across);
    const int width = (int)((1 + 2 * PATCH_MARGIN) * PATCH_FACE);
    const int height = (int)fmin(fmax(round(aspect * width), PATCH_FACE / 2), 4 * PATCH_FACE);
    const unsigned char *grey;
    struct face *faces = NULL;
    int count = 0;
    *score = 0;
    if (picture_of(s, view_idx, &grey, err)) return err->status;
    resample(s->patch, width, height, &frame, grey, v, samples_for(subject_size_in(face, v), aspect * PATCH_FACE));
    enum status st = s->source->detect(s->source->ctx, s->patch, width, height, PATCH_FACE / SIZE_RATIO,
                                       PATCH_FACE * SIZE_RATIO, &faces, &count, err);
    for (int i = 0; !st && i < count; i++) {
        const double x = (faces[i].x0 + faces[i].x1 - width) / 2, y = (faces[i].y0 + faces[i].y1 - height) / 2;
        if (hypot(x, y) <= PLACE_ERROR * PATCH_FACE) *score += faces[i].score;
    }
    free(faces);
    return st;
}

/* Sets confirmed and asked; the score becomes the mean of all views'. */
static enum status ask_views(struct search *s, int view_idx, struct subject *face, struct err *err)
{
    const struct vec3 at = subject_center(face);
    const struct vec3 to_view = vec3_normalize(vec3_sub(s->set->views[view_idx].center, at));
    struct candidate *views = malloc(((size_t)s->set->view_count + 1) * sizeof *views);
    int count = 0;
    if (!views) return err_nomem(err, "views to ask", (size_t)s->set->view_count * sizeof *views);
    for (int i = 0; i < s->set->view_count; i++) {
        const struct vec3 other = vec3_normalize(vec3_sub(s->set->views[i].center, at));
        const double angle = atan2(vec3_length(vec3_cross(to_view, other)), vec3_dot(to_view, other)) * 180 / M_PI;
        if (i != view_idx && angle >= LEAST_ANGLE && angle <= s->params->max_angle && shows(&s->set->views[i], face))
            views[count++] = (struct candidate){angle, i};
    }
    qsort(views, (size_t)count, sizeof *views, compare_candidates);
    face->asked = count < s->params->asked ? count : s->params->asked;
    enum status st = ST_OK;
    double sum = face->score, score;
    for (int i = 0; !st && i < face->asked; i++) {
        st = score_in(s, views[i].view, face, &score, err);
        if (st) break;
        face->confirmed += score > 0;
        sum += score;
    }
    face->score = sum / (1 + face->asked);
    free(views);
    return st;
}

static enum status add_sighting(struct face_report *report, struct face_sighting *sighting, struct err *err)
{
    const size_t bytes = ((size_t)report->count + 1) * sizeof *report->sightings;
    struct face_sighting *more = realloc(report->sightings, bytes);
    if (!more) return err_nomem(err, "faces", bytes);
    report->sightings = more;
    report->sightings[report->count++] = *sighting;
    *sighting = (struct face_sighting){0};
    return ST_OK;
}

/* Depth, place and verdict. */
static enum status judge(struct search *s, int view_idx, const struct layered_depth *depth,
                         struct face_sighting *sighting, struct err *err)
{
    struct subject *face = &sighting->subject;
    if (region_depth(&face->depth, depth, face, err)) return err->status;
    sighting->verdict = FACE_NO_DEPTH;
    if (!(face->depth > 0)) return ST_OK;
    subject_set_corners(face, &s->set->views[view_idx], s->ups ? &s->ups[view_idx] : NULL);
    if (ask_views(s, view_idx, face, err)) return err->status;
    sighting->alone = face->asked < 2;
    if (!sighting->alone && face->confirmed < s->params->confirm * face->asked)
        sighting->verdict = FACE_UNCONFIRMED;
    else if (face->score < (sighting->alone ? s->params->lone_score : s->params->least_score))
        sighting->verdict = FACE_UNSURE;
    else
        sighting->verdict = FACE_KEPT;
    return ST_OK;
}

static enum status keep(struct subject_list *list, const struct subject *face, struct err *err)
{
    struct subject s = *face;
    s.view = strdup(face->view);
    return s.view ? subject_list_add(list, &s, err) : err_nomem(err, "a view's name", strlen(face->view));
}

static enum status look_at(struct search *s, int view_idx, struct subject_list *list, struct face_report *report,
                           struct err *err)
{
    const struct view *v = &s->set->views[view_idx];
    struct layered_depth depth = {0};
    struct face *faces = NULL;
    int count = 0;
    bool worth = false;
    enum status st = faces_of_view(s, view_idx, &faces, &count, err);
    for (int i = 0; !st && i < count; i++) worth = worth || faces[i].score >= WORTH_ASKING * s->params->least_score;
    if (!st && worth) st = s->source->depth(s->source->ctx, view_idx, &depth, err);
    for (int i = 0; !st && i < count; i++) {
        const struct face *f = &faces[i];
        struct face_sighting sighting = {
            .subject = {.x0 = f->x0, .y0 = f->y0, .x1 = f->x1, .y1 = f->y1, .score = f->score}};
        if (f->score < WORTH_ASKING * s->params->least_score) continue;
        if (!clip_to_picture(&sighting.subject, v->width, v->height)) continue;
        sighting.subject.view = strdup(v->name);
        st = sighting.subject.view ? judge(s, view_idx, &depth, &sighting, err)
                                   : err_nomem(err, "a view's name", strlen(v->name));
        if (!st && sighting.verdict == FACE_KEPT) {
            if (list->count == MOST_FACES)
                sighting.verdict = FACE_BEYOND;
            else
                st = keep(list, &sighting.subject, err);
        }
        if (!st) st = add_sighting(report, &sighting, err);
        subject_release(&sighting.subject);
    }
    layered_depth_release(&depth);
    free(faces);
    return st;
}

enum status find_faces(struct subject_list *list, struct face_report *report, const struct camera_set *set,
                       const struct vec3 *ups, const struct face_source *source, const struct find_params *params,
                       struct err *err)
{
    const size_t n = (size_t)set->view_count, patch = (size_t)((1 + 2 * PATCH_MARGIN) * PATCH_FACE) * 4 * PATCH_FACE;
    struct search s = {.set = set, .ups = ups, .source = source, .params = params};
    int *order = malloc((n + 1) * sizeof *order);
    *report = (struct face_report){0};
    s.pictures = calloc(n + 1, sizeof *s.pictures);
    s.patch = malloc(patch);
    enum status st =
        order && s.pictures && s.patch ? central_views(order, set, err) : err_nomem(err, "a search for faces", patch);
    for (int i = 0; !st && i < set->view_count && i < params->views && !list->count; i++) {
        st = look_at(&s, order[i], list, report, err);
        report->views = i + 1;
    }
    for (size_t i = 0; s.pictures && i < n; i++) free(s.pictures[i]);
    free(s.pictures);
    free(s.patch);
    free(order);
    if (st) face_report_release(report);
    return st;
}

void face_report_release(struct face_report *report)
{
    if (!report) return;
    for (int i = 0; i < report->count; i++) subject_release(&report->sightings[i].subject);
    free(report->sightings);
    *report = (struct face_report){0};
}
