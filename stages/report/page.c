/* page.c - see page.h: the frames of the two pages; page_*.c hold their sections. */
#include "stages/report/page.h"

#include "common/base/version.h"
#include "stages/report/page_rooms.h"

static void put_door(FILE *to, bool is_there, const char *address, const char *words, bool quiet)
{
    if (is_there) fprintf(to, "<li%s><a href=\"%s\">%s</a></li>\n", quiet ? " class=\"quiet\"" : "", address, words);
}

static int count_films(const struct contents *c)
{
    int films = c->tour_count;
    for (int i = 0; i < c->effect_count; i++) films += c->effects[i].video != NULL;
    return films;
}

static int count_drawn(const struct rooms *rooms)
{
    int drawn = 0;
    for (int i = 0; i < rooms->change_count; i++) drawn += rooms->changes[i].has_records;
    return drawn;
}

static enum status put_people_head(struct page *page, const char *scene, const char *numbers, const struct contents *c,
                                   struct err *err)
{
    static const char *const styles[] = {"page.css"};
    FILE *to = page->to;
    const int films = count_films(c), changes = count_drawn(&c->rooms);
    if (page_put_head(page, scene, "", styles, 1, err)) return err->status;
    fputs("<p class=\"lead\">", to);
    page_put_plural(to, c->photos.count, "photograph", "photographs");
    if (changes) fputs(" · ", to), page_put_plural(to, changes, "change", "changes");
    if (films) fputs(" · ", to), page_put_plural(to, films, "film", "films");
    fputs("</p>\n<ul class=\"doors\">\n", to);
    put_door(to, c->has_walk, "walk/index.html", "Walk through the rooms", false);
    put_door(to, c->has_remodel_page, "remodel/index.html", "All about each change", true);
    put_door(to, c->has_levels, "lux/index.html", "How bright it is, by lamp and hour", true);
    put_door(to, c->has_draw, "draw/index.html", "Draw on the photographs", true);
    put_door(to, true, numbers, "How it was made, in numbers", true);
    fputs("</ul>\n</header>\n<main>\n", to);
    return ST_OK;
}

/* The changes that nobody drew. */
static void put_undrawn(FILE *to, const struct rooms *rooms)
{
    int count = 0;
    for (int i = 0; i < rooms->change_count; i++) {
        if (rooms->changes[i].has_records) continue;
        fputs(count++ ? ", " : "<p class=\"muted\">Without pictures yet: ", to);
        page_put_change(to, rooms->changes[i].name);
    }
    if (count) fputs(". They are drawn by <code>make remodel</code>, each with <code>EDIT=NAME</code>.</p>\n", to);
}

static enum status put_rooms(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!c->rooms.change_count) return ST_OK;
    fputs("<section id=\"rooms\" aria-labelledby=\"rooms-title\">\n<h2 id=\"rooms-title\">Before and after</h2>\n", to);
    if (c->rooms.photo_count)
        fputs("<p>Move the line over a picture, or use the arrow keys: left of it the photograph, right of it the same "
              "place after a change. Below each picture you choose the change, and the light: that of the day of the "
              "photographs, or the one that the change makes. <a href=\"#how\">What is real in these pictures</a> is "
              "said at the end.</p>\n",
              to);
    if (page_rooms(page, &c->rooms, err)) return err->status;
    put_undrawn(to, &c->rooms);
    fputs("</section>\n", to);
    return ST_OK;
}

enum status page_write(struct page *page, const char *scene, const char *numbers, const struct contents *c,
                       struct err *err)
{
    FILE *to = page->to;
    if (put_people_head(page, scene, numbers, c, err) || put_rooms(page, c, err) || page_films(page, c, err) ||
        page_plan(page, c, err) || page_levels_part(page, c, err) || page_photos(page, c, err))
        return err->status;
    page_few_numbers(to, c);
    if (c->rooms.photo_count || c->rooms.note_count) page_rooms_how(to, &c->rooms);
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION
          ". The pictures are in the folder <code>page</code> beside "
          "this file.</footer>\n",
          to);
    if (page_put_part(page, "script", "page.js", err)) return err->status;
    fputs("</body>\n</html>\n", to);
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- numbers */

static enum status put_numbers_head(struct page *page, const char *scene, const char *back, const struct contents *c,
                                    struct err *err)
{
    static const char *const styles[] = {"page.css", "numbers.css"};
    FILE *to = page->to;
    if (page_put_head(page, scene, ", in numbers", styles, 2, err)) return err->status;
    fputs("<p class=\"lead\">How it was made, and how good it is, for those who work on it · remodel " REMODEL_VERSION
          "</p>\n<nav aria-label=\"Contents\"><a href=\"",
          to);
    html_address(to, back);
    fputs("\">The page of the scene</a>", to);
    fputs("<a href=\"#numbers\">Key numbers</a>", to);
    if (c->has_metrics || c->held.view_count) fputs("<a href=\"#evaluation\">Compared with the truth</a>", to);
    if (page_has_videos(c)) fputs("<a href=\"#video\">Camera moves</a>", to);
    if (c->model_count) fputs("<a href=\"#model\">Model</a>", to);
    if (c->thing_sheet || c->thing_plan) fputs("<a href=\"#things\">Things</a>", to);
    if (c->texture_count) fputs("<a href=\"#textures\">Textures</a>", to);
    if (light_contents_any(&c->light)) fputs("<a href=\"#light\">Light</a>", to);
    if (c->relit_count) fputs("<a href=\"#relit\">Light of changes</a>", to);
    fputs("<a href=\"#depth\">Depth</a>", to);
    if (c->axes_count) fputs("<a href=\"#axes\">Axes</a>", to);
    if (c->photos.count) fputs("<a href=\"#photos\">Photographs</a>", to);
    if (c->lens_form_count) fputs("<a href=\"#lens\">Lens</a>", to);
    fputs("<a href=\"#time\">Time and memory</a><a href=\"#parameters\">Parameters</a><a "
          "href=\"#warnings\">Warnings</a><a href=\"#skipped\">Left out</a></nav>\n</header>\n<main>\n",
          to);
    return ST_OK;
}

enum status page_write_numbers(struct page *page, const char *scene, const char *back, const struct contents *c,
                               struct err *err)
{
    FILE *to = page->to;
    if (put_numbers_head(page, scene, back, c, err)) return err->status;
    page_numbers(to, c);
    if (page_evaluation(page, c, err) || page_videos(page, c, err)) return err->status;
    page_models(page, c);
    page_things(page, c);
    if (page_textures(page, c, err) || page_light(page, c, err) || page_relit(page, c, err) ||
        page_depths(page, c, err) || page_axes(page, c, err))
        return err->status;
    page_photo_table(to, c);
    page_lens(to, c);
    page_usage(to, c);
    page_settings(to, c);
    page_warnings(to, c);
    page_left_out(to, c);
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION ".</footer>\n</body>\n</html>\n", to);
    return ST_OK;
}
