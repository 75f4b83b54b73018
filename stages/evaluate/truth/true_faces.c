/* true_faces.c - see true_faces.h. */
#include "stages/evaluate/truth/true_faces.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"

enum { MAX_ID = 1 << 20 };

static enum status read_face(struct true_faces *faces, struct textfile *t, struct err *err)
{
    int64_t id;
    char *name;
    double area, n[3];
    if (textfile_int(t, "a face's id", 1, MAX_ID, &id, err) || textfile_word(t, "its name", &name, err) ||
        textfile_double(t, "its area", &area, err) || textfile_double(t, "x of its normal", &n[0], err) ||
        textfile_double(t, "y of its normal", &n[1], err) || textfile_double(t, "z of its normal", &n[2], err) ||
        textfile_end(t, err))
        return err->status;
    while (faces->count < id) {
        if (array_append(&faces->faces, (size_t)faces->count, sizeof *faces->faces, "faces", err)) return err->status;
        faces->faces[faces->count++] = (struct true_face){0};
    }
    struct true_face *f = &faces->faces[id - 1];
    if (f->name) return textfile_wrong_number(t, (double)id, "an id that is on no line above", err);
    *f = (struct true_face){strdup(name), vec3_make(n[0], n[1], n[2])};
    if (!f->name) return err_nomem(err, "a name", strlen(name));
    return ST_OK;
}

enum status true_faces_read(struct true_faces *faces, const char *path, struct err *err)
{
    struct textfile t = {0};
    *faces = (struct true_faces){0};
    if (!textfile_open(&t, path, err) && !textfile_expect_line(&t, "remodel-faces", err) &&
        !textfile_expect(&t, "1", err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_face(faces, &t, err);
    textfile_release(&t);
    if (err->status) true_faces_release(faces);
    return err->status;
}

void true_faces_release(struct true_faces *faces)
{
    for (int i = 0; i < faces->count; i++) free(faces->faces[i].name);
    free(faces->faces);
    *faces = (struct true_faces){0};
}
