/* contents_light.c - what the page shows of the light: lamps with the residuals of their fit, fitted materials,
 * irradiance of views and at points.
 *
 * Everything here is optional: a scene may have lamps without a fit, irradiance without lamps, or neither. A file
 * that does not exist adds nothing; one that cannot be read becomes a note on the page, so that one damaged product
 * does not cost the rest. Only running out of memory is an error.
 *
 * lights/fit.txt is read for what the page shows of it: where a lamp's radiance comes from, standard errors, what
 * the photographs show of the lamp itself, and for each marked point the luminance that the photographs show and the
 * one that the fit explains, which the page plots against each other. Other lines are skipped.
 *
 * Irradiance is found by its records, NAME.light.txt (light_summary.c of gather_irradiance), in order of name, at
 * most 24. Those of views come with thumbnails, turned upright by the photo's EXIF orientation, beside the view
 * itself.
 *
 * Pictures are shrunk as they are read: the page needs a few hundred pixels, and memory holds one picture at full
 * size. */
#include "stages/report/contents_light.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"
#include "common/image/luminance.h"
#include "stages/report/contents_parts.h"

enum { LAMP_HEIGHT = 480, VIEW_HEIGHT = 320, HEMICUBE_HEIGHT = 300, GATHERS_MAX = 24 };
static const char SUFFIX[] = ".light.txt";

bool light_contents_any(const struct light_contents *l)
{
    return l->lights.lamp_count || l->lights.opening_count || l->materials.count || l->gather_count;
}

void light_contents_release(struct light_contents *l)
{
    for (int i = 0; l->lamps && i < l->lights.lamp_count; i++) {
        free(l->lamps[i].points);
        picture_release(&l->lamps[i].picture);
    }
    for (int i = 0; l->material_cards && i < l->materials.count; i++) picture_release(&l->material_cards[i].residuals);
    for (int i = 0; i < l->gather_count; i++) {
        struct gather_card *g = &l->gathers[i];
        struct picture *all[] = {&g->photo, &g->white, &g->level, &g->unknown};
        for (size_t k = 0; k < sizeof all / sizeof *all; k++) picture_release(all[k]);
        for (int k = 0; k < LIGHT_EXAMPLES_MAX; k++) picture_release(&g->hemicubes[k]);
    }
    free(l->lamps);
    free(l->material_cards);
    free(l->gathers);
    light_list_release(&l->lights);
    material_list_release(&l->materials);
    *l = (struct light_contents){0};
}

/* Reads a JPEG, turns it upright and shrinks it. What cannot be read is noted. */
static enum status read_picture(struct picture *p, struct contents *c, const char *path, int orientation, int height,
                                struct err *err)
{
    struct photo photo = {0};
    struct err problem = ERR_INIT;
    if (photo_read(&photo, path, &problem))
        return contents_note(c, err, "A picture of the light is not shown. %s", problem.text);
    photo.info.orientation = orientation;
    picture_from_photo(p, &photo, height, err);
    photo_release(&photo);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- lamps */

static enum status read_triple(struct textfile *t, double values[3], struct err *err)
{
    for (int c = 0; c < 3; c++)
        if (textfile_double(t, "a colour", &values[c], err)) return err->status;
    return ST_OK;
}

static enum status read_count(struct textfile *t, const char *word, int *count, struct err *err)
{
    int64_t value;
    if (textfile_expect(t, word, err) || textfile_int(t, word, 0, INT_MAX, &value, err)) return err->status;
    *count = (int)value;
    return ST_OK;
}

/* The card of the lamp that the next word names; NULL: lights.txt does not have it. */
static enum status read_lamp_name(struct lamp_card **card, const struct light_contents *l, struct textfile *t,
                                  struct err *err)
{
    char *name;
    *card = NULL;
    if (textfile_word(t, "the name of a lamp", &name, err)) return err->status;
    for (int i = 0; i < l->lights.lamp_count; i++)
        if (!strcmp(l->lights.lamps[i].name, name)) *card = &l->lamps[i];
    return *card ? ST_OK : textfile_error(t, err, name, "a lamp of lights.txt; fit the lights again");
}

static enum status read_lamp(struct light_contents *l, struct textfile *t, struct err *err)
{
    struct lamp_card *card;
    double skipped[3], beta, exponent;
    if (read_lamp_name(&card, l, t, err) ||
        textfile_word_into(t, "given, fitted, measured or bound", card->source, sizeof card->source, err) ||
        read_triple(t, skipped, err) || read_triple(t, card->radiance_error, err) || textfile_expect(t, "beta", err) ||
        textfile_double(t, "beta", &beta, err) || textfile_double(t, "its error", &card->beta_error, err) ||
        textfile_expect(t, "exponent", err) || textfile_double(t, "the exponent", &exponent, err) ||
        textfile_double(t, "its error", &card->exponent_error, err))
        return err->status;
    return ST_OK;
}

static enum status read_seen(struct light_contents *l, struct textfile *t, struct err *err)
{
    struct lamp_card *card;
    if (read_lamp_name(&card, l, t, err) || read_triple(t, card->seen, err) || read_triple(t, card->seen_error, err) ||
        read_count(t, "unsaturated", &card->unsaturated, err) || read_count(t, "saturated", &card->saturated, err))
        return err->status;
    card->disagrees = textfile_more(t);
    return card->disagrees ? textfile_expect(t, "disagrees", err) : ST_OK;
}

static enum status read_point(struct light_contents *l, struct textfile *t, struct err *err)
{
    struct lamp_card *card;
    char lit[8];
    int64_t line;
    double place[3], seen[3], explained[3], indirect[3];
    if (textfile_int(t, "a line", 1, INT_MAX, &line, err) ||
        textfile_word_into(t, "lit or unlit", lit, sizeof lit, err) || read_triple(t, place, err) ||
        textfile_expect(t, "radiance", err) || read_triple(t, seen, err) || textfile_expect(t, "explained", err) ||
        read_triple(t, explained, err) || textfile_expect(t, "indirect", err) || read_triple(t, indirect, err))
        return err->status;
    if (!textfile_more(t)) return ST_OK; /* as it was written before points named their lamps */
    if (textfile_expect(t, "lamp", err) || read_lamp_name(&card, l, t, err) ||
        array_append(&card->points, (size_t)card->point_count, sizeof *card->points, "marked points", err))
        return err->status;
    card->points[card->point_count++] =
        (struct light_point){!strcmp(lit, "lit"), luminance_of_doubles(seen), luminance_of_doubles(explained)};
    return ST_OK;
}

static enum status read_fit_line(struct light_contents *l, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "a statement", &word, err)) return err->status;
    if (!strcmp(word, "lamp")) return read_lamp(l, t, err);
    if (!strcmp(word, "seen")) return read_seen(l, t, err);
    return strcmp(word, "point") ? ST_OK : read_point(l, t, err);
}

