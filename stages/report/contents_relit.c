/* contents_relit.c - reads the pictures of an edit under the light that it makes.
 *
 * Every relit view has a record, VIEW.txt: its exposure, and the shares of its pixels whose light changed, whose
 * quotient was bounded, and that were kept. Views are ranked by the share that changed, then by name; the first ones
 * are shown with the photograph, the edit under the old light, under the new light, and the ratio of the two. All
 * are exposed alike, by the record's exposure, or the light could not be compared by eye. Where the scene has a
 * truth, the true picture stands beside them.
 *
 * rounds.txt says how many rounds of light there were, whether they settled, and how much was still missing.
 *
 * A picture that cannot be read is left out with a note; the page is made all the same. */
#include "stages/report/contents_relit.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/capture/photo_list.h"
#include "common/texture/picture_record.h"
#include "stages/report/contents_parts.h"
#include "stages/report/passing.h"

struct view_record {
    char view[256];
    const char *photo;
    struct relit_record file;
};

struct relit_reading {
    struct relit_card *card;
    const struct relit_sources *from;
    char relit[FILE_PATH];       /* "relight/EDIT" */
    struct view_record *records; /* owned */
    int record_count;
};

static enum status note(struct relit_card *card, const struct err *problem, struct err *err)
{
    if (passing_refuse(problem->text, err)) return err->status;
    if (array_append(&card->notes, (size_t)card->note_count, sizeof *card->notes, "notes", err)) return err->status;
    snprintf(card->notes[card->note_count++], sizeof *card->notes, "a relit picture is left out: %.800s",
             problem->text);
    return ST_OK;
}

int relit_photo_orientation(const char *records, const char *photo)
{
    struct photo_record record = {0};
    struct err unknown = ERR_INIT; /* then the picture is upright as it is */
    const int orientation = photo_record_read(&record, records, photo, NULL, &unknown) ? 1 : record.info.orientation;
    photo_record_release(&record);
    return orientation < 1 ? 1 : orientation;
}

enum status relit_read_picture(struct picture *p, const char *folder, enum product_id id, const struct product_key *key,
                               int orientation, int height, struct err *err)
{
    struct photo photo = {0};
    char path[FILE_PATH];
    if (!product_path_below(path, folder, id, key, err)) photo_read(&photo, path, err);
    photo.info.orientation = orientation;
    if (!err->status) picture_from_photo(p, &photo, height, err);
    photo_release(&photo);
    return err->status;
}

