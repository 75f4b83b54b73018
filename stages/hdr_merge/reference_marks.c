/* reference_marks.c - reads marks in lighting reference images and finds their points in the model.
 *
 * A lighting reference image, such as a mirror ball or a fisheye picture, often cannot be placed by structure from
 * motion. A person then marks points of the model in it. Corners of doors, passages and windows are easiest to find
 * in a picture, so they are named: opening, left or right, bottom or top, of the wall's inside or, with "outer", of
 * its outside. Any other point is given by its coordinates.
 *
 * Left and right are those of a viewer who faces the wall from its inside. With the wall's normal n, which points at
 * the viewer, right is (-n_y, n_x) in plan. The plan stores an opening's corners in ascending coordinate, and walls
 * run along an axis, so the sign of one component of n says which of the two is the right one. Corners of openings
 * in walls along no axis are not in the plan; the error says to give points.
 *
 * Lines are checked against each other as they are read, O(n^2) for at most 4096 lines: what was said twice would
 * count twice in the fit of the pose (marked_pose.c). The lens "EQUISOLID" is approximated by OPENCV_FISHEYE
 * (camera_equisolid()). */
#include "stages/hdr_merge/reference_marks.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/capture/lens_list.h"

enum { MAX_LINES = 4096 };

static const char *const kinds[] = {
    [REFERENCE_CORNER] = "corner", [REFERENCE_POINT] = "point", [REFERENCE_LENS] = "lens",
    [REFERENCE_NEAR] = "near",     [REFERENCE_WINDOW] = "in",   [REFERENCE_HORIZON] = "horizon"};
static const char wanted_kinds[] = "\"corner\", \"point\", \"lens\", \"near\", \"in\" or \"horizon\"";

