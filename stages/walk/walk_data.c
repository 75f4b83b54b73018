/* walk_data.c - see walk_data.h. */
#include "stages/walk/walk_data.h"

#include <stdio.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/product/product.h"
#include "common/texture/outdoors.h"
#include "stages/walk/atlas_texture.h"
#include "stages/walk/data_file.h"
#include "stages/walk/light_texture.h"
#include "stages/walk/scene_text.h"
#include "stages/walk/view_texture.h"

struct data_job {
    const struct walk_scene *s;
    struct pane_fronts panes;
    struct atlas_page *vita; /* owned */
    struct provenance *prov;
    int64_t *bytes;
};

static enum status read_vita(struct data_job *j, struct err *err)
{
    const struct atlas *a = &j->s->vita;
    j->vita = calloc((size_t)a->page_count + 1, sizeof *j->vita);
    if (!j->vita) err_nomem(err, "pages", (size_t)a->page_count * sizeof *j->vita);
    for (int i = 0; !err->status && i < a->page_count; i++)
        atlas_page_read(&j->vita[i], a, i, j->s->files->vita, j->prov, err);
    return err->status;
}

static enum status write_scene(const struct data_job *j, struct err *err)
{
    struct data_file f;
    if (!data_file_open(&f, j->s->files->out, "scene", err) && !scene_text_write(f.fp, j->s, j->vita, err))
        data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    return err->status;
}

/* Changes the pages of the VITA: the last to use them. */
static enum status write_vita(struct data_job *j, struct err *err)
{
    struct data_file f;
    if (data_file_open(&f, j->s->files->out, "vita", err)) return err->status;
    putc('[', f.fp);
    for (int i = 0; !err->status && i < j->s->vita.page_count; i++) {
        if (i) fputs(",\n", f.fp);
        atlas_texture_write(f.fp, &j->s->vita, &j->vita[i], i, j->s->exposure, j->s->params, err);
    }
    putc(']', f.fp);
    if (!err->status) data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    return err->status;
}

static enum status write_outdoors(const struct data_job *j, struct err *err)
{
    struct outdoors o = {0};
    struct image im = {0};
    struct data_file f = {0};
    unsigned char *alpha = NULL, *rgba = NULL;
    if (outdoors_read(&o, j->s->files->outdoors, j->prov, err)) return err->status;
    const size_t pixels = (size_t)o.width * (size_t)o.height;
    if (!(alpha = malloc(pixels + 1))) err_nomem(err, "a picture", pixels);
    if (!err->status && !image_init(&im, o.width, o.height, 3, err))
        for (size_t i = 0; i < pixels; i++) {
            alpha[i] = o.source[i] == OUTDOORS_GUESSED ? ALPHA_SYNTHESISED : ALPHA_ORIGINAL;
            for (size_t c = 0; c < 3; c++) im.data[3 * i + c] = (float)(j->s->exposure * (double)o.rgb[3 * i + c]);
        }
    if (!err->status && !atlas_texture_bytes(&rgba, &im, alpha, err) &&
        !data_file_open(&f, j->s->files->out, "outdoors", err) &&
        !atlas_texture_encode(f.fp, rgba, o.width, o.height, j->s->params->texture_quality, j->s->params->effort, err))
        data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    image_release(&im);
    outdoors_release(&o);
    free(alpha);
    free(rgba);
    return err->status;
}

/* "KIND-OF" */
static enum status join(char name[FILE_PATH], const char *kind, const char *of, struct err *err)
{
    const int length = snprintf(name, FILE_PATH, "%s-%s", kind, of);
    return length < FILE_PATH ? ST_OK : err_set(err, ST_IO, "%s-%.80s...: the name is too long.", kind, of);
}

static enum status open_of_photo(struct data_file *f, const struct walk_scene *s, const char *kind, const char *photo,
                                 struct err *err)
{
    char name[FILE_PATH];
    return join(name, kind, photo, err) ? err->status : data_file_open(f, s->files->out, name, err);
}

static enum status write_atlas(const struct data_job *j, const struct walk_viewpoint *p, struct err *err)
{
    char folder[FILE_PATH];
    struct data_file f = {0};
    if (file_path(folder, j->s->files->vdta, p->photo, "", err) || open_of_photo(&f, j->s, "texture", p->photo, err))
        return err->status;
    putc('[', f.fp);
    for (int i = 0; !err->status && i < p->atlas.page_count; i++) {
        struct atlas_page page = {0};
        if (i) fputs(",\n", f.fp);
        if (!atlas_page_read(&page, &p->atlas, i, folder, j->prov, err))
            atlas_texture_write(f.fp, &p->atlas, &page, i, j->s->exposure, j->s->params, err);
        atlas_page_release(&page);
    }
    putc(']', f.fp);
    if (!err->status) data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    return err->status;
}

static enum status write_photo(const struct data_job *j, const struct walk_viewpoint *p, struct err *err)
{
    struct data_file f = {0};
    if (open_of_photo(&f, j->s, "photo", p->photo, err)) return err->status;
    putc('[', f.fp);
    for (int i = 0; !err->status && i < p->count; i++) {
        if (i) fputs(",\n", f.fp);
        view_texture_write(f.fp, j->s, p->first + i, &j->panes, err);
    }
    putc(']', f.fp);
    if (!err->status) data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    return err->status;
}