enum status relit_read_radiance(struct picture *p, const char *folder, enum product_id id,
                                const struct product_key *key, double exposure, int orientation, int height,
                                struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image im = {0};
    char path[FILE_PATH];
    if (!product_path_below(path, folder, id, key, err)) exr_read(&im, path, names, 3, err);
    for (int k = 0; !err->status && k < im.count; k++)
        for (size_t i = 0; im.planes[k].f && i < (size_t)im.width * (size_t)im.height; i++)
            im.planes[k].f[i] *= (float)exposure;
    if (!err->status) picture_from_exr(p, &im, orientation, height, err);
    exr_image_release(&im);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- records */

static enum status read_number(struct textfile *t, const char *word, double max, double *value, struct err *err)
{
    if (textfile_expect_line(t, word, err) || textfile_number(t, word, 0, max, value, err)) return err->status;
    return textfile_end(t, err);
}

enum status relit_record_read(struct relit_record *r, const char *path, struct err *err)
{
    struct textfile t = {0};
    if (!product_open(&t, NULL, PRODUCT_RELIT_RECORD, path, NULL, err) && !textfile_expect_line(&t, "size", err) &&
        !read_number(&t, "exposure", 1e30, &r->exposure, err) && !read_number(&t, "changed", 100, &r->changed, err) &&
        !read_number(&t, "bounded", 100, &r->bounded, err))
        read_number(&t, "kept", 100, &r->kept, err);
    textfile_release(&t);
    return err->status;
}

static int is_record(const struct dirent *e)
{
    const char *dot = strrchr(e->d_name, '.');
    return e->d_name[0] != '.' && dot && !strcmp(dot, ".txt") && strcmp(e->d_name, "rounds.txt") != 0 &&
           strcmp(e->d_name, "objects.txt") != 0;
}

/* As of edits (contents_remodel.c): what changed and is sure, not limited because it was a guess. */
static double worth(const struct view_record *r)
{
    const double changed = r->file.changed, bounded = r->file.bounded;
    return changed > bounded ? (changed - bounded) * (changed - bounded) / changed : 0;
}

static int compare_records(const void *a, const void *b)
{
    const struct view_record *p = a, *q = b;
    if (worth(p) != worth(q)) return worth(p) < worth(q) ? 1 : -1;
    if (p->file.changed != q->file.changed) return p->file.changed < q->file.changed ? 1 : -1;
    return strcmp(p->view, q->view);
}

static enum status read_records(struct relit_reading *r, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    const int found = scandir(folder, &names, is_record, alphasort), count = found > 0 ? found : 0;
    if (found < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", folder);
    r->records = calloc((size_t)count + 1, sizeof *r->records);
    if (!r->records) err_nomem(err, "records of pictures", (size_t)count * sizeof *r->records);
    for (int i = 0; i < count; i++) {
        char path[FILE_PATH], *name = names[i]->d_name;
        struct err problem = ERR_INIT;
        struct view_record record = {.photo = NULL};
        if (!err->status) file_path(path, folder, name, "", err);
        snprintf(record.view, sizeof record.view, "%.*s", (int)(strlen(name) - strlen(".txt")), name);
        const int lens = lens_list_find(r->from->lenses, record.view);
        if (!err->status && relit_record_read(&record.file, path, &problem)) {
            note(r->card, &problem, err);
        } else if (!err->status && lens >= 0) { /* others are of cameras that somebody gave */
            record.photo = r->from->lenses->lenses[lens].photo;
            r->records[r->record_count++] = record;
        }
        free(names[i]);
    }
    free(names);
    if (!err->status && r->record_count)
        qsort(r->records, (size_t)r->record_count, sizeof *r->records, compare_records);
    return err->status;
}

static enum status read_round(struct relit_card *card, struct textfile *t, struct err *err)
{
    int64_t number;
    double change;
    char left[32];
    if (textfile_int(t, "a number", 1, INT_MAX, &number, err) || textfile_expect(t, "change", err) ||
        textfile_double(t, "a change", &change, err) || textfile_expect(t, "left", err) ||
        textfile_word_into(t, "what is left", left, sizeof left, err))
        return err->status;
    card->rounds = (int)number;
    if (!scan_double(left, &card->missing) || !(card->missing >= 0)) card->missing = -1;
    return ST_OK;
}

/* rounds.txt: what the rounds of light left. */
static enum status read_rounds(struct relit_reading *r, struct err *err)
{
    struct textfile t = {0};
    struct err problem = ERR_INIT;
    const struct product_key key = {.edit = r->card->name};
    char path[FILE_PATH], *word;
    r->card->missing = -1;
    if (!contents_product(path, r->from->folder, PRODUCT_LIGHT_ROUNDS, &key)) return ST_OK;
    product_open(&t, NULL, PRODUCT_LIGHT_ROUNDS, path, NULL, &problem);
    while (!problem.status && textfile_next(&t)) {
        if (textfile_word(&t, "a statement", &word, &problem)) break;
        if (!strcmp(word, "round"))
            read_round(r->card, &t, &problem);
        else if (!strcmp(word, "settled"))
            r->card->settled = !textfile_word(&t, "yes or no", &word, &problem) && !strcmp(word, "yes");
    }
    textfile_release(&t);
    return problem.status ? note(r->card, &problem, err) : ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- pictures */

static void sight_release(struct relit_sight *s)
{
    picture_release(&s->before);
    picture_release(&s->unlit);
    picture_release(&s->relit);
    picture_release(&s->ratio);
    picture_release(&s->truth);
}

static enum status read_truth(struct relit_sight *s, const struct relit_reading *r, const struct view_record *record,
                              int orientation, struct err *err)
{
    const struct product_key key = {.edit = r->card->name, .view = record->view};
    char path[FILE_PATH];
    if (!contents_product(path, r->from->folder, PRODUCT_TRUTH_RELIT, &key)) return ST_OK;
    return relit_read_radiance(&s->truth, r->from->folder, PRODUCT_TRUTH_RELIT, &key, record->file.exposure,
                               orientation, RELIT_SIDE_HEIGHT, err);
}

/* The picture in the old light. Where the edit changes no pixel, as under a lamp that is switched, none is written: it
 * is the photograph. */
static enum status read_unlit(struct picture *p, const char *folder, const struct product_key *key,
                              const struct picture_record *record, int orientation, struct err *err)
{
    if (record->changed > 0)
        return relit_read_picture(p, folder, PRODUCT_PICTURE_JPEG, key, orientation, RELIT_SIDE_HEIGHT, err);
    return relit_read_radiance(p, folder, PRODUCT_VIEW, key, record->exposure, orientation, RELIT_SIDE_HEIGHT, err);
}

static enum status read_sight(struct relit_sight *s, const struct relit_reading *r, const struct view_record *record,
                              struct err *err)
{
    const int orientation = relit_photo_orientation(r->from->records, record->photo), height = RELIT_SIDE_HEIGHT;
    const char *folder = r->from->folder;
    char unlit[FILE_PATH], path[FILE_PATH];
    const struct product_key key = {.view = record->view, .name = record->view, .pictures = unlit, .relit = r->relit};
    struct picture_record before; /* the photo is shown as the picture before it was relit */
    const struct relit_record *f = &record->file;
    *s = (struct relit_sight){.changed = f->changed, .bounded = f->bounded, .kept = f->kept};
    snprintf(s->view, sizeof s->view, "%s", record->view);
    snprintf(s->photo, sizeof s->photo, "%s", record->photo);
    if (!file_path(unlit, r->relit, "unlit", "", err) &&
        !product_path_below(path, folder, PRODUCT_PICTURE_RECORD, &key, err) &&
        !picture_record_read(&before, path, NULL, err))
        relit_read_radiance(&s->before, folder, PRODUCT_VIEW, &key, before.exposure, orientation, height, err);
    if (!err->status && !read_unlit(&s->unlit, folder, &key, &before, orientation, err) &&
        !relit_read_picture(&s->relit, folder, PRODUCT_RELIT_JPEG, &key, orientation, height, err) &&
        !relit_read_picture(&s->ratio, folder, PRODUCT_RELIT_RATIO_PICTURE, &key, orientation, height, err))
        read_truth(s, r, record, orientation, err);
    if (err->status) sight_release(s);
    return err->status;
}

static enum status read_sights(struct relit_reading *r, int most, struct err *err)
{
    struct relit_card *card = r->card;
    card->sights = calloc((size_t)most + 1, sizeof *card->sights);
    if (!card->sights) return err_nomem(err, "pictures", (size_t)most * sizeof *card->sights);
    for (int i = 0; !err->status && i < r->record_count && card->sight_count < most; i++) {
        const struct view_record *record = &r->records[i];
        struct err problem = ERR_INIT;
        bool shown = !(record->file.changed > 0);
        for (int k = 0; k < card->sight_count; k++) shown |= !strcmp(card->sights[k].photo, record->photo);
        if (shown) continue;
        if (read_sight(&card->sights[card->sight_count], r, record, &problem))
            note(card, &problem, err);
        else
            card->sight_count++;
    }
    return err->status;
}

enum status relit_card_read(struct relit_card *card, const struct relit_sources *from, const char *edit, int most,
                            struct err *err)
{
    struct relit_reading r = {.card = card, .from = from};
    char folder[FILE_PATH];
    snprintf(card->name, sizeof card->name, "%s", edit);
    if (!file_path(r.relit, "relight", edit, "", err) && !file_path(folder, from->folder, r.relit, "", err) &&
        path_is_folder(folder))
        read_records(&r, folder, err);
    card->views = r.record_count;
    if (!err->status && card->views && !read_rounds(&r, err)) read_sights(&r, most, err);
    free(r.records);
    return err->status;
}

enum status relit_rounds_read(struct relit_card *card, const struct relit_sources *from, const char *edit,
                              struct err *err)
{
    struct relit_reading r = {.card = card, .from = from};
    snprintf(card->name, sizeof card->name, "%s", edit);
    return read_rounds(&r, err);
}

void relit_card_release(struct relit_card *card)
{
    for (int k = 0; k < card->sight_count; k++) sight_release(&card->sights[k]);
    free(card->sights);
    free(card->notes);
    *card = (struct relit_card){.missing = -1};
}
