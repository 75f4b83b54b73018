/* page_lens.c - the forms of lens that were compared, with the errors of the chosen and of the refused ones. */
#include "stages/report/page_parts.h"

#include <string.h>

static void put_known(FILE *to, const char *format, double value)
{
    fputs("<td class=\"n\">", to);
    if (value < 0)
        fputs("–", to);
    else
        fprintf(to, format, value);
    fputs("</td>", to);
}

void page_lens(FILE *to, const struct contents *c)
{
    if (!c->lens_form_count) return;
    fputs("<section id=\"lens\" aria-labelledby=\"lens-title\">\n<h2 id=\"lens-title\">Lens</h2>\n"
          "<p>Each form of lens was fitted to the photographs, with its principal point kept, shared, or free in each "
          "photo. The form with the lowest BIC is used: the simplest one that the photographs support.</p>\n"
          "<div class=\"card\"><table class=\"numbers\">\n<thead><tr><th scope=\"col\">Lens</th><th scope=\"col\">"
          "Principal point</th><th scope=\"col\">Parameters</th><th scope=\"col\">Median error, px</th>"
          "<th scope=\"col\">Noise, px</th><th scope=\"col\">BIC above the lowest</th><th scope=\"col\">Verdict</th>"
          "</tr></thead>\n<tbody>\n",
          to);
    for (int i = 0; i < c->lens_form_count; i++) {
        const struct lens_form_row *f = &c->lens_forms[i];
        const bool chosen = !strcmp(f->verdict, "chosen");
        fputs(chosen ? "<tr class=\"changed\"><th scope=\"row\">" : "<tr><th scope=\"row\">", to);
        html_text(to, f->lens);
        fputs("</th><td>", to);
        page_put_spaced(to, f->center);
        fputs("</td>", to);
        put_known(to, "%.0f", f->parameters);
        put_known(to, "%.3f", f->median);
        put_known(to, "%.3f", f->noise);
        put_known(to, "%.1f", f->bic);
        fputs("<td>", to);
        if (strcmp(f->verdict, "-")) html_text(to, f->verdict);
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table></div>\n</section>\n", to);
}
