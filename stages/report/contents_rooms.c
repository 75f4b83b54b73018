/* contents_rooms.c - reads what the photographs show after each change.
 *
 * Of each view and each change there may be a record of the picture in the old light (O/remodel/E/pictures) and one of
 * the picture in the new light (O/relight/E). They are read first, since they say how much of a view changes and how
 * much of that is known; from them follow the photos that are shown, and then their pictures are made. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"
#include "stages/report/contents_parts.h"
#include "stages/report/rooms_parts.h"

/* ---------------------------------------------------------------------------------------------------------- changes */

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

static enum status read_change(struct rooms_reading *r, const char *name, struct err *err)
{
    struct rooms *rooms = r->rooms;
    char model[FILE_PATH], path[FILE_PATH];
    if (file_path(model, "remodel", name, "", err)) return err->status;
    if (!contents_product(path, r->from->folder, PRODUCT_MODEL, &(struct product_key){.model = model})) return ST_OK;
    if (array_append(&rooms->changes, (size_t)rooms->change_count, sizeof *rooms->changes, "changes", err))
        return err->status;
    struct room_change *change = &rooms->changes[rooms->change_count++];
    *change = (struct room_change){.photos = 0};
    snprintf(change->name, sizeof change->name, "%s", name);
    return read_about(&change->about, r->from->scripts, name, err);
}

static enum status list_changes(struct rooms_reading *r, struct err *err)
{
    struct dirent **names = NULL;
    char path[FILE_PATH];
    if (file_path(path, r->from->folder, "remodel", "", err)) return err->status;
    const int count = scandir(path, &names, NULL, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    for (int i = 0; i < count; i++) {
        if (!err->status && names[i]->d_name[0] != '.') read_change(r, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------- views, photos */

static enum status add_photo(struct rooms_reading *r, int lens, struct err *err)
{
    const char *name = r->lenses.lenses[lens].photo;
    struct source_photo *last = r->photo_count ? &r->photos[r->photo_count - 1] : NULL;
    if (last && !strcmp(last->photo, name)) {
        last->count++;
        return ST_OK;
    }
    if (array_append(&r->photos, (size_t)r->photo_count, sizeof *r->photos, "photos", err)) return err->status;
    struct source_photo *p = &r->photos[r->photo_count++];
    *p = (struct source_photo){.lenses = &r->lenses.lenses[lens], .first = lens, .count = 1};
    snprintf(p->photo, sizeof p->photo, "%s", name);
    return ST_OK;
}

/* Cameras and photos of the views. False: there are none, which is noted. */
static bool read_views(struct rooms_reading *r, struct err *err)
{
    char path[FILE_PATH], folder[FILE_PATH];
    struct err problem = ERR_INIT;
    if (file_path(folder, r->from->folder, "views", "", err)) return false;
    if (product_path_below(path, r->from->folder, PRODUCT_LENSES, NULL, &problem) ||
        lens_list_read(&r->lenses, path, NULL, &problem) ||
        camera_set_read_cameras(&r->cameras, folder, NULL, &problem)) {
        rooms_note(r->rooms, "the changes cannot be shown", &problem, err);
        return false;
    }
    r->views = calloc((size_t)r->lenses.count + 1, sizeof *r->views);
    if (!r->views) err_nomem(err, "views", (size_t)r->lenses.count * sizeof *r->views);
    for (int i = 0; !err->status && i < r->lenses.count; i++) {
        const int at = camera_set_find(&r->cameras, r->lenses.lenses[i].view);
        if (at < 0) {
            err_set(&problem, ST_DATA, "%s: view %s has no camera; import the cameras again.", path,
                    r->lenses.lenses[i].view);
            rooms_note(r->rooms, "the changes cannot be shown", &problem, err);
            return false;
        }
        r->views[i] = r->cameras.views[at];
        add_photo(r, i, err);
    }
    return !err->status;
}

static enum status read_view_change(struct rooms_reading *r, int change, int lens, struct err *err)
{
    struct view_change *v = rooms_change_of(r, change, lens);
    const char *scene = r->from->folder, *edit = r->rooms->changes[change].name;
    char pictures[FILE_PATH], relit[FILE_PATH], path[FILE_PATH];
    struct err problem = ERR_INIT;
    const struct product_key key = {.name = r->lenses.lenses[lens].view, .pictures = pictures, .relit = relit};
    snprintf(relit, sizeof relit, "relight/%s", edit);
    snprintf(pictures, sizeof pictures, "remodel/%s/pictures", edit);
    v->drawn = contents_product(path, scene, PRODUCT_PICTURE_RECORD, &key);
    if (!v->drawn) {
        snprintf(pictures, sizeof pictures, "relight/%s/unlit", edit);
        v->drawn = v->unlit = contents_product(path, scene, PRODUCT_PICTURE_RECORD, &key);
    }
    if (v->drawn && picture_record_read(&v->file, path, NULL, &problem)) {
        v->drawn = false;
        if (rooms_note(r->rooms, "a picture is left out", &problem, err)) return err->status;
    }
    if (!contents_product(path, scene, PRODUCT_RELIT_RECORD, &key)) return ST_OK;
    problem = (struct err)ERR_INIT;
    if (relit_record_read(&v->light, path, &problem))
        return rooms_note(r->rooms, "a relit picture is left out", &problem, err);
    v->lit = true;
    return ST_OK;
}

static enum status read_table(struct rooms_reading *r, struct err *err)
{
    const size_t size = (size_t)r->rooms->change_count * (size_t)r->lenses.count;
    r->table = calloc(size + 1, sizeof *r->table);
    if (!r->table) return err_nomem(err, "records of pictures", size * sizeof *r->table);
    for (int e = 0; e < r->rooms->change_count; e++)
        for (int i = 0; i < r->lenses.count; i++) {
            if (read_view_change(r, e, i, err)) return err->status;
            r->rooms->changes[e].has_records |= rooms_change_of(r, e, i)->drawn || rooms_change_of(r, e, i)->lit;
        }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- rooms */

static enum status read_rooms(struct rooms_reading *r, struct err *err)
{
    if (list_changes(r, err) || !r->rooms->change_count || !read_views(r, err) || read_table(r, err) ||
        rooms_choose(r, err))
        return err->status;
    return rooms_make_pictures(r, err);
}

enum status rooms_read(struct rooms *rooms, const struct rooms_sources *from, struct err *err)
{
    struct rooms_reading r = {.rooms = rooms, .from = from};
    read_rooms(&r, err);
    free(r.table);
    free(r.photos);
    free(r.views);
    camera_set_release(&r.cameras);
    lens_list_release(&r.lenses);
    return err->status;
}
