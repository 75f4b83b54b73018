/* contents_remodel.c - reads the pictures of edits (docs/formats.md, O/remodel/E/pictures).
 *
 * Which views are shown. An edit changes little in most views. Views are ranked by the share of the picture that
 * changed times the share that is not empty, since a view that looks past the photo's border shows less; of each
 * photograph the best view is taken. Views that the edit does not change are counted only.
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

/* What is changed, less where the view looks past the photo's border. */
static double worth(const struct record *r) { return r->file.changed * (100 - r->file.shares[MADE_NOTHING]); }

/* The best first, then by name. */
static int compare_records(const void *a, const void *b)
{
    const struct record *p = a, *q = b;
    if (worth(p) != worth(q)) return worth(p) < worth(q) ? 1 : -1;
    return strcmp(p->view, q->view);
}

static enum status read_records(struct reading *r, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    const int found = scandir(folder, &names, is_record, alphasort), count = found > 0 ? found : 0;
    enum status st = ST_OK;
    free(r->records);
    r->record_count = 0;
    r->records = calloc((size_t)count + 1, sizeof *r->records);
    if (!r->records) st = err_nomem(err, "records of pictures", (size_t)count * sizeof *r->records);
    for (int i = 0; i < count; i++) {
        char path[FILE_PATH], *name = names[i]->d_name;
        struct err problem = ERR_INIT;
        struct record record;
        if (!st) st = file_path(path, folder, name, "", err);
        if (!st && picture_record_read(&record.file, path, NULL, &problem)) {
            st = note(r->c, "a picture is left out", &problem, err);
        } else if (!st) {
            snprintf(record.view, sizeof record.view, "%.*s", (int)(strlen(name) - strlen(".txt")), name);
            const int lens = lens_list_find(&r->lenses, record.view);
            snprintf(record.photo, sizeof record.photo, "%s", lens < 0 ? record.view : r->lenses.lenses[lens].photo);
            r->records[r->record_count++] = record;
        }
        free(names[i]);
    }
    free(names);
    if (!st && r->record_count) qsort(r->records, (size_t)r->record_count, sizeof *r->records, compare_records);
    return st;
}

/* --------------------------------------------------------------------------------------------------------- pictures */

static void sight_release(struct edit_sight *s)
{
    picture_release(&s->before);
    picture_release(&s->after);
    picture_release(&s->sources);
}

static enum status read_sight(struct edit_sight *s, const struct reading *r, const struct record *record,
                              const char *folder, struct err *err)
{
    const int orientation = relit_photo_orientation(r->from->records, record->photo);
    char views[FILE_PATH];
    *s = (struct edit_sight){.changed = record->file.changed};
    memcpy(s->view, record->view, sizeof s->view);
    memcpy(s->photo, record->photo, sizeof s->photo);
    memcpy(s->shares, record->file.shares, sizeof s->shares);
    enum status st = file_path(views, r->from->folder, "views", "", err);
    if (!st)
        st = relit_read_radiance(&s->before, views, record->view, record->file.exposure, orientation, SIGHT_SIDE_HEIGHT,
                                 err);
    if (!st) st = relit_read_picture(&s->after, folder, record->view, ".jpg", orientation, SIGHT_SIDE_HEIGHT, err);
    if (!st)
        st = relit_read_picture(&s->sources, folder, record->view, "-sources.png", orientation, SIGHT_SIDE_HEIGHT, err);
    if (st) sight_release(s);
    return st;
}

