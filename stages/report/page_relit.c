/* page_relit.c - see page_relit.h. */
#include "stages/report/page_relit.h"

#include "stages/report/page_parts.h"

enum { QUALITY = 80 };

void relit_put_change(FILE *to, double changed, double bounded, double kept)
{
    fprintf(to, "The light changes on %.0f %% of this picture.", changed);
    if (bounded >= 0.5)
        fprintf(to,
                " On %.0f %% the change is a cautious guess (striped): the light that was found there does not explain "
                "how bright the photograph is.",
                bounded);
    if (kept >= 0.5)
        fprintf(to, " %.0f %% keeps its light: the outdoors, or nothing that the model of the room knows.", kept);
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

static enum status put_captioned(struct page *page, const struct picture *p, const char *caption, const char *view,
                                 struct err *err)
{
    FILE *to = page->to;
    if (!p->rgb) return ST_OK;
    fputs("<figure>", to);
    if (page_put_picture(page, p, QUALITY, caption, view, err)) return err->status;
    fprintf(to, "<figcaption>%s</figcaption></figure>\n", caption);
    return ST_OK;
}

static enum status put_row(struct page *page, const struct relit_sight *s, struct err *err)
{
    FILE *to = page->to;
    fprintf(to, "<div class=\"sight\" style=\"--n:%d\">\n", s->truth.rgb ? 5 : 4);
    if (put_captioned(page, &s->before, "the photograph", s->view, err) ||
        put_captioned(page, &s->unlit, "after the change, in the old light", s->view, err) ||
        put_captioned(page, &s->relit, "in the new light", s->view, err) ||
        put_captioned(page, &s->truth, "the truth", s->view, err) ||
        put_captioned(page, &s->ratio, "how the light changes", s->view, err))
        return err->status;
    fputs("</div>\n", to);
    fputs("<p class=\"muted\">", to);
    relit_put_change(to, s->changed, s->bounded, s->kept);
    fputs("</p>\n", to);
    return ST_OK;
}

enum status page_relit(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!c->relit_count) return ST_OK;
    fputs("<section id=\"relit\" aria-labelledby=\"relit-title\">\n<h2 id=\"relit-title\">Light of changes</h2>\n<p "
          "class=\"muted\">Of each edit, the view whose light "
          "changes most. ",
          to);
    fputs("How the light changes is shown in grey:</p>\n", to);
    relit_put_legend(to);
    for (int i = 0; i < c->relit_count; i++) {
        const struct relit_card *card = &c->relit[i];
        fputs("<h3>", to);
        html_text(to, card->name);
        fputs("</h3>\n", to);
        if (card->sight_count && put_row(page, &card->sights[0], err)) return err->status;
        if (!card->sight_count) fputs("<p class=\"muted\">The light of no picture changes.</p>\n", to);
        relit_put_rounds(to, card);
    }
    fputs("</section>\n", to);
    return ST_OK;
}
