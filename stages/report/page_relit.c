/* page_relit.c - see page_relit.h.
 *
 * A view is one stack of pictures with a line: right of it the relit picture, left of it what the radio buttons before
 * it choose, which style sheets alone show and hide. */
#include "stages/report/page_relit.h"

#include "stages/report/page_parts.h"

enum { QUALITY = 86 };

const char relit_style[] =
    ".ba .left{position:absolute;inset:0;display:none;clip-path:inset(0 calc(100% - var(--p)) 0 0)}\n"
    ".ba .ratio{position:absolute;inset:0;display:none;clip-path:inset(0 0 0 var(--p))}\n"
    ".show:checked~.ba .ratio{display:block}.ba b.of{display:none;left:8px;right:auto}\n"
    ".c0:checked~.ba .k0,.c1:checked~.ba .k1,.c2:checked~.ba .k2{display:block}\n"
    ".light label{margin-right:12px}.light "
    "h3{margin-top:26px}.light>p{margin-top:12px}.legend{max-width:420px;margin:6px 0 12px}\n"
    ".legend .grey{height:12px;border-radius:3px;background:linear-gradient(90deg,#000,#808080,#fff);border:1px solid "
    "var(--line)}\n"
    ".key .bounded{background:repeating-linear-gradient(135deg,#808080 0 4px,#fff 4px 5px)}"
    ".key .alone{background:#282828}\n";

static enum status put_layer(FILE *to, const struct picture *p, const char *name, const char *alt, const char *view,
                             struct err *err)
{
    fprintf(to, "<div class=\"%s\">", name);
    page_put_picture(to, p, QUALITY, alt, view, err);
    fputs("</div>\n", to);
    return err->status;
}

/* Radio buttons: what is left of the line. */
static void put_choices(FILE *to, const struct relit_sight *s, int edit, int number)
{
    static const char *const words[] = {"the photograph", "the change in the old light", "the truth"};
    fputs("left of the line: ", to);
    for (int k = 0; k < (s->truth.rgb ? 3 : 2); k++)
        fprintf(to,
                "<input type=\"radio\" class=\"c%d\" name=\"l%d-%d\" id=\"l%d-%d-%d\"%s><label for=\"l%d-%d-%d\"> "
                "%s</label>",
                k, edit, number, edit, number, k, k == 1 ? " checked" : "", edit, number, k, words[k]);
    fprintf(to,
            "<br><input type=\"checkbox\" class=\"show\" id=\"q%d-%d\"><label for=\"q%d-%d\"> show how the light "
            "changes</label>\n",
            edit, number, edit, number);
}

static void put_shares(FILE *to, const struct relit_sight *s)
{
    fprintf(to, "<p class=\"muted\">The light changes on %.0f %% of this picture.", s->changed);
    if (s->bounded >= 0.5)
        fprintf(to,
                " On %.0f %% the change is a cautious guess (striped): the light that was found there does not explain "
                "how bright the photograph is.",
                s->bounded);
    if (s->kept >= 0.5)
        fprintf(to, " %.0f %% keeps its light: the outdoors, or nothing that the model of the room knows.", s->kept);
    fputs("</p>\n", to);
}

static enum status put_sight(FILE *to, const struct relit_sight *s, int edit, int number, struct err *err)
{
    fputs("<figure>\n", to);
    put_choices(to, s, edit, number);
    fputs("<div class=\"ba\">\n", to);
    if (put_layer(to, &s->relit, "relit", "In the new light, seen from", s->view, err) ||
        put_layer(to, &s->ratio, "ratio", "How the light changes, seen from", s->view, err) ||
        put_layer(to, &s->before, "left k0", "The photograph", s->view, err) ||
        put_layer(to, &s->unlit, "left k1", "After the change in the old light, seen from", s->view, err) ||
        (s->truth.rgb && put_layer(to, &s->truth, "left k2", "The truth, seen from", s->view, err)))
        return err->status;
    fputs("<i></i><b class=\"of k0\">photograph</b><b class=\"of k1\">old light</b>", to);
    if (s->truth.rgb) fputs("<b class=\"of k2\">truth</b>", to);
    fputs("<b>new light</b>", to);
    page_put_slider(to, "Line before the picture in the new light", s->photo);
    put_shares(to, s);
    fputs("</figure>\n", to);
    return ST_OK;
}

