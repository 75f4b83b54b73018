/* contents_textures.c - texture atlases: their pages, and the room seen from the views with their texture.
 *
 * Overview. A card is made for each of the first viewpoints, and for the view-independent atlas with two views. For
 * each view of a card the samples are located in the atlas first (texture_pictures.c); then each page is read once,
 * is shrunk to a picture of its own, and fills in the samples of all views that lie on it. So an atlas of many pages
 * costs the memory of one.
 *
 * Sources are listed with the number of pixels that each gives to the views, most first. A view has one colour in
 * all atlases, by its number in the scene, so that cards can be compared.
 *
 * A card that cannot be read is dropped as a whole, and becomes a note. */
#include "stages/report/contents_parts.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/false_colour.h"
#include "stages/report/texture_pictures.h"

enum {
    VIEWPOINTS_SHOWN = 12,
    VITA_VIEWS = 2,     /* views of the block of the view-independent atlas */
    SIGHT_HEIGHT = 240, /* px, of the pictures of views, and of pages */
    PAGE_HEIGHT = 200,
};

/* What is read for a card, beside what it shows. */
struct texture_work {
    struct contents *c;
    const char *folder; /* of the scene's products */
    const struct model_axes *axes;
    struct texture_card *card;
    struct atlas atlas;
    struct sight *sights; /* one for each of the card's views */
};

static enum status read_photo(const struct texture_work *w, struct texture_view *v, int view, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    const struct photo_record *photo = w->c->view_cards[view].photo;
    struct exr_image im = {0};
    char path[FILE_PATH];
    if (!product_path_below(path, w->folder, PRODUCT_VIEW, &(struct product_key){.view = v->name}, err) &&
        !exr_read(&im, path, NAMES, 3, err))
        picture_from_exr(&v->photo, &im, photo ? photo->info.orientation : 1, SIGHT_HEIGHT, err);
    exr_image_release(&im);
    return err->status;
}

static enum status read_sights(struct texture_work *w, char *const *names, struct err *err)
{
    const int count = w->card->view_count;
    for (int i = 0; !err->status && i < count; i++) {
        struct texture_view *v = &w->card->views[i];
        const int view = camera_set_find(&w->c->views, names[i]);
        char path[FILE_PATH];
        if (view < 0) return err_set(err, ST_DATA, "There is no view %s; bake it again.", names[i]);
        const struct photo_record *photo = w->c->view_cards[view].photo;
        snprintf(v->name, sizeof v->name, "%s", names[i]);
        if (!product_path_below(path, w->folder, PRODUCT_IDS, &(struct product_key){.view = v->name}, err) &&
            !read_photo(w, v, view, err))
            texture_sight_make(&w->sights[i], &w->atlas, &w->c->views.views[view], w->axes, path,
                               photo ? photo->info.orientation : 1, SIGHT_HEIGHT, err);
    }
    return err->status;
}

/* Each page once: its own picture, and its texels in all views. */
static enum status read_pages(struct texture_work *w, const char *folder, struct err *err)
{
    struct texture_card *card = w->card;
    for (int i = 0; !err->status && i < w->atlas.page_count; i++) {
        struct atlas_page page = {0};
        atlas_page_read(&page, &w->atlas, i, folder, NULL, err);
        for (int k = 0; !err->status && k < card->view_count; k++)
            texture_sight_add_page(&w->sights[k], &w->atlas, &page, i);
        if (!err->status && i < PAGES_SHOWN) {
            picture_from_atlas_page(&card->pages[i], &page, PAGE_HEIGHT, err);
            card->page_sizes[i][0] = page.width;
            card->page_sizes[i][1] = page.height;
        }
        atlas_page_release(&page);
    }
    return err->status;
}

static bool is_listed(char *const *names, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (!strcmp(names[i], name)) return true;
    return false;
}

/* Most pixels first. */
static int compare_sources(const void *a, const void *b)
{
    const struct texture_source *p = a, *q = b;
    if (p->pixels != q->pixels) return p->pixels < q->pixels ? 1 : -1;
    return strcmp(p->name, q->name);
}

