/* page_remodel.c - the page of a scene's edits: what each changes, before and after, its plans, models and films.
 *
 * For each edit, the picture before and after lie over each other with a slider, and a third layer shows where the
 * pixels come from: the photograph, textures of other views, synthesised texels. The shares below are of what the
 * photo's frame shows. Then come plans, links to models, and films.
 *
 * What does not exist yet is said with the goal of make that makes it, so the page tells what a scene could still
 * have.
 *
 * Pictures are in the page itself, as JPEGs of a few hundred pixels: it is one file that can be moved or sent; only
 * films and models are links. */
#include "stages/report/page_remodel.h"

#include <math.h>

#include "common/base/base64.h"
#include "common/base/version.h"
#include "common/texture/picture_made.h"
#include "stages/report/page_parts.h"
#include "stages/report/page_relit.h"
#include "stages/report/style.h"

enum { QUALITY = 88 };

static const char style[] =
    ".ba{position:relative;--p:50%;border-radius:6px;overflow:hidden;touch-action:pan-y}\n"
    ".ba img{width:100%;border-radius:0}.ba .before,.ba .sources{position:absolute;inset:0}\n"
    ".ba .before{clip-path:inset(0 calc(100% - var(--p)) 0 0)}\n"
    ".ba .sources{opacity:0;clip-path:inset(0 0 0 var(--p))}.show:checked~.ba .sources{opacity:.8}\n"
    ".ba i{position:absolute;top:0;bottom:0;left:var(--p);width:2px;background:#fff;box-shadow:0 0 4px #0008}\n"
    ".ba b{position:absolute;top:8px;padding:1px 8px;border-radius:4px;background:#000a;color:#fff;font-size:.8rem}\n"
    ".ba b:first-of-type{left:8px}.ba b:last-of-type{right:8px}\n"
    ".ba input{position:absolute;inset:0;width:100%;height:100%;margin:0;opacity:0;cursor:ew-resize}\n"
    ".ba:has(:focus-visible){outline:3px solid var(--accent);outline-offset:2px}\n"
    ".rooms{display:grid;gap:24px;grid-template-columns:repeat(auto-fill,minmax(min(100%,480px),1fr))}\n"
    ".plans{display:grid;gap:20px;grid-template-columns:repeat(auto-fill,minmax(min(100%,340px),1fr));margin:18px 0}\n"
    ".plans img{background:#fff;width:100%}.rooms label{font-size:.85rem;color:var(--muted)}\n"
    ".rooms p{font-size:.85rem;margin:4px 0 0}.key .flat{height:12px;width:22px}\n";

/* The name of an edit as words. */
static void put_name(FILE *to, const char *name)
{
    char words[256];
    snprintf(words, sizeof words, "%s", name);
    for (char *c = words; *c; c++)
        if (*c == '-' || *c == '_') *c = ' ';
    html_text(to, words);
}

static void put_head(FILE *to, const char *scene, const char *back, const struct remodel_contents *c)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
          "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
          "content=\"default-src 'none'; img-src data:; media-src 'self' file:; style-src 'unsafe-inline'; script-src "
          "'unsafe-inline'\">\n<meta name=\"generator\" content=\"remodel " REMODEL_VERSION
          "\">\n<link rel=\"icon\" href=\"data:,\">\n<title>",
          to);
    html_text(to, scene);
    fputs(", remodelled</title>\n<style>\n", to);
    fputs(page_style, to);
    fputs(style, to);
    fputs(relit_style, to);
    fputs("</style>\n</head>\n<body>\n<header>\n<h1>", to);
    html_text(to, scene);
    fputs(", remodelled</h1>\n<p class=\"lead\">Your rooms as they would look after each change. Move the line over a "
          "picture to compare: left of it the room as it is, right of it the room after the change.</p>\n<nav "
          "aria-label=\"Changes\">",
          to);
    for (int i = 0; i < c->edit_count; i++) {
        fprintf(to, "<a href=\"#edit%d\">", i);
        put_name(to, c->edits[i].name);
        fputs("</a>", to);
    }
    fputs("<a href=\"#how\">What is real</a>", to);
    if (back) {
        fputs("<a href=\"", to);
        html_address(to, back);
        fputs("\">How it was made</a>", to);
    }
    fputs("</nav>\n</header>\n<main>\n", to);
}