void relit_put_rounds(FILE *to, const struct relit_card *card)
{
    if (!card->rounds) return;
    fputs("<p class=\"muted\">Light was followed from wall to wall ", to);
    page_put_plural(to, card->rounds, "time", "times");
    if (card->missing < 0)
        fputs("; how much of it is still missing is unknown", to);
    else if (card->missing < 0.0005)
        fputs("; no place misses more than 0.1 % of its light by that", to);
    else
        fprintf(to, "; by that a place may miss up to %.2g %% of its light", 100 * card->missing);
    fputs(card->settled ? ".</p>\n" : ", more than was asked for.</p>\n", to);
}

void relit_put_legend(FILE *to)
{
    fputs("<div class=\"legend\"><div class=\"grey\"></div><div class=\"ticks\"><span>a quarter</span><span>half</span>"
          "<span>as before</span><span>twice</span><span>four times</span></div>\n<ul class=\"key\"><li><i "
          "class=\"flat bounded\"></i>striped: a cautious guess</li><li>a tint: the light changes its colour, "
          "too</li><li><i class=\"flat alone\"></i>light left as it "
          "was</li></ul></div>\n",
          to);
}

enum status relit_put_edit(FILE *to, const struct relit_card *card, int number, struct err *err)
{
    if (!card->views) return ST_OK;
    fputs("<div class=\"light\">\n<h3>In the new light</h3>\n", to);
    if (card->sight_count) {
        fputs("<p>The same change, with the light that it lets in or takes away. How the light changes is shown in "
              "grey:</p>\n",
              to);
        relit_put_legend(to);
    } else {
        fputs("<p>The light of no picture changes.</p>\n", to);
    }
    fputs("<div class=\"rooms\">\n", to);
    for (int i = 0; i < card->sight_count; i++)
        if (put_sight(to, &card->sights[i], number, i, err)) return err->status;
    fputs("</div>\n", to);
    relit_put_rounds(to, card);
    fputs("</div>\n", to);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------- the scene's page */

static enum status put_captioned(FILE *to, const struct picture *p, const char *caption, const char *view,
                                 struct err *err)
{
    if (!p->rgb) return ST_OK;
    fputs("<figure>", to);
    if (page_put_picture(to, p, QUALITY, caption, view, err)) return err->status;
    fprintf(to, "<figcaption>%s</figcaption></figure>\n", caption);
    return ST_OK;
}

static enum status put_row(FILE *to, const struct relit_sight *s, struct err *err)
{
    fprintf(to, "<div class=\"sight\" style=\"--n:%d\">\n", s->truth.rgb ? 5 : 4);
    if (put_captioned(to, &s->before, "the photograph", s->view, err) ||
        put_captioned(to, &s->unlit, "after the change, in the old light", s->view, err) ||
        put_captioned(to, &s->relit, "in the new light", s->view, err) ||
        put_captioned(to, &s->truth, "the truth", s->view, err) ||
        put_captioned(to, &s->ratio, "how the light changes", s->view, err))
        return err->status;
    fputs("</div>\n", to);
    put_shares(to, s);
    return ST_OK;
}

enum status page_relit(FILE *to, const struct contents *c, struct err *err)
{
    if (!c->relit_count) return ST_OK;
    fputs("<section id=\"relit\" aria-labelledby=\"relit-title\">\n<style>", to);
    fputs(relit_style, to);
    fputs(
        "</style>\n<h2 id=\"relit-title\">Light of changes</h2>\n<p class=\"muted\">Of each edit, the view whose light "
        "changes most. ",
        to);
    if (c->has_remodel_page)
        fputs("<a href=\"remodel/index.html\">The page of remodelled rooms</a> has more, with sliders. ", to);
    fputs("How the light changes is shown in grey:</p>\n", to);
    relit_put_legend(to);
    for (int i = 0; i < c->relit_count; i++) {
        const struct relit_card *card = &c->relit[i];
        fputs("<h3>", to);
        html_text(to, card->name);
        fputs("</h3>\n", to);
        if (card->sight_count && put_row(to, &card->sights[0], err)) return err->status;
        if (!card->sight_count) fputs("<p class=\"muted\">The light of no picture changes.</p>\n", to);
        relit_put_rounds(to, card);
    }
    fputs("</section>\n", to);
    return ST_OK;
}
