/* object_list.c - see object_list.h. */
#include "common/light/object_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/light/gloss.h"
#include "common/product/product.h"

enum { MAX_WORD = 255, QUOTED_SIZE = 2 * MAX_WORD + 3 };

void object_list_release(struct object_list *l)
{
    if (!l) return;
    for (int i = 0; i < l->count; i++) {
        free(l->items[i].name);
        free(l->items[i].file);
    }
    free(l->items);
    *l = (struct object_list){0};
}

bool object_file_is_valid(const char *file)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./";
    const size_t length = strlen(file);
    if (length < 5 || length > MAX_WORD || strspn(file, letters) != length || strcmp(file + length - 4, ".obj"))
        return false;
    for (const char *part = file; part; part = strchr(part, '/')) {
        if (part != file) part++;
        if (!*part || *part == '.' || *part == '/' || *part == '-') return false;
    }
    return true;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status copy_word(char **to, struct textfile *t, const char *what, struct err *err)
{
    char word[MAX_WORD + 1];
    if (textfile_word_into(t, what, word, sizeof word, err)) return err->status;
    if (strchr(word, '\r')) return textfile_error(t, err, word, "%s without a line break", what);
    *to = strdup(word);
    return *to ? ST_OK : err_nomem(err, what, strlen(word) + 1);
}

static enum status read_matrix(double m[3][4], struct textfile *t, struct err *err)
{
    for (int i = 0; i < 12; i++)
        if (textfile_double(t, "a number of M", &m[i / 4][i % 4], err)) return err->status;
    const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return det > 0 && isfinite(det) ? ST_OK : textfile_wrong_number(t, det, "a matrix of determinant above 0", err);
}

static enum status read_names(const struct object_list *l, struct object *o, struct textfile *t, struct err *err)
{
    if (copy_word(&o->name, t, "a name", err)) return err->status;
    for (const struct object *other = l->items; other < o; other++)
        if (!strcmp(other->name, o->name)) return textfile_error(t, err, o->name, "a name that no line above has");
    if (copy_word(&o->file, t, "the path of a mesh", err)) return err->status;
    if (!object_file_is_valid(o->file))
        return textfile_error(t, err, o->file, "the path of a mesh in the scene's folder, FILE.obj");
    if (textfile_word_into(t, "the hash of the mesh", o->hash, sizeof o->hash, err)) return err->status;
    if (strlen(o->hash) != HASH_TEXT - 1 || strspn(o->hash, "0123456789abcdef") != HASH_TEXT - 1)
        return textfile_error(t, err, o->hash, "a hash of %d hexadecimal digits", HASH_TEXT - 1);
    return ST_OK;
}

static enum status read_object(struct object_list *l, struct textfile *t, struct err *err)
{
    if (textfile_expect(t, "object", err) ||
        array_append(&l->items, (size_t)l->count, sizeof *l->items, "objects", err))
        return err->status;
    struct object *o = &l->items[l->count++];
    *o = (struct object){0};
    if (read_names(l, o, t, err) || read_matrix(o->matrix, t, err) || gloss_read_brdf(&o->brdf, t, err))
        return err->status;
    return textfile_end(t, err);
}

enum status object_list_read(struct object_list *l, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *l = (struct object_list){0};
    product_open(&t, NULL, PRODUCT_OBJECTS, path, prov, err);
    while (!err->status && textfile_next(&t)) read_object(l, &t, err);
    textfile_release(&t);
    if (err->status) object_list_release(l);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status print_object(const struct object *o, FILE *to, struct err *err)
{
    char name[QUOTED_SIZE];
    if (textfile_quote(o->name, name, sizeof name, err)) return err->status;
    fprintf(to, "object %s %s %s", name, o->file, o->hash);
    for (int i = 0; i < 12; i++) fprintf(to, " %.17g", o->matrix[i / 4][i % 4]);
    fputc(' ', to);
    gloss_print_brdf(&o->brdf, to);
    fputc('\n', to);
    return ST_OK;
}

enum status object_list_write(const struct object_list *l, const char *path, const struct provenance *prov,
                              struct err *err)
{
    struct outfile f = {0};
    if (outfile_open(&f, path, err)) return err->status;
    const locale_t kept = uselocale(scan_c_locale());
    fprintf(f.fp, "%s\n", products[PRODUCT_OBJECTS].head);
    if (prov) provenance_print(prov, f.fp);
    for (int i = 0; !err->status && i < l->count; i++) print_object(&l->items[i], f.fp, err);
    uselocale(kept);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- meshes */

enum status object_mesh_read(struct obj_mesh *mesh, const struct object *o, const char *folder, struct err *err)
{
    char path[FILE_PATH], hash[HASH_TEXT];
    *mesh = (struct obj_mesh){0};
    if (file_path(path, folder, o->file, "", err) || hash_file(hash, path, err)) return err->status;
    if (strcmp(hash, o->hash))
        return err_set(err, ST_DATA, "%s has changed since the object %s was placed; make the model again.", path,
                       o->name);
    if (obj_mesh_read(mesh, path, err)) return err->status;
    obj_mesh_move(mesh, o->matrix);
    return ST_OK;
}