static enum status put_layer(FILE *to, const struct picture *p, const char *name, const char *alt, const char *view,
                             struct err *err)
{
    fprintf(to, "<div class=\"%s\">", name);
    page_put_picture(to, p, QUALITY, alt, view, err);
    fputs("</div>\n", to);
    return err->status;
}

/* How much of the picture is photograph, and how much is guessed; of what the photo's frame shows. */
static void put_shares(FILE *to, const struct edit_sight *s)
{
    const double scale = 100 / fmax(1, 100 - s->shares[MADE_NOTHING]);
    const double photo = scale * (s->shares[MADE_PHOTO] + s->shares[MADE_ORIGINAL]);
    const double other = scale * (s->shares[MADE_WARPED] + s->shares[MADE_OUTDOORS] + s->shares[MADE_CLUTTER]);
    const double guessed = scale * (s->shares[MADE_SYNTHESISED] + s->shares[MADE_UNSURE]);
    const double colour = scale * s->shares[MADE_COLOUR];
    fprintf(to, "<p class=\"muted\">%.0f %% of this picture is the photograph", photo);
    if (other >= 0.5) fprintf(to, ", %.0f %% comes from other photographs", other);
    if (guessed >= 0.5) fprintf(to, ", %.0f %% is guessed", guessed);
    if (colour >= 0.5) fprintf(to, ", %.0f %% is a plain colour", colour);
    fputs(".</p>\n", to);
}

static enum status put_sight(FILE *to, const struct edit_sight *s, int edit, int number, struct err *err)
{
    fprintf(to,
            "<figure>\n<input type=\"checkbox\" class=\"show\" id=\"s%d-%d\"><label for=\"s%d-%d\"> show what is "
            "real</label>\n<div class=\"ba\">\n",
            edit, number, edit, number);
    if (put_layer(to, &s->after, "after", "After the change, seen from", s->view, err) ||
        put_layer(to, &s->sources, "sources", "What each part comes from, seen from", s->view, err) ||
        put_layer(to, &s->before, "before", "Before the change, seen from", s->view, err))
        return err->status;
    fputs("<i></i><b>before</b><b>after</b>", to);
    page_put_slider(to, "Line between before and after", s->photo);
    put_shares(to, s);
    fputs("</figure>\n", to);
    return ST_OK;
}

static enum status put_plan(FILE *to, const char *file, const char *caption, struct err *err)
{
    if (!file) return ST_OK;
    fprintf(to, "<figure><img alt=\"Plan %s\" src=\"data:image/svg+xml;base64,", caption);
    if (base64_write_file(to, file, err)) return err->status;
    fprintf(to, "\"><figcaption>Plan %s</figcaption></figure>\n", caption);
    return ST_OK;
}

static void put_exports(FILE *to, const struct edit_card *card)
{
#define EXPORT_LINK(format, file, name, write) "/export/" file "\">" name "</a></li>\n",
    static const char *const links[] = {EXPORTS(EXPORT_LINK)};
    if (!card->exported) return;
    fputs("<p>For an architect, or another program:</p>\n<ul class=\"list\">\n", to);
    for (int i = 0; i < EXPORT_COUNT; i++) {
        if (!card->exports[i]) continue;
        fputs("<li><a href=\"", to);
        html_address(to, card->name);
        fputs(links[i], to);
    }
    fputs("</ul>\n", to);
}