/* The views that the edit changes most, each of another photo. */
static enum status read_sights(struct edit_card *card, struct reading *r, const char *folder, struct err *err)
{
    enum status st = ST_OK;
    card->sights = calloc(SIGHTS_SHOWN, sizeof *card->sights);
    if (!card->sights) return err_nomem(err, "pictures", SIGHTS_SHOWN * sizeof *card->sights);
    card->views = r->record_count;
    for (int i = 0; !st && i < r->record_count; i++) {
        const struct record *record = &r->records[i];
        struct err problem = ERR_INIT;
        bool shown = card->sight_count == SIGHTS_SHOWN;
        if (record->file.changed <= 0) break;
        card->changed++;
        for (int k = 0; k < card->sight_count; k++) shown |= !strcmp(card->sights[k].photo, record->photo);
        if (shown) continue;
        if (read_sight(&card->sights[card->sight_count], r, record, folder, &problem))
            st = note(r->c, "a picture is left out", &problem, err);
        else
            card->sight_count++;
    }
    return st;
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

static bool has_file(const char *folder, const char *file)
{
    char path[FILE_PATH];
    struct err none = ERR_INIT;
    return !file_path(path, folder, file, "", &none) && path_is_file(path);
}

static char *file_if_there(const char *folder, const char *file)
{
    char path[FILE_PATH];
    struct err none = ERR_INIT;
    return !file_path(path, folder, file, "", &none) && path_is_file(path) ? strdup(path) : NULL;
}

/* The edit under the light that it makes; what cannot be read of it is a note of the page. */
static enum status read_relit(struct edit_card *card, struct reading *r, struct err *err)
{
    const struct relit_sources from = {r->from->folder, r->from->records, &r->lenses};
    enum status st = relit_card_read(&card->relit, &from, card->name, RELIT_SHOWN, err);
    for (int i = 0; !st && i < card->relit.note_count; i++) {
        struct err problem = ERR_INIT;
        err_set(&problem, ST_DATA, "%s", card->relit.notes[i]);
        st = note(r->c, "light", &problem, err);
    }
    return st;
}

#define EXPORT_FILE(format, file, name, write) "export/" file,
static const char *const exports[] = {EXPORTS(EXPORT_FILE)};

static enum status read_edit(struct reading *r, const char *name, struct err *err)
{
    struct remodel_contents *c = r->c;
    char remodel[FILE_PATH], folder[FILE_PATH], pictures[FILE_PATH];
    enum status st = file_path(remodel, r->from->folder, "remodel", "", err);
    if (!st) st = file_path(folder, remodel, name, "", err);
    if (!st) st = file_path(pictures, folder, "pictures", "", err);
    if (st || !has_file(folder, "model.txt")) return st;
    if (read_records(r, pictures, err)) return err->status;
    if (array_append(&c->edits, (size_t)c->edit_count, sizeof *c->edits, "edits", err)) return err->status;
    struct edit_card *card = &c->edits[c->edit_count++];
    *card = (struct edit_card){.plan = file_if_there(folder, "plan.svg"), .film = has_file(folder, "tour/video.mp4")};
    for (int i = 0; i < EXPORT_COUNT; i++) card->exported |= card->exports[i] = has_file(folder, exports[i]);
    snprintf(card->name, sizeof card->name, "%s", name);
    st = read_about(&card->about, r->from->scripts, name, err);
    if (!st) st = read_sights(card, r, pictures, err);
    return st ? st : read_relit(card, r, err);
}

enum status remodel_contents_read(struct remodel_contents *c, const struct remodel_sources *from, struct err *err)
{
    struct reading r = {.c = c, .from = from};
    struct dirent **names = NULL;
    char model[FILE_PATH], path[FILE_PATH];
    enum status st = file_path(path, from->folder, "views/lenses.txt", "", err);
    if (!st) st = lens_list_read(&r.lenses, path, NULL, err);
    if (!st) st = file_path(model, from->folder, "model", "", err);
    if (!st) c->plan = file_if_there(model, "plan.svg");
    if (!st) c->film = has_file(model, "tour/video.mp4");
    if (!st) st = file_path(path, from->folder, "remodel", "", err);
    const int count = st ? 0 : scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        if (!st && names[i]->d_name[0] != '.') st = read_edit(&r, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    free(r.records);
    lens_list_release(&r.lenses);
    return st;
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
