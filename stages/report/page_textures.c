/* page_textures.c - texture atlases: their pages, and the room as its views show it with their texture. */
#include "stages/report/page_parts.h"

enum { QUALITY = 75, SOURCES_LISTED = 8 };
static const double MIN_SHARE = 0.005; /* of a source that is listed */

/* A link to a file below the scene's folder. */
static void put_link(struct page *page, const char *folder, const char *name, const char *file)
{
    FILE *to = page->to;
    fprintf(to, "<a href=\"%s%s", page->scene, folder);
    html_address(to, name);
    fprintf(to, "/%s\">", file);
}

static void put_legend(FILE *to)
{
    fputs("<ul class=\"key\"><li><i class=\"flat\" style=\"background:#a8a8a8\"></i>original: this viewpoint's own "
          "photograph</li><li><i class=\"flat view\"></i>warped: from another view, a colour for each</li>"
          "<li><i class=\"flat made\"></i>synthesised: no view shows it without clutter</li>"
          "<li><i class=\"flat\" style=\"background:#f0f\"></i>default: no view shows any of the face</li>"
          "<li><i class=\"flat\" style=\"background:#000\"></i>no texel</li></ul>\n",
          to);
}

static void put_share(FILE *to, const char **between, long long pixels, long long total, const char *what)
{
    if (!pixels) return;
    fprintf(to, "%s%.1f %% %s", *between, 100.0 * (double)pixels / (double)total, what);
    *between = ", ";
}

static void put_shares(FILE *to, const struct texture_card *card)
{
    const char *between = "";
    long long original = 0, warped = 0;
    int views = 0;
    for (int i = 0; i < card->source_count; i++) {
        const struct texture_source *s = &card->sources[i];
        *(s->original ? &original : &warped) += s->pixels;
        views += !s->original && s->pixels;
    }
    fputs("<p>", to);
    if (!card->total) fputs("These views show no face of the model", to);
    put_share(to, &between, original, card->total, "original");
    put_share(to, &between, warped, card->total, "warped from ");
    if (warped) page_put_plural(to, views, "view", "views");
    put_share(to, &between, card->synthesised, card->total, "synthesised");
    put_share(to, &between, card->by_default, card->total, "default");
    put_share(to, &between, card->empty, card->total, "without a texel");
    fputs("; ", to);
    page_put_plural(to, card->tile_count, "tile", "tiles");
    fputs(" on ", to);
    page_put_plural(to, card->page_count, "page", "pages");
    fputs(".</p>\n", to);
}

/* The views that most warped texels come from. */
static void put_sources(FILE *to, const struct texture_card *card)
{
    int listed = 0, others = 0;
    for (int i = 0; i < card->source_count; i++) {
        const struct texture_source *s = &card->sources[i];
        if (s->original || !s->pixels) continue;
        if (listed == SOURCES_LISTED || (double)s->pixels < MIN_SHARE * (double)card->total) {
            others++;
            continue;
        }
        fprintf(to, "%s<li><i class=\"flat\" style=\"background:#%02x%02x%02x\"></i>",
                listed++ ? "" : "<ul class=\"key\">", s->rgb[0], s->rgb[1], s->rgb[2]);
        html_text(to, s->name);
        fprintf(to, " %.1f %%</li>", 100.0 * (double)s->pixels / (double)card->total);
    }
    if (!listed) return;
    if (others) {
        fputs("<li>and ", to);
        page_put_plural(to, others, "other", "others");
        fputs("</li>", to);
    }
    fputs("</ul>\n", to);
}

/* Photo, texture and sources of each view: a row for each view, or, of several views, a row for each kind. */
static enum status put_views(struct page *page, const struct texture_card *card, struct err *err)
{
    FILE *to = page->to;
    static const char *const ALT[3] = {"Photograph of view", "Texture in view", "Sources of the texture in view"};
    const bool row_per_kind = card->view_count > 1 && card->name[0];
    const int columns = row_per_kind ? card->view_count : 3, count = 3 * card->view_count;
    fprintf(to, "<div class=\"sight\" style=\"--n:%d\">", columns);
    for (int i = 0; i < count; i++) {
        const int kind = row_per_kind ? i / card->view_count : i % 3;
        const struct texture_view *v = &card->views[row_per_kind ? i % card->view_count : i / 3];
        const struct picture *pictures[3] = {&v->photo, &v->texture, &v->sources};
        if (page_put_picture(page, pictures[kind], QUALITY, ALT[kind], v->name, err)) return err->status;
    }
    fputs("</div>\n", to);
    return ST_OK;
}

static enum status put_pages(struct page *page, const struct texture_card *card, struct err *err)
{
    FILE *to = page->to;
    fputs("<details><summary>Pages <span class=\"muted\">each links to its OpenEXR file</span></summary>\n"
          "<ul class=\"strip pages\">\n",
          to);
    for (int i = 0; i < card->page_count && i < PAGES_SHOWN; i++) {
        char file[32];
        snprintf(file, sizeof file, "page%d.exr", i);
        fputs("<li><figure>", to);
        put_link(page, card->name[0] ? "vdta/" : "vita", card->name, file);
        if (page_put_picture(page, &card->pages[i], QUALITY, "Page of atlas", card->name[0] ? card->name : "VITA", err))
            return err->status;
        fprintf(to, "</a><figcaption>%d × %d</figcaption></figure></li>\n", card->page_sizes[i][0],
                card->page_sizes[i][1]);
    }
    fputs("</ul>\n", to);
    if (card->page_count > PAGES_SHOWN)
        fprintf(to, "<p>%d more pages are not shown.</p>\n", card->page_count - PAGES_SHOWN);
    fputs("</details>\n", to);
    return ST_OK;
}

static enum status put_card(struct page *page, const struct texture_card *card, struct err *err)
{
    FILE *to = page->to;
    fputs("<h3>", to);
    html_text(to, card->name[0] ? card->name : "All viewpoints: the view-independent atlas");
    fputs("</h3>\n", to);
    if (put_views(page, card, err)) return err->status;
    put_shares(to, card);
    put_sources(to, card);
    return put_pages(page, card, err);
}

enum status page_textures(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!c->texture_count) return ST_OK;
    fputs("<section id=\"textures\" aria-labelledby=\"textures-title\">\n<h2 id=\"textures-title\">Textures</h2>\n"
          "<p class=\"muted\">For each viewpoint its photograph; the model from the same place with the texture of the "
          "viewpoint's atlas alone, where furniture is gone if other views show what is behind; and where each texel "
          "comes from. Hatched: no texture.</p>\n",
          to);
    put_legend(to);
    for (int i = 0; i < c->texture_count; i++)
        if (put_card(page, &c->textures[i], err)) return err->status;
    int shown = 0;
    for (int i = 0; i < c->texture_count; i++) shown += c->textures[i].name[0] != '\0';
    if (shown < c->viewpoint_count) {
        fputs("<p>", to);
        page_put_plural(to, c->viewpoint_count - shown, "more viewpoint has an atlas that is",
                        "more viewpoints have atlases that are");
        fputs(" not shown.</p>\n", to);
    }
    fputs("</section>\n", to);
    return ST_OK;
}