static void put_film(FILE *to, const char *folder, const char *caption)
{
    fputs("<figure><video controls preload=\"metadata\" src=\"", to);
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

static enum status put_edit(FILE *to, const char *scene, const struct remodel_contents *c, int number, struct err *err)
{
    const struct edit_card *card = &c->edits[number];
    const struct command command = {scene, c->quality};
    fprintf(to, "<section id=\"edit%d\">\n<h2>", number);
    put_name(to, card->name);
    fputs("</h2>\n", to);
    if (card->about[0]) {
        fputs("<p>", to);
        html_text(to, card->about);
        fputs("</p>\n", to);
    }
    fputs("<div class=\"rooms\">\n", to);
    for (int i = 0; i < card->sight_count; i++)
        if (put_sight(to, &card->sights[i], number, i, err)) return err->status;
    fputs("</div>\n", to);
    put_missing(to, !card->views, "The pictures of this change are", "remodel", &command);
    if (card->views && !card->changed) fputs("<p>No photograph shows this change.</p>\n", to);
    if (card->changed && !card->sight_count)
        fputs("<p>The pictures of this change cannot be read; <a href=\"#how\">the reasons</a> are below.</p>\n", to);
    if (relit_put_edit(to, &card->relit, number, err)) return err->status;
    fputs("<div class=\"plans\">\n", to);
    if (put_plan(to, c->plan, "before", err) || put_plan(to, card->plan, "after", err)) return err->status;
    if (card->film) put_film(to, card->name, "A walk through the rooms after the change");
    fputs("</div>\n", to);
    put_exports(to, card);
    put_missing(to, !c->plan || !card->plan,
                c->plan ? "The plan after this change is" : "The plan of the rooms before is", "model", &command);
    put_missing(to, !card->film, "The film of a walk through these rooms is", "tour", &command);
    put_missing(to, !card->exported, "The model for other programs is", "exports", &command);
    fputs("</section>\n", to);
    return ST_OK;
}

/* What is sure of the light, and what is guessed. */
static void put_light(FILE *to, const struct remodel_contents *c)
{
    bool relit = false;
    for (int i = 0; i < c->edit_count; i++) relit |= c->edits[i].relit.views > 0;
    if (!relit) {
        fputs("The light is that of the day of the photographs: a new window does not brighten the room yet. ", to);
        return;
    }
    fputs(
        "The light is that of the day of the photographs, but for the pictures <b>in the new light</b>. These "
        "multiply the photograph by how much the light on each surface changes, calculated from the shape of the "
        "rooms and the light that the photographs show. So shadows and patches of sun that were photographed stay "
        "where the light stays, and patterns and colours are real. The change itself is calculated: it is sure where "
        "the photographs show where the light comes from, and a guess where they do not, such as the sky beyond what "
        "a window shows, or behind furniture. Where the guess would go wrong visibly it is limited, and the picture of "
        "the change is striped. Surfaces that the change makes are lit as if they were matt. ",
        to);
}

static void put_how(FILE *to, const struct remodel_contents *c)
{
    fputs(
        "<section id=\"how\">\n<h2>What is real</h2>\n<p>Where the change alters nothing, a picture is the photograph "
        "itself. Where it reveals something, other photographs fill in if they show it. What no photograph shows is "
        "guessed from what is beside it. ",
        to);
    put_light(to, c);
    fputs("Tick \"show what is real\" to see this in colours:</p>\n<ul class=\"key\">\n", to);
    for (int k = MADE_PHOTO; k < MADE_COUNT; k++) {
        const struct picture_made_kind *kind = picture_made_kind((enum picture_made)k);
        fprintf(to, "<li><i class=\"flat\" style=\"background:#%02x%02x%02x\"></i>%s</li>\n", kind->rgb[0],
                kind->rgb[1], kind->rgb[2], kind->label);
    }
    fputs("</ul>\n", to);
    if (c->note_count) fputs("<ul class=\"list\">\n", to);
    for (int i = 0; i < c->note_count; i++) {
        fputs("<li>", to);
        html_text(to, c->notes[i]);
        fputs("</li>\n", to);
    }
    if (c->note_count) fputs("</ul>\n", to);
    fputs("</section>\n", to);
}

enum status remodel_page_write(FILE *to, const char *scene, const char *back, const struct remodel_contents *c,
                               struct err *err)
{
    put_head(to, scene, back, c);
    if (c->film) {
        fputs("<section>\n<h2>The rooms as they are</h2>\n<div class=\"plans\">\n", to);
        put_film(to, "../model", "A walk through the rooms before any change");
        fputs("</div>\n</section>\n", to);
    }
    for (int i = 0; i < c->edit_count; i++)
        if (put_edit(to, scene, c, i, err)) return err->status;
    if (!c->edit_count)
        fputs("<p>There are no changes yet: describe one in the scene's folder <code>edits</code>.</p>\n", to);
    put_how(to, c);
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION ".</footer>\n</body>\n</html>\n", to);
    return ST_OK;
}
