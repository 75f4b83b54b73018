/* subject_list.c - subjects on disk, in space and in a camera. */
#include "common/film/subject_list.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

enum { MAX_SUBJECTS = 100000, NAME_SIZE = 1024 };

static const char *const source_names[] = {[SUBJECT_FACE] = "face", [SUBJECT_USER] = "user"};

void subject_release(struct subject *s)
{
    if (!s) return;
    free(s->view);
    *s = (struct subject){0};
}

void subject_list_release(struct subject_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) subject_release(&list->subjects[i]);
    free(list->subjects);
    *list = (struct subject_list){0};
}

enum status subject_list_add(struct subject_list *list, struct subject *s, struct err *err)
{
    if (array_append(&list->subjects, (size_t)list->count, sizeof *list->subjects, "subjects", err)) {
        subject_release(s);
        return err->status;
    }
    list->subjects[list->count++] = *s;
    *s = (struct subject){0};
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- geometry */

void subject_set_corners(struct subject *s, const struct view *view, const struct vec3 *up)
{
    const struct vec3 u = up ? *up : vec3_make(0, -1, 0);
    const double x[4] = {s->x0, s->x1, s->x1, s->x0}, y[4] = {s->y0, s->y0, s->y1, s->y1};
    int first = 0; /* corner, clockwise from (x0, y0), that is upper left in the upright picture */
    if (fabs(u.x) > fabs(u.y))
        first = u.x < 0 ? 3 : 1;
    else if (u.y > 0)
        first = 2;
    for (int i = 0; i < 4; i++) s->corner[i] = view_unproject(view, x[(first + i) % 4], y[(first + i) % 4], s->depth);
}

static struct vec3 between(struct vec3 a, struct vec3 b, double t)
{
    return vec3_add(vec3_scale(a, 1 - t), vec3_scale(b, t));
}

/* A point on the vertical centre line, from its upper end (0) to its lower end (1). */
static struct vec3 on_center_line(const struct subject *s, double t)
{
    return between(between(s->corner[0], s->corner[1], 0.5), between(s->corner[3], s->corner[2], 0.5), t);
}

struct vec3 subject_center(const struct subject *s) { return on_center_line(s, 0.5); }

struct vec3 subject_lower_center(const struct subject *s) { return on_center_line(s, 0.75); }

double subject_size_in(const struct subject *s, const struct view *camera)
{
    double u[2], v[2];
    for (int i = 0; i < 2; i++)
        if (!(view_project(camera, on_center_line(s, i), &u[i], &v[i]) > 0)) return 0;
    const double size = hypot(u[1] - u[0], v[1] - v[0]);
    return isfinite(size) ? size : 0;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

enum status subject_list_write(const struct subject_list *list, const char *path, const struct provenance *prov,
                               struct err *err)
{
    struct outfile f = {0};
    char view[NAME_SIZE];
    if (!product_begin(&f, PRODUCT_SUBJECTS, path, prov, err)) fprintf(f.fp, "subjects %d\n", list->count);
    for (int i = 0; !err->status && i < list->count; i++) {
        const struct subject *s = &list->subjects[i];
        if (textfile_quote(s->view, view, sizeof view, err)) break;
        fprintf(f.fp, "subject %s %s %.17g %.17g %.17g %.17g %.17g %.17g %d %d\n", view, source_names[s->source], s->x0,
                s->y0, s->x1, s->y1, s->depth, s->score, s->confirmed, s->asked);
        for (int k = 0; k < 4; k++)
            fprintf(f.fp, "corner %.17g %.17g %.17g\n", s->corner[k].x, s->corner[k].y, s->corner[k].z);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_subject(struct textfile *t, struct subject *s, struct err *err)
{
    char *view, *source;
    int64_t confirmed, asked;
    if (textfile_expect_line(t, "subject", err) || textfile_word(t, "a view's name", &view, err) ||
        textfile_word(t, "\"face\" or \"user\"", &source, err))
        return err->status;
    if (!strcmp(source, source_names[SUBJECT_USER]))
        s->source = SUBJECT_USER;
    else if (strcmp(source, source_names[SUBJECT_FACE]))
        return textfile_error(t, err, source, "\"face\" or \"user\"");
    s->view = strdup(view);
    if (!s->view) return err_nomem(err, "a view's name", strlen(view));
    if (textfile_double(t, "x0", &s->x0, err) || textfile_double(t, "y0", &s->y0, err) ||
        textfile_double(t, "x1", &s->x1, err) || textfile_double(t, "y1", &s->y1, err) ||
        textfile_double(t, "depth", &s->depth, err) || textfile_double(t, "score", &s->score, err) ||
        textfile_int(t, "number of confirming views", 0, INT_MAX, &confirmed, err) ||
        textfile_int(t, "number of views searched", confirmed, INT_MAX, &asked, err) || textfile_end(t, err))
        return err->status;
    s->confirmed = (int)confirmed;
    s->asked = (int)asked;
    if (!(s->x1 > s->x0)) return textfile_wrong_number(t, s->x1, "an x1 above x0", err);
    if (!(s->y1 > s->y0)) return textfile_wrong_number(t, s->y1, "a y1 above y0", err);
    if (!(s->depth > 0)) return textfile_wrong_number(t, s->depth, "a depth above 0", err);
    if (!(s->score >= 0)) return textfile_wrong_number(t, s->score, "a score of 0 or more", err);
    for (int i = 0; i < 4; i++) {
        struct vec3 *c = &s->corner[i];
        if (textfile_expect_line(t, "corner", err) || textfile_double(t, "x", &c->x, err) ||
            textfile_double(t, "y", &c->y, err) || textfile_double(t, "z", &c->z, err) || textfile_end(t, err))
            return err->status;
    }
    const struct vec3 across = vec3_sub(s->corner[1], s->corner[0]), down = vec3_sub(s->corner[3], s->corner[0]);
    if (!(vec3_length(vec3_cross(across, down)) > 0))
        return textfile_error(t, err, "corners in a line", "corners that span an area");
    return ST_OK;
}

enum status subject_list_read(struct subject_list *list, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    int64_t count = 0;
    *list = (struct subject_list){0};
    if (!product_open(&t, NULL, PRODUCT_SUBJECTS, path, prov, err) && !textfile_expect_line(&t, "subjects", err) &&
        !textfile_int(&t, "number of subjects", 0, MAX_SUBJECTS, &count, err))
        textfile_end(&t, err);
    for (int64_t i = 0; !err->status && i < count; i++) {
        struct subject s = {0};
        if (!read_subject(&t, &s, err)) subject_list_add(list, &s, err);
        subject_release(&s);
    }
    if (!err->status) textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (err->status) subject_list_release(list);
    return err->status;
}
