/* page_films.c - the films of a scene, and the rooms from above, for people. */
#include "stages/report/page_parts.h"

#include <ctype.h>
#include <string.h>

static void put_megabytes(FILE *to, long long bytes)
{
    fprintf(to, " <span class=\"size\">%.1f MB</span>", (double)bytes / 1e6);
}

/* What a camera move does, in a few words. */
static const char *move_words(const char *name)
{
    static const char *const words[][2] = {
        {"establishing_dolly_out", "The camera moves back and shows more and more"},
        {"establishing_dolly", "The camera moves slowly along the scene"},
        {"dolly_zoom", "The camera moves while it zooms the other way"},
        {"dolly_in", "The camera moves towards its subject"},
        {"dolly_out", "The camera moves away from its subject"},
        {"dolly", "The camera moves from one subject to another"},
        {"morph", "One photograph turns into the other"},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strncmp(name, words[i][0], strlen(words[i][0]))) return words[i][1];
    return "A film from the photographs";
}

/* "side_by_side-hlg" as "side by side, HLG". */
static void put_kind_words(FILE *to, const char *name)
{
    static const char *const words[][2] = {
        {"side_by_side", "two eyes side by side"},
        {"top_bottom", "two eyes, one above the other"},
        {"anaglyph", "for red and cyan glasses"},
        {"vr180", "VR180"},
        {"h264", "H.264"},
        {"av1", "AV1"},
        {"prores", "ProRes"},
        {"hlg", "HDR (HLG)"},
        {"pq", "HDR (PQ)"},
    };
    for (const char *part = name; *part;) {
        const size_t length = strcspn(part, "-");
        const char *text = NULL;
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            if (strlen(words[i][0]) == length && !strncmp(part, words[i][0], length)) text = words[i][1];
        if (part != name) fputs(", ", to);
        if (text)
            fputs(text, to);
        else
            for (size_t i = 0; i < length; i++) fprintf(to, isalnum((unsigned char)part[i]) ? "%c" : "_", part[i]);
        part += length + (part[length] == '-');
    }
}

/* The film for two eyes, or in other formats: files that browsers may not play, so links. */
static void put_kinds(struct page *page, const struct contents *c, const struct effect_card *e)
{
    FILE *to = page->to;
    for (int i = 0; i < e->kind_count; i++) {
        fputs("<br><a href=\"", to);
        page_put_product(page, c->folder, e->kinds[i].file);
        fputs("\">", to);
        put_kind_words(to, e->kinds[i].name);
        fputs("</a>", to);
        put_megabytes(to, e->kinds[i].bytes);
    }
}

static enum status put_move(struct page *page, const struct contents *c, const struct effect_card *e, struct err *err)
{
    FILE *to = page->to;
    char poster[PICTURE_NAME] = "";
    if (!e->video) return ST_OK;
    if (e->poster.rgb && page_write_picture(page, &e->poster, 82, poster, err)) return err->status;
    fputs("<figure><video controls loop playsinline preload=\"none\"", to);
    if (e->poster.rgb)
        fprintf(to, " width=\"%d\" height=\"%d\" poster=\"%s%s\"", e->poster.width, e->poster.height, page->address,
                poster);
    fputs(" aria-label=\"", to);
    page_put_spaced(to, e->name);
    fputs("\" src=\"", to);
    page_put_product(page, c->folder, e->video);
    fprintf(to, "\">This browser cannot play the film.</video>\n<figcaption>%s <span class=\"muted\">(",
            move_words(e->name));
    page_put_spaced(to, e->name);
    fputs(")</span>", to);
    if (e->path.frame_count && e->path.fps > 0)
        fputs(" · ", to), page_put_seconds(to, e->path.frame_count / e->path.fps);
    put_megabytes(to, e->video_bytes);
    put_kinds(page, c, e);
    fputs("</figcaption></figure>\n", to);
    return ST_OK;
}

static void put_tour(struct page *page, const struct contents *c, const struct tour_card *t)
{
    FILE *to = page->to;
    fputs("<figure><video controls playsinline preload=\"metadata\" aria-label=\"A walk through the rooms\" src=\"",
          to);
    page_put_product(page, c->folder, t->video);
    fputs("\">This browser cannot play the film.</video>\n<figcaption>A walk through the rooms", to);
    fputs(t->change[0] ? " after the change: " : " as they are", to);
    if (t->change[0]) page_put_change(to, t->change);
    if (t->relit) fputs(", in the new light", to);
    if (t->flicker.known) fprintf(to, " <span class=\"size\">flicker %.2g %%</span>", 100 * t->flicker.middle);
    put_megabytes(to, t->bytes);
    fputs("</figcaption></figure>\n", to);
}

enum status page_films(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    int films = c->tour_count;
    for (int i = 0; i < c->effect_count; i++) films += c->effects[i].video != NULL;
    if (!films && c->model_count) return ST_OK;
    fputs("<section id=\"films\" aria-labelledby=\"films-title\">\n<h2 id=\"films-title\">Films</h2>\n", to);
    if (!films) fputs("<p>No film has been made yet.</p>\n", to);
    fprintf(to, "<div class=\"films%s\">\n", films == 1 ? " few" : "");
    for (int i = 0; i < c->effect_count; i++)
        if (put_move(page, c, &c->effects[i], err)) return err->status;
    for (int i = 0; i < c->tour_count; i++) put_tour(page, c, &c->tours[i]);
    fputs("</div>\n</section>\n", to);
    return ST_OK;
}

static enum status put_picture(struct page *page, const char *file, const char *ending, const char *caption,
                               struct err *err)
{
    char name[PICTURE_NAME];
    if (!file) return ST_OK;
    if (page_copy_picture(page, file, ending, name, err)) return err->status;
    fprintf(page->to, "<figure><img loading=\"lazy\" alt=\"%s\" src=\"%s%s\"><figcaption>%s</figcaption></figure>\n",
            caption, page->address, name, caption);
    return ST_OK;
}

enum status page_plan(struct page *page, const struct contents *c, struct err *err)
{
    const struct model_card *m = c->model_count && !c->models[0].name[0] ? &c->models[0] : NULL;
    if (!m || (!m->plan && !m->view)) return ST_OK;
    fputs("<section id=\"plan\" aria-labelledby=\"plan-title\">\n<h2 id=\"plan-title\">The rooms from above</h2>\n<div "
          "class=\"plans\">\n",
          page->to);
    if (put_picture(page, m->plan, ".svg", "Plan of the rooms", err) ||
        put_picture(page, m->view, ".png", "The rooms from above, cut below the ceiling", err))
        return err->status;
    fputs("</div>\n</section>\n", page->to);
    return ST_OK;
}