/* Whether a picture stands; false is no error. */
static bool find_picture(char path[FILE_PATH], const char *folder, enum product_id id, const char *view,
                         struct err *err)
{
    return !product_path_in(path, folder, id, &(struct product_key){.name = view}, err) && path_is_file(path);
}

/* The pictures of an edit from a photo's views; folder: of those that `make remodel` drew, or of the relit ones. A
 * photo without any gets no file. */
static enum status write_changes(const struct data_job *j, const struct walk_viewpoint *p, const char *kind,
                                 const char *folder, bool relit, bool *any, struct err *err)
{
    const struct walk_scene *s = j->s;
    const enum product_id id = relit ? PRODUCT_RELIT_JPEG : PRODUCT_PICTURE_JPEG;
    char jpeg[FILE_PATH], sources[FILE_PATH];
    struct data_file f = {0};
    bool *found = calloc((size_t)p->count + 1, sizeof *found); /* looked for once, so that all of this says the same */
    *any = false;
    if (!found) return err_nomem(err, "pictures of a photo", (size_t)p->count);
    for (int i = 0; i < p->count; i++) {
        const char *view = s->cameras[p->first + i].name;
        found[i] = find_picture(jpeg, folder, id, view, err) &&
                   (relit || find_picture(sources, folder, PRODUCT_PICTURE_SOURCES, view, err));
        *any |= found[i];
    }
    if (!*any || err->status || open_of_photo(&f, s, kind, p->photo, err)) {
        free(found);
        return err->status;
    }
    putc('[', f.fp);
    for (int i = 0; !err->status && i < p->count; i++) {
        const char *view = s->cameras[p->first + i].name;
        if (i) fputs(",\n", f.fp);
        if (!found[i] || product_path_in(jpeg, folder, id, &(struct product_key){.name = view}, err))
            fputs("null", f.fp);
        else if (relit)
            view_texture_write_change(f.fp, s, p->first + i, jpeg, NULL, err);
        else if (!product_path_in(sources, folder, PRODUCT_PICTURE_SOURCES, &(struct product_key){.name = view}, err))
            view_texture_write_change(f.fp, s, p->first + i, jpeg, sources, err);
    }
    putc(']', f.fp);
    if (!err->status) data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    free(found);
    return err->status;
}

static enum status write_edit_pictures(const struct data_job *j, const struct walk_model *m, FILE *list,
                                       struct err *err)
{
    const struct walk_scene *s = j->s;
    char edit[FILE_PATH], pictures[FILE_PATH], relit[FILE_PATH] = "", kind[FILE_PATH];
    bool any;
    if (file_path(edit, s->files->remodel, m->edit, "", err) || file_path(pictures, edit, "pictures", "", err) ||
        (s->files->relight && file_path(relit, s->files->relight, m->edit, "", err)))
        return err->status;
    for (int i = 0; !err->status && i < s->place_count; i++) {
        if (join(kind, "edit", m->edit, err)) break;
        if (!write_changes(j, &s->places[i], kind, pictures, false, &any, err) && any)
            fprintf(list, ",\n\"%s-%s\"", kind, s->places[i].photo);
        if (err->status || !*relit || join(kind, "light", m->edit, err)) continue;
        if (!write_changes(j, &s->places[i], kind, relit, true, &any, err) && any)
            fprintf(list, ",\n\"%s-%s\"", kind, s->places[i].photo);
    }
    return err->status;
}

static enum status write_light(const struct data_job *j, const struct walk_model *m, struct err *err)
{
    struct data_file f = {0};
    if (!open_of_photo(&f, j->s, "relit", m->edit, err) && !light_texture_write(f.fp, j->s, m, j->vita, j->prov, err))
        data_file_commit(&f, j->bytes, err);
    data_file_discard(&f);
    return err->status;
}

/* All edits, and the list of their pictures. */
static enum status write_edits(const struct data_job *j, struct err *err)
{
    struct data_file list = {0};
    if (data_file_open(&list, j->s->files->out, "pictures", err)) return err->status;
    fputs("[\"\"", list.fp);
    for (int i = 1; !err->status && i < j->s->model_count; i++) {
        write_edit_pictures(j, &j->s->models[i], list.fp, err);
        if (!err->status && j->s->models[i].relit) write_light(j, &j->s->models[i], err);
    }
    putc(']', list.fp);
    if (!err->status) data_file_commit(&list, j->bytes, err);
    data_file_discard(&list);
    return err->status;
}

enum status walk_data_write(const struct walk_scene *s, struct provenance *prov, int64_t *bytes, struct err *err)
{
    struct data_job j = {.s = s, .prov = prov, .bytes = bytes};
    struct progress progress;
    pane_fronts_find(&j.panes, &s->models[0].rays.mesh, err);
    if (!err->status && !read_vita(&j, err) && !write_scene(&j, err) && !write_edits(&j, err)) write_vita(&j, err);
    if (!err->status && s->files->outdoors) write_outdoors(&j, err);
    progress_start(&progress, "packing", s->place_count, "photos");
    for (int i = 0; !err->status && i < s->place_count; i++) {
        if (!write_atlas(&j, &s->places[i], err)) write_photo(&j, &s->places[i], err);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    for (int i = 0; j.vita && i < s->vita.page_count; i++) atlas_page_release(&j.vita[i]);
    free(j.vita);
    pane_fronts_release(&j.panes);
    return err->status;
}
