/* contents_remodel.c - reads the pictures of edits (docs/formats.md, O/remodel/E/pictures).
 *
 * Which views are shown. An edit changes little in most views, and most where least is known: behind what it takes
 * away. So views are ranked by what changed and is known, not guessed, times the share of this in what changed, times
 * the share of the picture that is not empty, since a view that looks past the photo's border shows less. Views of
 * which all is guessed come last, those that change most first. Of each photograph the best view is taken.
 * Views that the edit does not change are counted only.
 *
 * A sight has the photograph, the picture after the edit, and the origin of its pixels in colours, all of one size
 * and exposure, so that the page can lay them over each other.
 *
 * The sentence about an edit is the comment at the beginning of its script. Plans, models and films are linked where
 * they exist; for what does not, the page says which goal of make makes it.
 *
 * A picture that cannot be read becomes a note. */
#include "stages/report/contents_remodel.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/textfile.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "common/texture/picture_record.h"
#include "stages/report/contents_parts.h"

struct record {
    char view[256], photo[256];
    struct picture_record file; /* VIEW.txt */
};

struct reading {
    struct remodel_contents *c;
    const struct remodel_sources *from;
    struct lens_list lenses;
    struct record *records; /* of the edit that is being read; owned */
    int record_count;
};

static enum status note(struct remodel_contents *c, const char *what, const struct err *problem, struct err *err)
{
    if (array_append(&c->notes, (size_t)c->note_count, sizeof *c->notes, "notes", err)) return err->status;
    snprintf(c->notes[c->note_count++], sizeof *c->notes, "%.100s: %.800s", what, problem->text);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- records */

static int is_record(const struct dirent *e)
{
    const char *dot = strrchr(e->d_name, '.');
    return e->d_name[0] != '.' && dot && !strcmp(dot, ".txt");
}

static double newly_shown(const struct record *r) { return r->file.changed * (100 - r->file.shares[MADE_NOTHING]); }

static double worth(const struct record *r)
{
    const double changed = r->file.changed, guessed = r->file.shares[MADE_SYNTHESISED] + r->file.shares[MADE_UNSURE];
    const double known = changed > guessed ? (changed - guessed) / changed : 0;
    return known * known * newly_shown(r);
}

/* The best first, then by name. */
static int compare_records(const void *a, const void *b)
{
    const struct record *p = a, *q = b;
    if (worth(p) != worth(q)) return worth(p) < worth(q) ? 1 : -1;
    if (newly_shown(p) != newly_shown(q)) return newly_shown(p) < newly_shown(q) ? 1 : -1;
    return strcmp(p->view, q->view);
}

static enum status read_records(struct reading *r, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    const int found = scandir(folder, &names, is_record, alphasort), count = found > 0 ? found : 0;
    free(r->records);
    r->record_count = 0;
    r->records = calloc((size_t)count + 1, sizeof *r->records);
    if (!r->records) err_nomem(err, "records of pictures", (size_t)count * sizeof *r->records);
    for (int i = 0; i < count; i++) {
        char path[FILE_PATH], *name = names[i]->d_name;
        struct err problem = ERR_INIT;
        struct record record;
        if (!err->status) file_path(path, folder, name, "", err);
        if (!err->status && picture_record_read(&record.file, path, NULL, &problem)) {
            note(r->c, "a picture is left out", &problem, err);
        } else if (!err->status) {
            snprintf(record.view, sizeof record.view, "%.*s", (int)(strlen(name) - strlen(".txt")), name);
            const int lens = lens_list_find(&r->lenses, record.view);
            snprintf(record.photo, sizeof record.photo, "%s", lens < 0 ? record.view : r->lenses.lenses[lens].photo);
            r->records[r->record_count++] = record;
        }
        free(names[i]);
    }
    free(names);
    if (!err->status && r->record_count)
        qsort(r->records, (size_t)r->record_count, sizeof *r->records, compare_records);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- pictures */

static void sight_release(struct edit_sight *s)
{
    picture_release(&s->before);
    picture_release(&s->after);
    picture_release(&s->sources);
}

static enum status read_sight(struct edit_sight *s, const struct reading *r, const struct record *record,
                              const char *pictures, struct err *err)
{
    const int orientation = relit_photo_orientation(r->from->records, record->photo), height = SIGHT_SIDE_HEIGHT;
    const char *scene = r->from->folder;
    const struct product_key key = {.view = record->view, .name = record->view, .pictures = pictures};
    *s = (struct edit_sight){.changed = record->file.changed};
    memcpy(s->view, record->view, sizeof s->view);
    memcpy(s->photo, record->photo, sizeof s->photo);
    memcpy(s->shares, record->file.shares, sizeof s->shares);
    if (relit_read_radiance(&s->before, scene, PRODUCT_VIEW, &key, record->file.exposure, orientation, height, err) ||
        relit_read_picture(&s->after, scene, PRODUCT_PICTURE_JPEG, &key, orientation, height, err) ||
        relit_read_picture(&s->sources, scene, PRODUCT_PICTURE_SOURCES, &key, orientation, height, err))
        sight_release(s);
    return err->status;
}

/* The views that the edit changes most, each of another photo. */
static enum status read_sights(struct edit_card *card, struct reading *r, const char *pictures, struct err *err)
{
    card->sights = calloc(SIGHTS_SHOWN, sizeof *card->sights);
    if (!card->sights) return err_nomem(err, "pictures", SIGHTS_SHOWN * sizeof *card->sights);
    card->views = r->record_count;
    for (int i = 0; !err->status && i < r->record_count; i++) {
        const struct record *record = &r->records[i];
        struct err problem = ERR_INIT;
        bool shown = card->sight_count == SIGHTS_SHOWN;
        if (record->file.changed <= 0) break;
        card->changed++;
        for (int k = 0; k < card->sight_count; k++) shown |= !strcmp(card->sights[k].photo, record->photo);
        if (shown) continue;
        if (read_sight(&card->sights[card->sight_count], r, record, pictures, &problem))
            note(r->c, "a picture is left out", &problem, err);
        else
            card->sight_count++;
    }
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ edits */

/* The comment at the beginning of a script, in one line. */
static enum status read_about(char **about, const char *scripts, const char *edit, struct err *err)
{
    char path[FILE_PATH], text[2048] = "";
    struct textfile t = {0};
    struct err none = ERR_INIT; /* an edit without a script has no comment */
    bool begun = false;
    if (scripts && !file_path(path, scripts, edit, ".txt", &none) && !textfile_open(&t, path, &none)) {
        while (textfile_next_raw(&t)) {
            const char *line = t.cursor + strspn(t.cursor, " \t");
            if (*line != '#' && begun) break;
            if (*line != '#') continue;
            begun = true;
            line += strspn(line, "# \t");
            const size_t length = strlen(text);
            snprintf(text + length, sizeof text - length, "%s%s", length ? " " : "", line);
        }
        textfile_release(&t);
    }
    *about = strdup(text);
    return *about ? ST_OK : err_nomem(err, "a comment", strlen(text));
}

/* The edit under the light that it makes; what cannot be read of it is a note of the page. */
static enum status read_relit(struct edit_card *card, struct reading *r, struct err *err)
{
    const struct relit_sources from = {r->from->folder, r->from->records, &r->lenses};
    relit_card_read(&card->relit, &from, card->name, RELIT_SHOWN, err);
    for (int i = 0; !err->status && i < card->relit.note_count; i++) {
        struct err problem = ERR_INIT;
        err_set(&problem, ST_DATA, "%s", card->relit.notes[i]);
        note(r->c, "light", &problem, err);
    }
    return err->status;
}

#define EXPORT_PRODUCT(format, file, name, write) PRODUCT_EXPORT_##format,
static const enum product_id exports[] = {EXPORTS(EXPORT_PRODUCT)};

static enum status read_edit(struct reading *r, const char *name, struct err *err)
{
    struct remodel_contents *c = r->c;
    char model[FILE_PATH], pictures[FILE_PATH], film[FILE_PATH], path[FILE_PATH];
    const char *scene = r->from->folder;
    const struct product_key key = {.model = model, .film = film};
    if (file_path(model, "remodel", name, "", err) || file_path(pictures, model, "pictures", "", err) ||
        file_path(film, model, "tour", "", err))
        return err->status;
    if (!contents_product(path, scene, PRODUCT_MODEL, &key)) return ST_OK;
    if (file_path(path, scene, pictures, "", err) || read_records(r, path, err)) return err->status;
    if (array_append(&c->edits, (size_t)c->edit_count, sizeof *c->edits, "edits", err)) return err->status;
    struct edit_card *card = &c->edits[c->edit_count++];
    *card = (struct edit_card){.plan = contents_product_name(scene, PRODUCT_PLAN_PICTURE, &key),
                               .film = contents_product(path, scene, PRODUCT_VIDEO, &key)};
    for (int i = 0; i < EXPORT_COUNT; i++)
        card->exported |= card->exports[i] = contents_product(path, scene, exports[i], &key);
    snprintf(card->name, sizeof card->name, "%s", name);
    return read_about(&card->about, r->from->scripts, name, err) || read_sights(card, r, pictures, err) ||
                   read_relit(card, r, err)
               ? err->status
               : ST_OK;
}

enum status remodel_contents_read(struct remodel_contents *c, const struct remodel_sources *from, struct err *err)
{
    struct reading r = {.c = c, .from = from};
    struct dirent **names = NULL;
    const struct product_key key = {.film = "model/tour"};
    char path[FILE_PATH];
    c->quality = from->quality;
    if (!product_path_below(path, from->folder, PRODUCT_LENSES, NULL, err) &&
        !lens_list_read(&r.lenses, path, NULL, err)) {
        c->plan = contents_product_name(from->folder, PRODUCT_PLAN_PICTURE, &key);
        c->film = contents_product(path, from->folder, PRODUCT_VIDEO, &key);
        file_path(path, from->folder, "remodel", "", err);
    }
    const int count = err->status ? 0 : scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        if (!err->status && names[i]->d_name[0] != '.') read_edit(&r, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    free(r.records);
    lens_list_release(&r.lenses);
    return err->status;
}

void remodel_contents_release(struct remodel_contents *c)
{
    for (int i = 0; i < c->edit_count; i++) {
        struct edit_card *card = &c->edits[i];
        for (int k = 0; k < card->sight_count; k++) sight_release(&card->sights[k]);
        relit_card_release(&card->relit);
        free(card->sights);
        free(card->about);
        free(card->plan);
    }
    free(c->edits);
    free(c->notes);
    free(c->plan);
    *c = (struct remodel_contents){0};
}