/* A view has the same colour in all atlases. */
static enum status list_sources(const struct texture_work *w, struct source_colour *colours, struct err *err)
{
    struct texture_card *card = w->card;
    const struct atlas *a = &w->atlas;
    card->sources = calloc((size_t)a->source_count + 1, sizeof *card->sources);
    if (!card->sources) return err_nomem(err, "sources", (size_t)a->source_count * sizeof *card->sources);
    for (int i = 0; i < a->source_count; i++) {
        struct texture_source *s = &card->sources[i];
        const int view = camera_set_find(&w->c->views, a->sources[i]);
        s->name = strdup(a->sources[i]);
        if (!s->name) return err_nomem(err, "a name", strlen(a->sources[i]));
        card->source_count++;
        s->original = is_listed(a->views, a->view_count, s->name);
        colour_of_category(view < 0 ? i : view, s->rgb);
        colours[i].original = s->original;
        memcpy(colours[i].rgb, s->rgb, sizeof s->rgb);
    }
    return ST_OK;
}

static enum status draw_views(struct texture_work *w, struct err *err)
{
    struct texture_card *card = w->card;
    const size_t kinds = (size_t)ATLAS_VIEWS + (size_t)w->atlas.source_count;
    struct source_colour *colours = calloc(kinds, sizeof *colours);
    long long *counts = calloc(kinds, sizeof *counts);
    if (colours && counts)
        list_sources(w, colours, err);
    else
        err_nomem(err, "sources", kinds);
    for (int i = 0; !err->status && i < card->view_count; i++)
        if (!picture_from_sight(&card->views[i].texture, &w->sights[i], err))
            picture_from_sources(&card->views[i].sources, &w->sights[i], colours, counts, err);
    for (size_t i = 0; !err->status && i < kinds; i++) {
        card->total += counts[i];
        if (i >= ATLAS_VIEWS) card->sources[i - ATLAS_VIEWS].pixels = counts[i];
    }
    if (!err->status) {
        card->empty = counts[ATLAS_NONE];
        card->synthesised = counts[ATLAS_SYNTHESISED];
        card->by_default = counts[ATLAS_DEFAULT];
        qsort(card->sources, (size_t)card->source_count, sizeof *card->sources, compare_sources);
    }
    free(colours);
    free(counts);
    return err->status;
}

static enum status read_card(struct texture_work *w, char *const *names, int count, const char *folder, struct err *err)
{
    struct texture_card *card = w->card;
    card->page_count = w->atlas.page_count;
    card->tile_count = w->atlas.tile_count;
    card->views = calloc((size_t)count + 1, sizeof *card->views);
    w->sights = calloc((size_t)count + 1, sizeof *w->sights);
    if (!card->views || !w->sights) return err_nomem(err, "views", (size_t)count * sizeof *w->sights);
    card->view_count = count;
    if (read_sights(w, names, err) || read_pages(w, folder, err)) return err->status;
    return draw_views(w, err);
}

/* Adds a card for an atlas. views: the VITA's; a viewpoint's are those that its atlas lists. A card that cannot be read
 * becomes a note. */
static enum status add_card(struct contents *c, const char *folder, const struct model_axes *axes, const char *photo,
                            char *const *views, int view_count, struct err *err)
{
    struct err problem = ERR_INIT;
    char path[PATH_SIZE + 256];
    struct texture_card *card = &c->textures[c->texture_count];
    struct texture_work w = {.c = c, .folder = folder, .axes = axes, .card = card};
    if (photo)
        snprintf(path, sizeof path, "%s/vdta/%s", folder, photo);
    else
        snprintf(path, sizeof path, "%s/vita", folder);
    snprintf(card->name, sizeof card->name, "%s", photo ? photo : "");
    atlas_read(&w.atlas, path, NULL, &problem);
    if (!problem.status && photo) views = w.atlas.views, view_count = w.atlas.view_count;
    if (!problem.status) read_card(&w, views, view_count, path, &problem);
    for (int i = 0; w.sights && i < card->view_count; i++) texture_sight_release(&w.sights[i]);
    free(w.sights);
    atlas_release(&w.atlas);
    c->texture_count += !problem.status;
    if (!problem.status) return ST_OK;
    texture_card_release(card);
    return contents_note(c, err, "The texture atlas %s is not shown. %s", path, problem.text);
}

