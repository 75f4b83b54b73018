/* thing_marks.c - reads what users marked; see thing_marks.h. */
#include "common/model/thing_marks.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/capture/photo_camera.h"

struct marks_reader {
    struct thing_marks *marks;
    struct textfile t;
    const struct camera_set *set; /* NULL: names alone */
    const struct lens_list *lenses;
};

void thing_marks_release(struct thing_marks *m)
{
    if (!m) return;
    for (int i = 0; i < m->name_count; i++) free(m->names[i]);
    for (int i = 0; i < m->mark_count; i++) free(m->marks[i].view);
    free(m->names);
    free(m->lines);
    free(m->flat);
    free(m->marks);
    *m = (struct thing_marks){0};
}

/* The index of a name, which is added if it is new; -1: out of memory. */
static int name_index(struct thing_marks *m, const char *name, bool flat, int line, struct err *err)
{
    for (int i = 0; i < m->name_count; i++)
        if (!strcmp(m->names[i], name)) return i;
    if (array_append(&m->names, (size_t)m->name_count, sizeof *m->names, "names of things", err) ||
        array_append(&m->lines, (size_t)m->name_count, sizeof *m->lines, "names of things", err) ||
        array_append(&m->flat, (size_t)m->name_count, sizeof *m->flat, "names of things", err))
        return -1;
    m->flat[m->name_count] = flat;
    m->lines[m->name_count] = line;
    if (!(m->names[m->name_count] = strdup(name))) {
        err_nomem(err, "a name", strlen(name));
        return -1;
    }
    return m->name_count++;
}

/* The photo of a mark; camera: not set without cameras. */
static enum status read_photo(struct photo_camera *camera, char **word, struct marks_reader *r, struct err *err)
{
    if (textfile_expect(&r->t, "in", err) || textfile_word(&r->t, "a photo", word, err) || !r->set) return err->status;
    return photo_camera_find(camera, *word, r->set, r->lenses, r->t.path, r->t.line, err);
}

static enum status read_pixel(struct marks_reader *r, int name, const struct photo_camera *camera, const char *view,
                              struct err *err)
{
    struct thing_mark mark = {.name = name, .line = r->t.line};
    char place[64];
    if (textfile_double(&r->t, "X", &mark.u, err) || textfile_double(&r->t, "Y", &mark.v, err)) return err->status;
    if (!r->set) return ST_OK;
    snprintf(place, sizeof place, "pixel %.6g %.6g", mark.u, mark.v);
    if (!photo_camera_ray(camera, mark.u, mark.v, &mark.direction))
        return textfile_error(&r->t, err, place, "a pixel of the photo, which has %d x %d", camera->lens.width,
                              camera->lens.height);
    mark.origin = camera->center;
    if (!(mark.view = strdup(view))) return err_nomem(err, "a name", strlen(view));
    if (array_append(&r->marks->marks, (size_t)r->marks->mark_count, sizeof mark, "marks", err)) {
        free(mark.view);
        return err->status;
    }
    r->marks->marks[r->marks->mark_count++] = mark;
    return ST_OK;
}

static enum status read_marks(struct marks_reader *r, int name, struct err *err)
{
    struct photo_camera camera;
    char *view;
    do
        if (read_photo(&camera, &view, r, err) || read_pixel(r, name, &camera, view, err)) break;
    while (textfile_more(&r->t));
    return err->status;
}

static enum status read_outline(struct marks_reader *r, int name, struct err *err)
{
    struct photo_camera camera;
    char *view;
    int corners = 0;
    if (read_photo(&camera, &view, r, err)) return err->status;
    do corners++;
    while (!read_pixel(r, name, &camera, view, err) && (textfile_more(&r->t) || corners == 2)); /* one: a pixel of it */
    return err->status;
}

static enum status read_line(struct marks_reader *r, struct err *err)
{
    char *word;
    if (textfile_word(&r->t, "thing or flat", &word, err)) return err->status;
    const bool flat = !strcmp(word, "flat");
    if (!flat && strcmp(word, "thing")) return textfile_error(&r->t, err, word, "thing or flat");
    if (textfile_word(&r->t, "a name", &word, err)) return err->status;
    if (!scan_is_name(word))
        return textfile_error(&r->t, err, word, "a name of at most %d letters, digits, _ and -, not a number",
                              SCAN_NAME);
    const int before = r->marks->name_count, name = name_index(r->marks, word, flat, r->t.line, err);
    if (name < 0) return err->status;
    if (name < before && (flat || r->marks->flat[name]))
        return textfile_error(&r->t, err, word, "another name: line %d %s", r->marks->lines[name],
                              r->marks->flat[name] ? "has an outline of it" : "marks a thing of this name");
    return flat ? read_outline(r, name, err) : read_marks(r, name, err);
}

enum status thing_names_read(struct thing_marks *marks, const char *path, struct provenance *prov, struct err *err)
{
    return thing_marks_read(marks, path, NULL, NULL, prov, err);
}

enum status thing_marks_read(struct thing_marks *marks, const char *path, const struct camera_set *set,
                             const struct lens_list *lenses, struct provenance *prov, struct err *err)
{
    struct marks_reader r = {.marks = marks, .set = set, .lenses = lenses};
    int64_t version;
    *marks = (struct thing_marks){0};
    if (!provenance_open(prov, "things.txt", &r.t, path, err) &&
        !textfile_expect_line(&r.t, "remodel-marked-things", err) &&
        !textfile_int(&r.t, "the version", 1, 1, &version, err))
        textfile_end(&r.t, err);
    while (!err->status && textfile_next(&r.t)) read_line(&r, err);
    textfile_release(&r.t);
    if (err->status) thing_marks_release(marks);
    return err->status;
}
