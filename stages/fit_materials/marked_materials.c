/* marked_materials.c - see marked_materials.h. */
#include "stages/fit_materials/marked_materials.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

void marked_materials_release(struct marked_materials *m)
{
    if (!m) return;
    material_list_release(&m->list);
    free(m->declared);
    *m = (struct marked_materials){0};
}

static enum status read_parts(struct material *material, bool *declared, struct textfile *t, struct err *err)
{
    while (textfile_more(t)) {
        char *word;
        if (textfile_word(t, "in or model", &word, err)) return err->status;
        if (!strcmp(word, "in")) {
            if (material_read_region(material, t, err)) return err->status;
        } else if (!strcmp(word, "model") && !*declared) {
            *declared = true;
            if (material_read_kind(&material->kind, t, err)) return err->status;
        } else {
            return textfile_error(t, err, word, *declared ? "in, and a region" : "in or model");
        }
    }
    return material->region_count ? ST_OK
                                  : textfile_error(t, err, NULL, "in VIEW X Y X Y X Y: a region of the material");
}

static enum status read_material(struct marked_materials *m, struct textfile *t, struct err *err)
{
    char name[64];
    struct material *material = NULL;
    if (textfile_expect(t, "material", err) || textfile_word_into(t, "a name", name, sizeof name, err))
        return err->status;
    if (strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") != strlen(name))
        return textfile_error(t, err, name, "a name of letters, digits, _ and -");
    if (array_append(&m->declared, (size_t)m->list.count, sizeof *m->declared, "materials", err) ||
        material_list_add(&material, &m->list, name, t, err))
        return err->status;
    m->declared[m->list.count - 1] = false;
    return read_parts(material, &m->declared[m->list.count - 1], t, err);
}

enum status marked_materials_read(struct marked_materials *m, const char *path, struct provenance *prov,
                                  struct err *err)
{
    struct textfile t = {0};
    int64_t version;
    *m = (struct marked_materials){0};
    if (!provenance_open(prov, "materials.txt", &t, path, err) &&
        !textfile_expect_line(&t, "remodel-marked-materials", err) &&
        !textfile_int(&t, "the version", 1, 1, &version, err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_material(m, &t, err);
    if (!err->status && !m->list.count) textfile_error(&t, err, NULL, "a line `material NAME in VIEW X Y X Y X Y`");
    textfile_release(&t);
    if (err->status) marked_materials_release(m);
    return err->status;
}
