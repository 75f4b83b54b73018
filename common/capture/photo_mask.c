/* photo_mask.c - regions of a photo to ignore. */
#include "common/capture/photo_mask.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void photo_mask_release(struct photo_mask *m)
{
    if (!m) return;
    free(m->masked);
    *m = (struct photo_mask){0};
}

static enum status add_samples(struct photo_mask *m, const struct photo *p, struct err *err)
{
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    const unsigned half = p->info.bits == 16 ? 32768 : 128;
    if (!m->masked && !(m->masked = calloc(pixels, 1))) return err_nomem(err, "a mask", pixels);
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *rgb = p->samples + 3 * i;
        m->masked[i] |= rgb[0] < half && rgb[1] < half && rgb[2] < half;
    }
    return ST_OK;
}

/* Adds FOLDER/ID.png, if it exists. */
static enum status add_mask(struct photo_mask *m, const char *folder, const char *id, const struct photo_record *r,
                            struct provenance *prov, struct err *err)
{
    struct photo p = {0};
    char *path = NULL, *input = NULL;
    if (asprintf(&path, "%s/%s.png", folder, id) < 0 || asprintf(&input, "masks/%s.png", id) < 0) {
        err_nomem(err, "a file name", strlen(folder) + strlen(id));
    } else if (!access(path, F_OK)) {
        photo_read_input(&p, path, input, prov, err);
        if (!err->status && (p.info.width != m->width || p.info.height != m->height))
            err_set(err, ST_DATA,
                    "%s has %d x %d pixels, but the photo \"%s\" that it masks has %d x %d; paint the mask over the "
                    "photo as it is stored, at its full size.",
                    path, p.info.width, p.info.height, r->file, m->width, m->height);
        if (!err->status) add_samples(m, &p, err);
    }
    photo_release(&p);
    free(path);
    free(input);
    return err->status;
}

/* Whether `id` is one of the exposures of the view. */
static bool is_exposure(const struct photo_record *r, const char *records, const char *id)
{
    struct photo_record member = {0};
    struct err ignored = ERR_INIT;
    char *members = NULL;
    bool found = false;
    if (asprintf(&members, "%s/members", records) < 0) return false;
    if (!photo_record_read(&member, members, id, NULL, &ignored))
        for (int i = 0; i < r->bracket_count && !found; i++) found = !strcmp(r->brackets[i].file, member.file);
    photo_record_release(&member);
    free(members);
    return found;
}

static enum status add_exposures(struct photo_mask *m, const char *folder, const char *records,
                                 const struct photo_record *r, struct provenance *prov, struct err *err)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0) err_errno(err, "open", folder);
    for (int i = 0; i < count; i++) {
        char *name = entries[i]->d_name;
        const size_t length = strlen(name);
        if (!err->status && length > 4 && !strcmp(name + length - 4, ".png")) {
            name[length - 4] = 0;
            if (strcmp(name, r->id) && is_exposure(r, records, name)) add_mask(m, folder, name, r, prov, err);
        }
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

enum status photo_mask_read(struct photo_mask *m, const char *folder, const char *records, const struct photo_record *r,
                            struct provenance *prov, struct err *err)
{
    *m = (struct photo_mask){.width = r->info.width, .height = r->info.height};
    if (folder) add_mask(m, folder, r->id, r, prov, err);
    if (!err->status && folder && r->bracket_count) add_exposures(m, folder, records, r, prov, err);
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    if (!err->status && m->masked && !memchr(m->masked, 0, pixels))
        err_set(
            err, ST_DATA,
            "the mask of photo %s in %s hides all of it: no sample is brighter than half of white. Regions to use must "
            "be white (255), not 1; to do without the photo, leave it out (EXCLUDE).",
            r->id, folder);
    if (err->status || !m->masked) photo_mask_release(m);
    return err->status;
}
