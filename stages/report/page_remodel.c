/* page_remodel.c - the page of a scene's edits: pictures before and after, and of each edit its plan, films and files.
 *
 * What does not exist yet is said with the goal of make that makes it, so the page tells what a scene could still
 * have. Pictures are in the folder `page` beside it; films and models are links. */
#include "stages/report/page_remodel.h"

#include "common/base/version.h"
#include "stages/report/page_relit.h"
#include "stages/report/page_rooms.h"

static enum status put_head(struct page *page, const char *scene, const char *back, const struct remodel_contents *c,
                            struct err *err)
{
    static const char *const styles[] = {"page.css"};
    FILE *to = page->to;
    if (page_put_head(page, scene, ", remodelled", styles, 1, err)) return err->status;
    fputs("<p class=\"lead\">Your rooms as they would look after each change. Move the line over a picture to compare: "
          "left of it the room as it is, right of it the room after the change.</p>\n<nav aria-label=\"Changes\">",
          to);
    for (int i = 0; i < c->rooms.change_count; i++) {
        fprintf(to, "<a href=\"#edit%d\">", i);
        page_put_change(to, c->rooms.changes[i].name);
        fputs("</a>", to);
    }
    fputs("<a href=\"#how\">What is real</a>", to);
    if (back) {
        fputs("<a href=\"", to);
        html_address(to, back);
        fputs("\">The page of the scene</a>", to);
    }
    fputs("</nav>\n</header>\n<main>\n", to);
    return ST_OK;
}

static enum status put_plan(struct page *page, const char *file, const char *caption, struct err *err)
{
    char name[PICTURE_NAME];
    if (!file) return ST_OK;
    if (page_copy_picture(page, file, ".svg", name, err)) return err->status;
    fprintf(page->to,
            "<figure><img loading=\"lazy\" alt=\"Plan %s\" src=\"%s%s\"><figcaption>Plan %s</figcaption></figure>\n",
            caption, page->address, name, caption);
    return ST_OK;
}

static void put_exports(FILE *to, const struct edit_card *card, const char *name)
{
#define EXPORT_LINK(format, file, name, write) "/export/" file "\">" name "</a></li>\n",
    static const char *const links[] = {EXPORTS(EXPORT_LINK)};
    if (!card->exported) return;
    fputs("<p>For an architect, or another program:</p>\n<ul class=\"list\">\n", to);
    for (int i = 0; i < EXPORT_COUNT; i++) {
        if (!card->exports[i]) continue;
        fputs("<li><a href=\"", to);
        html_address(to, name);
        fputs(links[i], to);
    }
    fputs("</ul>\n", to);
}

static void put_film(FILE *to, const char *folder, const char *caption)
{
    fprintf(to, "<figure><video controls playsinline preload=\"metadata\" aria-label=\"%s\" src=\"", caption);
    html_address(to, folder);
    fprintf(to, "/tour/video.mp4\"></video><figcaption>%s</figcaption></figure>\n", caption);
}

struct command { /* what people give to make */
    const char *scene, *quality;
};

/* A sentence about what does not exist, with the goal of make that makes it. */
static void put_missing(FILE *to, bool missing, const char *what, const char *goal, const struct command *command)
{
    if (!missing) return;
    fprintf(to, "<p class=\"muted\">%s not made yet: <code>make %s SCENE=", what, goal);
    html_text(to, command->scene);
    if (command->quality) fputs(" QUALITY=", to);
    if (command->quality) html_text(to, command->quality);
    fputs("</code></p>\n", to);
}

/* What can be said of the pictures of a change. */
static void put_state(FILE *to, const struct rooms *rooms, const struct room_change *change,
                      const struct command *command)
{
    put_missing(to, !change->has_records, "The pictures of this change are", "remodel", command);
    if (change->has_records && !change->photos) fputs("<p>No photograph shows this change.</p>\n", to);
    if (!change->photos) return;
    for (int i = 0; i < rooms->photo_count; i++)
        for (int k = 0; k < rooms->photos[i].look_count; k++)
            if (&rooms->changes[rooms->photos[i].looks[k].change] == change) {
                fputs("<p>", to);
                page_put_plural(to, change->photos, "photograph shows", "photographs show");
                fputs(" it.</p>\n", to);
                return;
            }
    fputs("<p>The pictures of this change cannot be read; <a href=\"#how\">the reasons</a> are below.</p>\n", to);
}

static enum status put_edit(struct page *page, const char *scene, const struct remodel_contents *c, int number,
                            struct err *err)
{
    FILE *to = page->to;
    const struct edit_card *card = &c->edits[number];
    const struct room_change *change = &c->rooms.changes[number];
    const struct command command = {scene, c->quality};
    fprintf(to, "<section id=\"edit%d\">\n<h2>", number);
    page_put_change(to, change->name);
    fputs("</h2>\n", to);
    if (change->about[0]) {
        fputs("<p>", to);
        html_text(to, change->about);
        fputs("</p>\n", to);
    }
    put_state(to, &c->rooms, change, &command);
    relit_put_rounds(to, &card->relit);
    fputs("<div class=\"plans\">\n", to);
    if (put_plan(page, c->plan, "before", err) || put_plan(page, card->plan, "after", err)) return err->status;
    if (card->film) put_film(to, change->name, "A walk through the rooms after the change");
    fputs("</div>\n", to);
    put_exports(to, card, change->name);
    put_missing(to, !c->plan || !card->plan,
                c->plan ? "The plan after this change is" : "The plan of the rooms before is", "model", &command);
    put_missing(to, !card->film, "The film of a walk through these rooms is", "tour", &command);
    put_missing(to, !card->exported, "The model for other programs is", "exports", &command);
    fputs("</section>\n", to);
    return ST_OK;
}

enum status remodel_page_write(struct page *page, const char *scene, const char *back, const struct remodel_contents *c,
                               struct err *err)
{
    FILE *to = page->to;
    if (put_head(page, scene, back, c, err) || page_rooms(page, &c->rooms, err)) return err->status;
    if (c->film) {
        fputs("<section>\n<h2>The rooms as they are</h2>\n<div class=\"plans\">\n", to);
        put_film(to, "../model", "A walk through the rooms before any change");
        fputs("</div>\n</section>\n", to);
    }
    for (int i = 0; i < c->rooms.change_count; i++)
        if (put_edit(page, scene, c, i, err)) return err->status;
    if (!c->rooms.change_count)
        fputs("<p>There are no changes yet: describe one in the scene's folder <code>edits</code>.</p>\n", to);
    page_rooms_how(to, &c->rooms);
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION ".</footer>\n", to);
    if (page_put_part(page, "script", "page.js", err)) return err->status;
    fputs("</body>\n</html>\n", to);
    return ST_OK;
}