static enum status read_fit(struct contents *c, const char *folder, struct err *err)
{
    struct textfile t = {0};
    struct err problem = ERR_INIT;
    char path[FILE_PATH];
    if (!contents_product(path, folder, PRODUCT_LIGHT_FIT, NULL)) return ST_OK;
    product_open(&t, NULL, PRODUCT_LIGHT_FIT, path, NULL, &problem);
    while (!problem.status && textfile_next(&t)) read_fit_line(&c->light, &t, &problem);
    textfile_release(&t);
    if (problem.status == ST_NOMEM) return err_set(err, ST_NOMEM, "%s", problem.text);
    return problem.status ? contents_note(c, err, "The fit of the lamps is not shown in full. %s", problem.text)
                          : ST_OK;
}

static enum status read_lamps(struct contents *c, const char *folder, struct err *err)
{
    struct light_contents *l = &c->light;
    struct err problem = ERR_INIT;
    char path[FILE_PATH], name[LAMP_FILE_NAME];
    if (!contents_product(path, folder, PRODUCT_LIGHTS, NULL)) return ST_OK;
    if (light_list_read(&l->lights, path, NULL, &problem)) {
        light_list_release(&l->lights);
        return contents_note(c, err, "The lamps are not shown. %s", problem.text);
    }
    l->lamps = calloc((size_t)l->lights.lamp_count + 1, sizeof *l->lamps);
    if (!l->lamps) return err_nomem(err, "lamps", (size_t)l->lights.lamp_count * sizeof *l->lamps);
    for (int i = 0; i < l->lights.lamp_count; i++) {
        l->lamps[i].lamp = &l->lights.lamps[i];
        light_list_lamp_file(name, &l->lights, i);
        const struct product_key key = {.name = name};
        if (contents_product(path, folder, PRODUCT_LAMP_PICTURE, &key) &&
            read_picture(&l->lamps[i].picture, c, path, 1, LAMP_HEIGHT, err))
            return err->status;
    }
    return read_fit(c, folder, err);
}

/* ------------------------------------------------------------------------------------------------------- materials */