void reference_marks_release(struct reference_marks *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        free(list->marks[i].image);
        free(list->marks[i].opening);
    }
    free(list->marks);
    free(list->path);
    *list = (struct reference_marks){0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_name(char **name, struct textfile *t, const char *what, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    *name = strdup(word);
    return *name ? ST_OK : err_nomem(err, "a name", strlen(word));
}

/* Reads one of two words; *second: it is the second one. */
static enum status read_side(bool *second, struct textfile *t, const char *first, const char *other, struct err *err)
{
    char wanted[32], *word;
    snprintf(wanted, sizeof wanted, "\"%s\" or \"%s\"", first, other);
    if (textfile_word(t, wanted, &word, err)) return err->status;
    *second = !strcmp(word, other);
    return *second || !strcmp(word, first) ? ST_OK : textfile_error(t, err, word, "%s", wanted);
}

static enum status read_pixel(struct reference_mark *m, struct textfile *t, struct err *err)
{
    return textfile_double(t, "x", &m->x, err) || textfile_double(t, "y", &m->y, err) ? err->status : ST_OK;
}

static enum status read_place(struct vec3 *p, struct textfile *t, struct err *err)
{
    return textfile_double(t, "x in the model", &p->x, err) || textfile_double(t, "y in the model", &p->y, err) ||
                   textfile_double(t, "z in the model", &p->z, err)
               ? err->status
               : ST_OK;
}

static enum status read_corner(struct reference_mark *m, struct textfile *t, struct err *err)
{
    char *word = NULL;
    if (read_name(&m->opening, t, "an opening of the model", err) || read_side(&m->right, t, "left", "right", err) ||
        read_side(&m->top, t, "bottom", "top", err) || read_pixel(m, t, err))
        return err->status;
    if (!textfile_more(t)) return ST_OK;
    if (textfile_word(t, "\"outer\"", &word, err)) return err->status;
    m->outer = !strcmp(word, "outer");
    return m->outer ? ST_OK : textfile_error(t, err, word, "\"outer\" or the end of the line");
}

static enum status read_word(struct textfile *t, const char *wanted, struct err *err)
{
    char quoted[32], *word;
    snprintf(quoted, sizeof quoted, "\"%s\"", wanted);
    if (textfile_word(t, quoted, &word, err)) return err->status;
    return strcmp(word, wanted) ? textfile_error(t, err, word, "%s", quoted) : ST_OK;
}

static enum status read_share(double *share, struct textfile *t, const char *what, struct err *err)
{
    char found[32];
    if (textfile_double(t, what, share, err)) return err->status;
    if (*share >= 0 && *share <= 1) return ST_OK;
    snprintf(found, sizeof found, "%.9g", *share);
    return textfile_error(t, err, found, "%s, from 0 to 1", what);
}

static enum status read_window(struct reference_mark *m, struct textfile *t, struct err *err)
{
    m->outer = true;
    m->x = m->y = 0.5;
    if (read_name(&m->opening, t, "an opening of the model", err) || read_side(&m->at, t, "looking", "at", err) ||
        (m->at && (read_share(&m->x, t, "a share of the opening's width", err) ||
                   read_share(&m->y, t, "a share of the opening's height", err) || read_word(t, "looking", err))))
        return err->status;
    return read_word(t, "out", err);
}

static enum status read_horizon(struct reference_mark *m, struct textfile *t, struct err *err)
{
    return read_pixel(m, t, err) || textfile_double(t, "x of a second pixel", &m->other[0], err) ||
                   textfile_double(t, "y of a second pixel", &m->other[1], err)
               ? err->status
               : ST_OK;
}

static enum status read_equisolid(struct camera *c, struct textfile *t, struct err *err)
{
    int64_t width, height;
    double focal, x, y;
    struct err why = ERR_INIT;
    if (textfile_int(t, "width", 1, INT32_MAX, &width, err) || textfile_int(t, "height", 1, INT32_MAX, &height, err) ||
        textfile_double(t, "the focal length in pixels", &focal, err))
        return err->status;
    x = (double)width / 2;
    y = (double)height / 2;
    if (textfile_more(t) && (textfile_double(t, "x of the lens's centre", &x, err) ||
                             textfile_double(t, "y of the lens's centre", &y, err)))
        return err->status;
    *c = camera_equisolid((int)width, (int)height, focal, x, y);
    return camera_check(c, &why) ? err_set(err, ST_DATA, "%s:%d: %s", t->path, t->line, why.text) : ST_OK;
}

static enum status read_lens(struct reference_mark *m, struct textfile *t, struct err *err)
{
    char *model;
    if (textfile_word(t, "a camera model of COLMAP, or EQUISOLID", &model, err)) return err->status;
    return strcmp(model, "EQUISOLID") ? lens_read_camera(&m->lens, model, t, err) : read_equisolid(&m->lens, t, err);
}

static enum status read_line(struct reference_mark *m, struct textfile *t, struct err *err)
{
    const int kind_count = (int)(sizeof kinds / sizeof *kinds);
    char *word;
    int kind = 0;
    m->line = t->line;
    if (textfile_word(t, wanted_kinds, &word, err)) return err->status;
    while (kind < kind_count && strcmp(word, kinds[kind])) kind++;
    if (kind == kind_count) return textfile_error(t, err, word, "%s", wanted_kinds);
    m->kind = (enum reference_mark_kind)kind;
    if (read_name(&m->image, t, "an image", err)) return err->status;
    if (m->kind != REFERENCE_LENS && !strcmp(m->image, "*"))
        return textfile_error(t, err, m->image, "an image; * is allowed for lenses only");
    if (m->kind == REFERENCE_CORNER)
        read_corner(m, t, err);
    else if (m->kind == REFERENCE_LENS)
        read_lens(m, t, err);
    else if (m->kind == REFERENCE_NEAR)
        read_place(&m->point, t, err);
    else if (m->kind == REFERENCE_WINDOW)
        read_window(m, t, err);
    else if (m->kind == REFERENCE_HORIZON)
        read_horizon(m, t, err);
    else if (!read_pixel(m, t, err))
        read_place(&m->point, t, err);
    if (!err->status) textfile_end(t, err);
    return err->status;
}

static bool is_repeated(const struct reference_mark *a, const struct reference_mark *b)
{
    if (a->kind != b->kind || strcmp(a->image, b->image)) return false;
    if (a->kind == REFERENCE_CORNER)
        return !strcmp(a->opening, b->opening) && a->right == b->right && a->top == b->top && a->outer == b->outer;
    if (a->kind == REFERENCE_POINT)
        return a->point.x == b->point.x && a->point.y == b->point.y && a->point.z == b->point.z;
    return true;
}

static enum status check_repeated(const struct reference_marks *list, const struct reference_mark *m, struct err *err)
{
    for (const struct reference_mark *b = list->marks; b < m; b++)
        if (is_repeated(b, m))
            return err_set(err, ST_DATA, "%s:%d: found what line %d says of %s; delete one of the lines.", list->path,
                           m->line, b->line, m->image);
    return ST_OK;
}

enum status reference_marks_read(struct reference_marks *list, const char *path, struct provenance *prov,
                                 struct err *err)
{
    struct textfile t = {0};
    *list = (struct reference_marks){.path = strdup(path)};
    if (list->path)
        provenance_open(prov, "lri.txt", &t, path, err);
    else
        err_nomem(err, "a file name", strlen(path));
    while (!err->status && textfile_next(&t)) {
        if (list->count == MAX_LINES)
            err_set(err, ST_DATA, "%s has more than %d lines; delete some.", path, (int)MAX_LINES);
        if (!err->status) array_append(&list->marks, (size_t)list->count, sizeof *list->marks, "marks", err);
        if (err->status) break;
        struct reference_mark *m = &list->marks[list->count++];
        *m = (struct reference_mark){0};
        if (!read_line(m, &t, err)) check_repeated(list, m, err);
    }
    textfile_release(&t);
    if (err->status) reference_marks_release(list);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- locating */

bool reference_mark_is_of(const struct reference_mark *m, const struct photo_record *image)
{
    if (!strcmp(m->image, image->id)) return true;
    for (int i = 0; i < image->bracket_count; i++)
        if (!strcmp(m->image, image->brackets[i].file)) return true;
    return false;
}

static const char *opening_name(const void *ctx, int i)
{
    const struct model_plan *plan = ctx;
    return i < plan->opening_count ? plan->openings[i].name : NULL;
}

static enum status find_opening(int *opening, const struct reference_mark *m, const struct reference_marks *list,
                                const struct model_plan *plan, struct err *err)
{
    char shown[SCAN_QUOTED];
    for (*opening = 0; *opening < plan->opening_count; (*opening)++)
        if (!strcmp(plan->openings[*opening].name, m->opening)) return ST_OK;
    const char *nearest = scan_nearest(m->opening, opening_name, plan);
    return err_set(err, ST_DATA,
                   "%s:%d: found the opening %s, wanted a door, passage or window of the model%s%s; mark other points "
                   "with \"point\".",
                   list->path, m->line, scan_quote(shown, m->opening), nearest ? "; did you mean " : "",
                   nearest ? nearest : "");
}

enum status reference_mark_locate(struct vec3 *at, const struct model_wall **wall, const struct reference_mark *m,
                                  const struct reference_marks *list, const struct model_plan *plan, struct err *err)
{
    struct vec3 corners[2];
    int opening = 0;
    *at = m->point;
    *wall = NULL;
    if (m->kind != REFERENCE_CORNER && m->kind != REFERENCE_WINDOW) return ST_OK;
    if (find_opening(&opening, m, list, plan, err)) return err->status;
    const struct model_wall *w = *wall = &plan->walls[plan->openings[opening].wall];
    if (!model_opening_corners(plan, opening, corners))
        return err_set(
            err, ST_DATA,
            "%s:%d: the opening %s is in the wall %s, which is along no axis, so that the plan does not hold "
            "its corners; mark them with \"point\".",
            list->path, m->line, m->opening, w->name);
    /* for a viewer who faces the wall from its inside, the right-hand direction is (-ny, nx) */
    const bool right_is_upper = fabs(w->normal[0]) > 0.5 ? w->normal[0] > 0 : w->normal[1] < 0;
    const double right = m->kind == REFERENCE_CORNER ? m->right : m->x,
                 top = m->kind == REFERENCE_CORNER ? m->top : m->y;
    *at = vec3_add(vec3_scale(corners[!right_is_upper], 1 - right), vec3_scale(corners[right_is_upper], right));
    at->z = (1 - top) * corners[0].z + top * corners[1].z;
    if (!m->outer) return ST_OK;
    at->x -= w->normal[0] * w->thickness;
    at->y -= w->normal[1] * w->thickness;
    return ST_OK;
}
