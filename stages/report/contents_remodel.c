/* contents_remodel.c - reads what there is of each edit beside its pictures (contents_rooms.c): plans, models, films.
 * They are linked where they exist. For what does not exist, the page says which goal of make makes it. */
#include "stages/report/contents_remodel.h"

#include <stdlib.h>

#include "stages/report/contents_parts.h"

#define EXPORT_PRODUCT(format, file, name, write) PRODUCT_EXPORT_##format,
static const enum product_id exports[] = {EXPORTS(EXPORT_PRODUCT)};

static enum status read_edit(struct edit_card *card, const struct rooms_sources *from, const char *name,
                             struct err *err)
{
    const struct relit_sources light = {from->folder, NULL, NULL};
    char model[FILE_PATH], film[FILE_PATH], path[FILE_PATH];
    const struct product_key key = {.model = model, .film = film};
    if (file_path(model, "remodel", name, "", err) || file_path(film, model, "tour", "", err)) return err->status;
    *card = (struct edit_card){.plan = contents_product_name(from->folder, PRODUCT_PLAN_PICTURE, &key),
                               .film = contents_product(path, from->folder, PRODUCT_VIDEO, &key)};
    for (int i = 0; i < EXPORT_COUNT; i++)
        card->exported |= card->exports[i] = contents_product(path, from->folder, exports[i], &key);
    return relit_rounds_read(&card->relit, &light, name, err);
}

enum status remodel_contents_read(struct remodel_contents *c, const struct remodel_sources *from, struct err *err)
{
    const struct product_key key = {.film = "model/tour"};
    char path[FILE_PATH];
    c->quality = from->quality;
    c->plan = contents_product_name(from->rooms.folder, PRODUCT_PLAN_PICTURE, &key);
    c->film = contents_product(path, from->rooms.folder, PRODUCT_VIDEO, &key);
    if (rooms_read(&c->rooms, &from->rooms, err)) return err->status;
    c->edits = calloc((size_t)c->rooms.change_count + 1, sizeof *c->edits);
    if (!c->edits) return err_nomem(err, "edits", (size_t)c->rooms.change_count * sizeof *c->edits);
    for (int i = 0; !err->status && i < c->rooms.change_count; i++)
        read_edit(&c->edits[i], &from->rooms, c->rooms.changes[i].name, err);
    return err->status;
}

void remodel_contents_release(struct remodel_contents *c)
{
    for (int i = 0; c->edits && i < c->rooms.change_count; i++) {
        relit_card_release(&c->edits[i].relit);
        free(c->edits[i].plan);
    }
    free(c->edits);
    free(c->plan);
    rooms_release(&c->rooms);
    *c = (struct remodel_contents){0};
}