static enum status read_materials(struct contents *c, const char *folder, struct err *err)
{
    struct light_contents *l = &c->light;
    struct err problem = ERR_INIT;
    char path[FILE_PATH];
    if (!contents_product(path, folder, PRODUCT_MATERIALS, NULL)) return ST_OK;
    if (material_list_read(&l->materials, path, NULL, &problem))
        return contents_note(c, err, "The fitted materials are not shown. %s", problem.text);
    l->material_cards = calloc((size_t)l->materials.count + 1, sizeof *l->material_cards);
    if (!l->material_cards) return err_nomem(err, "materials", (size_t)l->materials.count * sizeof *l->material_cards);
    for (int i = 0; i < l->materials.count; i++) {
        struct material_card *card = &l->material_cards[i];
        card->material = &l->materials.items[i];
        const struct product_key key = {.name = card->material->name};
        if (contents_product(path, folder, PRODUCT_MATERIAL_PICTURE, &key) &&
            read_picture(&card->residuals, c, path, 1, VIEW_HEIGHT, err))
            return err->status;
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ irradiance */

/* Thumbnails of a view, and its photograph. */
static enum status read_view(struct gather_card *g, struct contents *c, const char *folder, const char *gathered,
                             struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    static const enum product_id ids[] = {PRODUCT_IRRADIANCE_WHITE, PRODUCT_IRRADIANCE_LEVEL,
                                          PRODUCT_IRRADIANCE_UNKNOWN};
    struct picture *const pictures[] = {&g->white, &g->level, &g->unknown};
    const int at = camera_set_find(&c->views, g->name);
    const struct photo_record *photo = at >= 0 ? c->view_cards[at].photo : NULL;
    const int orientation = photo ? photo->info.orientation : 1;
    struct err problem = ERR_INIT;
    struct exr_image im = {0};
    const struct product_key key = {.gathered = gathered, .view = g->name};
    char path[FILE_PATH];
    for (int i = 0; i < 3; i++)
        if (contents_product(path, folder, ids[i], &key) &&
            read_picture(pictures[i], c, path, orientation, VIEW_HEIGHT, err))
            return err->status;
    if (!contents_product(path, folder, PRODUCT_VIEW, &key)) return ST_OK;
    if (!exr_read(&im, path, NAMES, 3, &problem)) picture_from_exr(&g->photo, &im, orientation, VIEW_HEIGHT, &problem);
    exr_image_release(&im);
    if (problem.status == ST_NOMEM) return err_set(err, ST_NOMEM, "%s", problem.text);
    return problem.status ? contents_note(c, err, "A view is not shown beside its light. %s", problem.text) : ST_OK;
}

/* below: "", or "irradiance/", where those of views and faces are. */
static enum status read_gather(struct contents *c, const char *folder, const char *below, const char *name,
                               struct err *err)
{
    struct light_contents *l = &c->light;
    struct light_record record;
    struct err problem = ERR_INIT;
    char gathered[FILE_PATH], path[FILE_PATH], number[16];
    snprintf(gathered, sizeof gathered, "%s%s", below, name);
    if (product_path_below(path, folder, PRODUCT_LIGHT_RECORD, &(struct product_key){.gathered = gathered}, &problem) ||
        light_record_read(&record, path, &problem))
        return contents_note(c, err, "Irradiance is not shown. %s", problem.text);
    if (l->gather_count == GATHERS_MAX) return ST_OK;
    if (array_append(&l->gathers, (size_t)l->gather_count, sizeof *l->gathers, "irradiance", err)) return err->status;
    struct gather_card *g = &l->gathers[l->gather_count++];
    *g = (struct gather_card){.record = record, .is_view = record.level[1] > 0};
    snprintf(g->name, sizeof g->name, "%s", name);
    if (g->is_view) read_view(g, c, folder, gathered, err);
    for (int i = 0; !err->status && i < record.example_count; i++) {
        snprintf(number, sizeof number, "%d", i + 1);
        const struct product_key key = {.gathered = gathered, .name = number};
        if (contents_product(path, folder, PRODUCT_HEMICUBE, &key))
            read_picture(&g->hemicubes[i], c, path, 1, HEMICUBE_HEIGHT, err);
    }
    return err->status;
}

static int is_record(const struct dirent *e)
{
    const size_t length = strlen(e->d_name), suffix = strlen(SUFFIX);
    return e->d_name[0] != '.' && length > suffix && !strcmp(e->d_name + length - suffix, SUFFIX);
}

static enum status read_gathers(struct contents *c, const char *folder, const char *below, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/relight/%s", folder, below);
    const int count = scandir(path, &names, is_record, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    for (int i = 0; i < count; i++) {
        char *name = names[i]->d_name;
        name[strlen(name) - strlen(SUFFIX)] = '\0';
        if (!err->status) read_gather(c, folder, below, name, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}

enum status contents_read_light(struct contents *c, const char *folder, struct err *err)
{
    if (read_lamps(c, folder, err) || read_materials(c, folder, err) || read_gathers(c, folder, "irradiance/", err))
        return err->status;
    return read_gathers(c, folder, "", err);
}

/* ------------------------------------------------------------------------------------------------------------ edits */

/* An edit with pictures in its light becomes a card with one view. */
static enum status read_relit_edit(struct contents *c, const struct relit_sources *from, const char *edit,
                                   struct err *err)
{
    struct relit_card card = {.missing = -1};
    relit_card_read(&card, from, edit, 1, err);
    for (int i = 0; !err->status && i < card.note_count; i++) contents_note(c, err, "Edit %s: %s", edit, card.notes[i]);
    if (!err->status && card.views &&
        !array_append(&c->relit, (size_t)c->relit_count, sizeof *c->relit, "relit edits", err))
        c->relit[c->relit_count++] = card;
    else
        relit_card_release(&card);
    return err->status;
}

static int is_plain(const struct dirent *e) { return e->d_name[0] != '.' && strcmp(e->d_name, "irradiance") != 0; }

enum status contents_read_relit(struct contents *c, const char *folder, const char *shared, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE], records[PATH_SIZE];
    snprintf(path, sizeof path, "%s/relight", folder);
    snprintf(records, sizeof records, "%s/photos", shared);
    const struct relit_sources from = {folder, records, &c->lenses};
    const int count = scandir(path, &names, is_plain, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    for (int i = 0; i < count; i++) {
        if (!err->status) read_relit_edit(c, &from, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}
