/* page_evaluation.c - the metrics of the scene, and held-out photographs beside what was rendered in their place. */
#include <string.h>

#include "common/base/metric_kinds.h"
#include "stages/report/page_parts.h"

static enum status put_held(struct page *page, const struct contents *c, const struct held_card *card, struct err *err)
{
    FILE *to = page->to;
    const struct picture *pictures[2] = {&card->picture, &card->frame};
    static const char *const ALT_TEXTS[2] = {"Held-out photograph", "Rendered in place of"};
    static const char *const LABELS[2] = {"photograph", "rendered"};
    fputs("<figure>\n<div class=\"pair\">", to);
    for (int k = 0; k < 2; k++) {
        fputs("<div>", to);
        if (!pictures[k]->rgb)
            fputs("<div class=\"none\">no picture yet</div>", to);
        else if (page_put_picture(page, pictures[k], 85, ALT_TEXTS[k], card->view->name, err))
            return err->status;
        fprintf(to, "<p class=\"under\">%s</p></div>", LABELS[k]);
    }
    fputs("</div>\n<figcaption><b>", to);
    html_text(to, card->view->name);
    fprintf(to, "</b> <span class=\"size\">%d × %d</span>", card->view->width, card->view->height);
    page_put_view_metric(to, c, card->view->name, "holdout.psnr", "PSNR");
    page_put_view_metric(to, c, card->view->name, "holdout.ssim", "SSIM");
    page_put_view_metric(to, c, card->view->name, "holdout.flip", "FLIP");
    page_put_view_metric(to, c, card->view->name, "holdout.holes", "holes");
    page_put_tag(to, card->problem);
    fputs("</figcaption>\n</figure>\n", to);
    return ST_OK;
}

static void put_metrics(FILE *to, const struct metric_rows *r)
{
    fputs("<div class=\"card wide\" role=\"region\" aria-labelledby=\"evaluation-title\" tabindex=\"0\"><table>\n"
          "<thead><tr><th scope=\"col\">Metric</th><th scope=\"col\" class=\"n\">Value</th><th scope=\"col\">Unit</th>"
          "<th scope=\"col\">Better</th><th scope=\"col\">Meaning</th></tr></thead>\n<tbody>\n",
          to);
    for (int i = 0; i < r->count; i++) {
        const struct metric_row *m = &r->rows[i];
        struct metric_kind kind;
        fputs("<tr><th scope=\"row\"><code>", to);
        html_text(to, m->name);
        fprintf(to, "</code></th><td class=\"n\">%.5g</td><td>", m->value);
        html_text(to, strcmp(m->unit, "1") ? m->unit : "");
        fputs("</td><td>", to);
        html_text(to, strcmp(m->direction, "none") ? m->direction : "");
        fputs("</td><td class=\"how\">", to);
        html_text(to, metric_kind_find(&kind, m->name) ? kind.meaning : "");
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table></div>\n", to);
}

enum status page_evaluation(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!c->has_metrics && !c->held.view_count) return ST_OK;
    fputs("<section id=\"evaluation\" aria-labelledby=\"evaluation-title\">\n<h2 id=\"evaluation-title\">Evaluation "
          "against truth and held-out photographs</h2>\n",
          to);
    if (c->metrics.count)
        put_metrics(to, &c->metrics);
    else
        fputs("<p>There are no metrics yet.</p>\n", to);
    if (c->metrics.note_count) fputs("<ul class=\"list muted\">\n", to);
    for (int i = 0; i < c->metrics.note_count; i++) {
        fputs("<li>", to);
        html_text(to, c->metrics.notes[i]);
        fputs("</li>\n", to);
    }
    if (c->metrics.note_count) fputs("</ul>\n", to);
    if (c->held.view_count) fputs("<h3>Held-out photographs</h3>\n<div class=\"pairs\">\n", to);
    for (int i = 0; i < c->held.view_count; i++)
        if (put_held(page, c, &c->held_cards[i], err)) return err->status;
    if (c->held.view_count) fputs("</div>\n", to);
    fputs("</section>\n", to);
    return ST_OK;
}
