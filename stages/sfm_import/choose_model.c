/* choose_model.c - which of several models is used, and whether it still belongs to the photos. */
#include "stages/sfm_import/choose_model.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/textfile.h"
#include "common/capture/photo_match.h"
#include "common/product/product.h"
#include "stages/sfm_import/name_lines.h"

static int images_of_photos(const struct sfm_model *m, const struct photo_list *photos)
{
    int n = 0;
    for (int i = 0; i < m->image_count; i++) n += photo_list_match(photos, m->images[i].name) >= 0;
    return n;
}

/* Version 1 does not say what was given; then nothing is taken for found. */
static enum status read_given(enum given_cameras *given, struct textfile *t, int version, struct err *err)
{
    static const char *const words[] = {[GIVEN_NOTHING] = "nothing", [GIVEN_LENS] = "lens", [GIVEN_MODEL] = "model"};
    char *word = NULL;
    *given = GIVEN_MODEL;
    if (version < 2) return ST_OK;
    if (textfile_word(t, "what was given", &word, err)) return err->status;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(word, words[i])) {
            *given = (enum given_cameras)i;
            return ST_OK;
        }
    return textfile_error(t, err, word, "\"nothing\", \"lens\" or \"model\"");
}

/* A line "FOLDER FORMAT [GIVEN]" of models.txt, and the model. *folder points into the text file. */
static enum status read_model(struct sfm_model *m, char **folder, enum given_cameras *given, struct textfile *t,
                              int version, const char *sfm, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH], *format = NULL;
    if (textfile_word(t, "folder of a model", folder, err) || textfile_word(t, "its format", &format, err) ||
        read_given(given, t, version, err) || textfile_end(t, err))
        return err->status;
    if (strcmp(format, "colmap")) return textfile_error(t, err, format, "\"colmap\"");
    return file_path(path, sfm, *folder, "", err) || sfm_model_read_text(m, path, prov, err) ? err->status : ST_OK;
}

enum status import_choose(struct sfm_model *model, char **name, enum given_cameras *given, const char *sfm,
                          const struct photo_list *photos, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    struct provenance chosen = {0};
    int version = 0;
    char path[FILE_PATH];
    int count = 0, best = -1;
    *model = (struct sfm_model){0};
    *name = NULL;
    if (!product_path_in(path, sfm, PRODUCT_SFM_MODELS, NULL, err))
        product_open(&t, &version, PRODUCT_SFM_MODELS, path, NULL, err);
    while (!err->status && textfile_next(&t)) {
        struct sfm_model m = {0};
        struct provenance files = {0};
        char *folder = NULL;
        enum given_cameras what = GIVEN_MODEL;
        if (read_model(&m, &folder, &what, &t, version, sfm, &files, err)) {
            provenance_release(&files);
            break;
        }
        int n = images_of_photos(&m, photos);
        log_note("model %s: %d images, %d of them photos of this scene, %d points", folder, m.image_count, n,
                 m.point_count);
        count++;
        if (n > best || (n == best && m.point_count > model->point_count)) {
            sfm_model_release(model);
            free(*name);
            provenance_release(&chosen);
            *model = m;
            chosen = files;
            *given = what;
            best = n;
            if (!(*name = strdup(folder))) err_nomem(err, "a name", strlen(folder) + 1);
        } else {
            sfm_model_release(&m);
            provenance_release(&files);
        }
    }
    if (!err->status && !count) textfile_error(&t, err, NULL, "a line for each model");
    if (!err->status && count > 1) log_note("model %s is the largest of %d; only this one is used", *name, count);
    textfile_release(&t);
    if (!err->status && prov) provenance_add_all(prov, &chosen, err);
    provenance_release(&chosen);
    if (err->status) {
        sfm_model_release(model);
        free(*name);
        *name = NULL;
    }
    return err->status;
}

enum status import_check_photos(const char *sfm, const struct photo_list *photos, struct err *err)
{
    struct textfile t = {0};
    struct name_lines changed = {.heading = "changed since structure from motion ran"};
    struct name_lines added = {.heading = "new since structure from motion ran"};
    bool any = false;
    char path[FILE_PATH], *seen = calloc((size_t)photos->count + 1, 1);
    if (seen)
        product_path_in(path, sfm, PRODUCT_SFM_PHOTOS, NULL, err);
    else
        err_nomem(err, "marks", (size_t)photos->count);
    if (!err->status) product_open(&t, NULL, PRODUCT_SFM_PHOTOS, path, NULL, err);
    while (!err->status && textfile_next(&t)) {
        char *id = NULL, *hash = NULL;
        if (!textfile_word(&t, "id of a photo", &id, err) && !textfile_word(&t, "hash of a photo", &hash, err))
            textfile_end(&t, err);
        int at = err->status ? -1 : photo_list_find_id(photos, id);
        if (at < 0) continue;
        seen[at] = 1;
        if (!strcmp(hash, photos->photos[at].hash)) continue;
        name_lines_add(&changed, photos->photos[at].file);
        any = true;
    }
    for (int i = 0; !err->status && i < photos->count; i++)
        if (!seen[i]) {
            name_lines_add(&added, photos->photos[i].file);
            any = true;
        }
    if (!err->status) {
        if (any) log_warn("the photos have changed since their cameras were given (SFM): see that these still hold");
        name_lines_end(&changed);
        name_lines_end(&added);
    }
    textfile_release(&t);
    free(seen);
    return err->status;
}