void texture_card_release(struct texture_card *t)
{
    for (int i = 0; t->views && i < t->view_count; i++) {
        picture_release(&t->views[i].photo);
        picture_release(&t->views[i].texture);
        picture_release(&t->views[i].sources);
    }
    for (int i = 0; i < PAGES_SHOWN; i++) picture_release(&t->pages[i]);
    for (int i = 0; i < t->source_count; i++) free(t->sources[i].name);
    free(t->views);
    free(t->sources);
    *t = (struct texture_card){0};
}

/* The viewpoints that have an atlas, in order of name; the caller frees each and the list. */
static enum status list_viewpoints(char ***names, int *count, const char *folder, struct err *err)
{
    struct dirent **entries = NULL;
    char path[PATH_SIZE], below[FILE_PATH], atlas[FILE_PATH];
    snprintf(path, sizeof path, "%s/vdta", folder);
    const int found = scandir(path, &entries, NULL, alphasort);
    if (found < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    const size_t room = (size_t)(found > 0 ? found : 0) + 1;
    *names = calloc(room, sizeof **names);
    if (!*names) err_nomem(err, "names", room * sizeof **names);
    for (int i = 0; i < found; i++) {
        const char *name = entries[i]->d_name;
        snprintf(atlas, sizeof atlas, "vdta/%s", name);
        if (!err->status && *name != '.' &&
            contents_product(below, folder, PRODUCT_ATLAS, &(struct product_key){.atlas = atlas})) {
            (*names)[*count] = strdup(name);
            if ((*names)[*count])
                ++*count;
            else
                err_nomem(err, "a name", strlen(name));
        }
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

/* The VITA as two views show it: the first ones of two viewpoints, or of the scene. */
static enum status add_vita(struct contents *c, const char *folder, const struct model_axes *axes, struct err *err)
{
    char path[FILE_PATH];
    char *views[VITA_VIEWS];
    if (!contents_product(path, folder, PRODUCT_ATLAS, NULL)) return ST_OK;
    const int choices = c->texture_count ? c->texture_count : c->views.view_count;
    const int count = choices < VITA_VIEWS ? choices : VITA_VIEWS;
    for (int i = 0; i < count; i++) {
        const int at = i * choices / count;
        views[i] = c->texture_count ? c->textures[at].views[0].name : (char *)c->view_cards[at].view->name;
    }
    return add_card(c, folder, axes, NULL, views, count, err);
}

enum status contents_read_textures(struct contents *c, const char *folder, struct err *err)
{
    struct model_axes axes;
    struct err problem = ERR_INIT;
    char path[FILE_PATH];
    char **names = NULL;
    list_viewpoints(&names, &c->viewpoint_count, folder, err);
    const int shown = c->viewpoint_count < VIEWPOINTS_SHOWN ? c->viewpoint_count : VIEWPOINTS_SHOWN;
    const bool any = !err->status && c->has_views && (shown || contents_product(path, folder, PRODUCT_ATLAS, NULL));
    if (any && (product_path_below(path, folder, PRODUCT_AXES, NULL, &problem) ||
                model_axes_read(&axes, path, NULL, &problem))) {
        contents_note(c, err, "The texture atlases are not shown. %s", problem.text);
    } else if (any) {
        c->textures = calloc((size_t)shown + 1, sizeof *c->textures);
        if (!c->textures) err_nomem(err, "texture atlases", (size_t)shown * sizeof *c->textures);
        for (int i = 0; !err->status && i < shown; i++)
            add_card(c, folder, &axes, names[(int64_t)i * c->viewpoint_count / shown], NULL, 0, err);
        if (!err->status) add_vita(c, folder, &axes, err);
    }
    for (int i = 0; names && i < c->viewpoint_count; i++) free(names[i]);
    free(names);
    return err->status;
}
