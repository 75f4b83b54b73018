/* page_light.c - the light of the room: its lamps, its materials, and what arrives where.
 *
 * Numbers are shown with what is known of them: A ± B for what was measured, A alone for what was given. Shares
 * below 0.05 % are left out.
 *
 * The plot of a lamp has a point for each marked place: to the right its luminance in the photographs, upwards as
 * the fit explains it. A perfect fit lies on the diagonal. Both axes end at 1, 2 or 5 times a power of ten. Below it
 * stands the median of |photograph / fit - 1|.
 *
 * Light by source is given in words with a bar, sources that can be trusted (lamps, what photographs show) apart
 * from guesses. Legends of the pictures give the ends of their colours in numbers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/image/false_colour.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "stages/report/page_parts.h"

enum { QUALITY = 85 };
static const double LISTED = 0.0005; /* a smaller share of the light is left out */

/* "A ± B", or A alone if it was given. */
static void put_measured(FILE *to, double value, double error)
{
    fprintf(to, value < 999.5 ? "%.3g" : "%.0f", value);
    if (error > 0) fprintf(to, error < 99.5 ? " ± %.2g" : " ± %.0f", error);
}

static void begin_entry(FILE *to, const char *term) { fprintf(to, "<div><dt>%s</dt><dd>", term); }
static void end_entry(FILE *to) { fputs("</dd></div>\n", to); }

/* ----------------------------------------------------------------------------------------------------------- lamps */

static const char *source_of(const struct lamp_card *card)
{
    static const char *const words[][2] = {
        {"given", "as stated in the marks"},
        {"fitted", "worked out from how much brighter the lit places are than the unlit ones"},
        {"measured", "read off the lamp's own picture"},
        {"bound", "at least this: the lamp is overexposed in every photograph"},
        {"unseen", "worked out from the light that it throws; nobody marked it"}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(card->source, words[i][0])) return words[i][1];
    return "unknown";
}

static void put_cone(FILE *to, const struct lamp_card *card)
{
    const double beta = card->lamp->beta / DEGREE;
    begin_entry(to, "spread of the light");
    if (beta < 89.5)
        put_measured(to, beta, card->beta_error), fputs("° to each side of its axis", to);
    else
        fputs("to all sides", to);
    if (card->lamp->exponent > 0) {
        fputs(", weaker towards the edge (exponent ", to);
        put_measured(to, card->lamp->exponent, card->exponent_error);
        fputs(")", to);
    }
    end_entry(to);
}

static void put_lamp_facts(FILE *to, const struct lamp_card *card)
{
    const struct rgb s = card->lamp->radiance;
    const double value[3] = {s.r, s.g, s.b};
    static const char *const names[3] = {"red ", ", green ", ", blue "};
    fputs("<dl class=\"scores\">\n", to);
    begin_entry(to, "brightness");
    for (int c = 0; c < 3; c++) fputs(names[c], to), put_measured(to, value[c], card->radiance_error[c]);
    end_entry(to);
    begin_entry(to, "how it was found");
    fputs(source_of(card), to);
    end_entry(to);
    put_cone(to, card);
    if (card->unsaturated || card->saturated) {
        begin_entry(to, "the lamp in the photographs");
        fprintf(to, "%s", card->unsaturated ? "" : "at least ");
        put_measured(to, luminance_of_doubles(card->seen), luminance_of_doubles(card->seen_error));
        fprintf(to, ", in ");
        page_put_plural(to, card->unsaturated + card->saturated, "view", "views");
        if (card->saturated) fprintf(to, ", %d overexposed", card->saturated);
        if (card->disagrees) page_put_tag(to, "disagrees with the fit");
        end_entry(to);
    }
    fputs("</dl>\n", to);
}

/* 1, 2 or 5 times a power of ten, not below x. */
static double round_up(double x)
{
    const double step = pow(10, floor(log10(x)));
    return x <= step ? step : x <= 2 * step ? 2 * step : x <= 5 * step ? 5 * step : 10 * step;
}

/* The median of |photograph / fit - 1|; -1: nothing to compare. */
static double median_misfit(const struct lamp_card *card)
{
    double *off = malloc(((size_t)card->point_count + 1) * sizeof *off), found = -1;
    size_t n = 0;
    for (int i = 0; off && i < card->point_count; i++)
        if (card->points[i].explained > 0) off[n++] = fabs(card->points[i].seen / card->points[i].explained - 1);
    if (n) {
        sort_doubles(off, n);
        found = off[n / 2];
    }
    free(off);
    return found;
}

/* The points of a lamp: brightness in the photographs to the right, as the fit explains it upwards. */
static void put_fit_plot(FILE *to, const struct lamp_card *card)
{
    const double left = 44, right = 348, high = 12, low = 316, misfit = median_misfit(card);
    double most = 0;
    int lit = 0;
    for (int i = 0; i < card->point_count; i++) {
        most = fmax(most, fmax(card->points[i].seen, card->points[i].explained));
        lit += card->points[i].lit;
    }
    if (!(most > 0)) return;
    const double top = round_up(most);
    fprintf(to,
            "<svg class=\"plot square\" viewBox=\"0 0 360 360\" role=\"img\" aria-label=\"Brightness of %d marked "
            "places, in the photographs and by the fit; half of them differ by less than %.2g %%.\">\n",
            card->point_count, 100 * fmax(misfit, 0));
    for (int k = 0; k <= 2; k++) {
        const double x = left + (right - left) * k / 2, y = low - (low - high) * k / 2;
        fprintf(to, "<line class=\"grid\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\"/>", left, right, y, y);
        fprintf(to, "<line class=\"grid\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\"/>", x, x, high, low);
        fprintf(to, "<text x=\"38\" y=\"%.0f\" text-anchor=\"end\">%.3g</text>", y + 4, top * k / 2);
        fprintf(to, "<text x=\"%.0f\" y=\"332\" text-anchor=\"middle\">%.3g</text>\n", x, top * k / 2);
    }
    fprintf(to, "<line class=\"even\" x1=\"%.0f\" x2=\"%.0f\" y1=\"%.0f\" y2=\"%.0f\"/>\n", left, right, low, high);
    for (int i = 0; i < card->point_count; i++) {
        const struct light_point *p = &card->points[i];
        fprintf(to, "<circle class=\"%s\" cx=\"%.1f\" cy=\"%.1f\" r=\"3\"/>\n", p->lit ? "lit" : "unlit",
                left + (right - left) * p->seen / top, low - (low - high) * p->explained / top);
    }
    fputs("<text x=\"196\" y=\"352\" text-anchor=\"middle\">brightness in the photographs</text>\n"
          "<text transform=\"translate(10 164) rotate(-90)\" text-anchor=\"middle\">calculated</text>\n</svg>\n"
          "<ul class=\"key\"><li><i class=\"before\"></i>",
          to);
    page_put_plural(to, lit, "lit place", "lit places");
    fputs("</li><li><i class=\"after\"></i>", to);
    page_put_plural(to, card->point_count - lit, "unlit place", "unlit places");
    fputs("</li></ul>\n", to);
    if (misfit >= 0)
        fprintf(to,
                "<p class=\"muted\">On the diagonal, photographs and calculation agree. Half of the places differ "
                "by less than %.2g %%.</p>\n",
                100 * misfit);
}

static enum status put_lamp(struct page *page, const struct lamp_card *card, struct err *err)
{
    FILE *to = page->to;
    fputs("<h4>", to);
    html_text(to, card->lamp->name);
    fputs("</h4>\n<div class=\"effect\"><div>", to);
    if (card->picture.rgb) {
        fputs("<figure>", to);
        if (page_put_picture(page, &card->picture, QUALITY, "The light of lamp", card->lamp->name, err))
            return err->status;
        fputs("<figcaption>", to);
        fputs(card->lamp->beta / DEGREE < 89.5 ? "Orange: where the lamp's cone of light ends on the surfaces of the "
                                                 "model; furniture that the model lacks does not stop it. "
                                               : "",
              to);
        fputs("Green: the lamp. Yellow dots: places marked as lit by it; blue: as not lit; violet: lines across the "
              "edge of its light.</figcaption></figure>",
              to);
    } else {
        fputs("<div class=\"none\">no view shows this lamp or its light</div>", to);
    }
    fputs("</div><div>", to);
    put_fit_plot(to, card);
    if (!card->point_count) fputs("<p class=\"muted\">No places are marked for this lamp.</p>\n", to);
    fputs("</div>\n", to);
    put_lamp_facts(to, card);
    fputs("</div>\n", to);
    return ST_OK;
}

static enum status put_lamps(struct page *page, const struct light_contents *l, struct err *err)
{
    FILE *to = page->to;
    const struct light_list *list = &l->lights;
    if (!list->lamp_count && !list->opening_count) return ST_OK;
    fputs("<h3>Lamps and windows</h3>\n<p class=\"muted\">", to);
    page_put_plural(to, list->lamp_count, "lamp", "lamps");
    fputs(" and ", to);
    page_put_plural(to, list->opening_count, "window or opening", "windows or openings");
    fputs(" that daylight comes through", to);
    for (int i = 0; i < list->opening_count; i++) {
        fputs(i ? ", " : ": ", to);
        html_text(to, list->openings[i].name);
    }
    fputs(
        ". Brightness is in the unit of the photographs. What follows ± is the half width of the range that holds the "
        "true value 95 times in 100, as far as the calculation can tell.</p>\n",
        to);
    for (int i = 0; i < list->lamp_count; i++)
        if (put_lamp(page, &l->lamps[i], err)) return err->status;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- materials */

static void put_swatch(FILE *to, const struct material *m)
{
    unsigned char rgb[3];
    for (int c = 0; c < 3; c++) rgb[c] = (unsigned char)lround(255 * (double)srgb_from_linear((float)(PI * m->k_d[c])));
    fprintf(to, "<i class=\"swatch\" style=\"background:#%02x%02x%02x\"></i>", rgb[0], rgb[1], rgb[2]);
}

static void put_range(FILE *to, double value, struct material_range r, double scale, const char *unit)
{
    fprintf(to, "%.3g%s <span class=\"muted\">(%.3g to ", scale * value, unit, scale * r.low);
    if (isfinite(r.high))
        fprintf(to, "%.3g)</span>", scale * r.high);
    else
        fputs("no limit)</span>", to);
}

static void put_gloss(FILE *to, const struct material *m)
{
    if (m->kind == BRDF_LAMBERT) {
        fputs("dull", to);
        return;
    }
    fputs("k<sub>s</sub> ", to);
    put_range(to, m->ks, m->ks_range, 1, "");
    fputs(m->kind == BRDF_WARD ? "<br>roughness " : "<br>exponent ", to);
    put_range(to, m->shape, m->shape_range, 1, "");
}

static void put_material_row(FILE *to, const struct material *m)
{
    static const char *const names[3] = {"red ", "<br>green ", "<br>blue "};
    fputs("<tr><th scope=\"row\">", to);
    put_swatch(to, m);
    html_text(to, m->name);
    fprintf(to, "</th><td>%s</td><td>", material_kind_name(m->kind));
    for (int c = 0; c < 3; c++) fputs(names[c], to), put_range(to, m->k_d[c], m->k_d_range[c], 100 * PI, " %");
    fputs("</td><td>", to);
    put_gloss(to, m);
    fprintf(to, "</td><td>%d samples of %d points in %d views, off by %.2g times the noise: ", m->samples, m->points,
            m->views, m->scale);
    html_text(to, m->why ? m->why : "no reason is recorded");
    fputs("</td></tr>\n", to);
}

static enum status put_materials(struct page *page, const struct light_contents *l, struct err *err)
{
    FILE *to = page->to;
    if (!l->materials.count) return ST_OK;
    fputs(
        "<h3>Materials</h3>\n<p class=\"muted\">How the marked surfaces reflect light: the share of red, green and "
        "blue "
        "light that comes back in all directions, and the gloss on top of it. In parentheses: the range that holds the "
        "true value 95 times in 100. The last column says why this model of the surface was chosen.</p>\n"
        "<div class=\"card\"><table "
        "class=\"materials\"><thead><tr><th>material</th><th>model</th><th>reflects</th><th>gloss</th>"
        "<th>evidence</th></tr></thead><tbody>\n",
        to);
    for (int i = 0; i < l->materials.count; i++) put_material_row(to, &l->materials.items[i]);
    fputs("</tbody></table></div>\n<div class=\"pairs\">\n", to);
    for (int i = 0; i < l->materials.count; i++) {
        const struct material_card *card = &l->material_cards[i];
        if (!card->residuals.rgb) continue;
        fputs("<figure>", to);
        if (page_put_picture(page, &card->residuals, QUALITY, "Residuals of material", card->material->name, err))
            return err->status;
        fputs("<figcaption><b>", to);
        html_text(to, card->material->name);
        fputs("</b> red: brighter in the photograph than calculated; blue: darker; white: equal; full colour at "
              "25 %</figcaption></figure>\n",
              to);
    }
    fputs("</div>\n", to);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ irradiance */

static void put_share(FILE *to, double share, const char *what, bool trusted)
{
    if (share < LISTED) return;
    fprintf(to,
            "<tr><th scope=\"row\">%s</th><td class=\"n\">%.1f %%<span class=\"bar%s\"><i style=\"width:%.1f%%\">"
            "</i></span></td></tr>\n",
            what, 100 * share, trusted ? "" : " peak", 100 * fmin(share, 1));
}

static void put_shares(FILE *to, const struct light_record *r)
{
    fputs("<table class=\"shares\"><caption>Where this light comes from</caption><tbody>\n", to);
    put_share(to, r->from[LIGHT_TEXTURE], "walls, floors and ceilings that photographs show", true);
    put_share(to, r->from[LIGHT_MATERIAL], "surfaces whose material was fitted", true);
    put_share(to, r->from[LIGHT_OBJECT], "furniture and objects", true);
    put_share(to, r->from[LIGHT_LAMP], "lamps", true);
    put_share(to, r->from[LIGHT_SKY], "the outdoors, as photographed", true);
    put_share(to, r->from[LIGHT_SYNTHESISED], "surfaces that no photograph shows: filled in", false);
    put_share(to, r->from[LIGHT_SKY_GUESSED], "the outdoors beyond all photographs: guessed", false);
    put_share(to, r->from[LIGHT_NONE], "places without any picture", false);
    fputs("</tbody></table>\n", to);
}

static void put_error(FILE *to, const struct light_record *r)
{
    fputs("<p class=\"muted\">", to);
    page_put_plural(to, r->points, "place was", "places were");
    fputs(" calculated. ", to);
    if (r->error[2] > 0)
        fprintf(to,
                "By the calculation's own estimate half of them are off by less than %.2g %%, 95 of 100 by less than "
                "%.2g %%, all by less than %.2g %%; errors of the model and of the pictures come on top. ",
                100 * r->error[0], 100 * r->error[1], 100 * r->error[2]);
    if (r->dark) {
        page_put_plural(to, r->dark, "place gets", "places get");
        fputs(" no light. ", to);
    }
    fputs("</p>\n", to);
}

static void put_ticks(FILE *to, double low, double middle, double high, double scale, const char *unit)
{
    fprintf(to,
            "<div class=\"ramp\"></div><div class=\"ticks\"><span>%.3g%s</span><span>%.3g%s</span><span>%.3g%s</span>"
            "</div>",
            scale * low, unit, scale * middle, unit, scale * high, unit);
}

static enum status put_captioned(struct page *page, const struct picture *p, const char *alt, const char *name,
                                 const char *caption, const double *range, struct err *err)
{
    FILE *to = page->to;
    if (!p->rgb) return ST_OK;
    fputs("<figure>", to);
    if (page_put_picture(page, p, QUALITY, alt, name, err)) return err->status;
    if (range) put_ticks(to, range[0], range[1], range[2], range[3], range[3] > 1 ? " %" : "");
    fprintf(to, "<figcaption>%s</figcaption></figure>\n", caption);
    return ST_OK;
}

static enum status put_view(struct page *page, const struct gather_card *g, struct err *err)
{
    FILE *to = page->to;
    const double *level = g->record.level;
    const double levels[4] = {level[0], sqrt(level[0] * level[1]), level[1], 1}, shares[4] = {0, 0.5, 1, 100};
    fputs("<div class=\"pairs\">\n", to);
    if (put_captioned(page, &g->photo, "View", g->name, "The photograph.", NULL, err) ||
        put_captioned(page, &g->white, "Light of view", g->name,
                      "The light alone: the room of the model as if everything in it were painted white. The dots are "
                      "the places of the views all round below.",
                      NULL, err) ||
        put_captioned(page, &g->level, "Irradiance of view", g->name,
                      "How much light arrives (irradiance, in the unit of the photographs). Equal steps of colour are "
                      "equal factors.",
                      levels, err) ||
        put_captioned(page, &g->unknown, "Unknown light of view", g->name,
                      "How much of this light is made up, because no photograph shows where it comes from.", shares,
                      err))
        return err->status;
    fputs("</div>\n", to);
    return ST_OK;
}

static void put_place(FILE *to, const struct light_example *e)
{
    const struct vec3 n = e->point.normal;
    fputs(n.z > 0.9 ? "on a floor or table" : n.z < -0.9 ? "at a ceiling" : "on a wall", to);
    fprintf(to, " at %.2f %.2f %.2f", e->point.at.x, e->point.at.y, e->point.at.z);
}

static enum status put_hemicubes(struct page *page, const struct gather_card *g, struct err *err)
{
    FILE *to = page->to;
    const struct light_record *r = &g->record;
    bool any = false;
    for (int i = 0; i < r->example_count; i++) any |= g->hemicubes[i].rgb != NULL;
    if (!any) return ST_OK;
    fputs("<p class=\"muted\">What a place sees, all round: half a cube over it, unfolded. The middle is straight "
          "ahead of "
          "the surface; the four sides reach down to it. Striped: made up, no photograph shows it.</p>\n"
          "<ul class=\"strip hemicubes\">\n",
          to);
    for (int i = 0; i < r->example_count; i++) {
        unsigned char rgb[3];
        if (!g->hemicubes[i].rgb) continue;
        colour_of_category(i, rgb);
        fputs("<li><figure>", to);
        if (page_put_picture(page, &g->hemicubes[i], QUALITY, "View all round, unfolded, of a place of", g->name, err))
            return err->status;
        fprintf(to, "<figcaption><i class=\"swatch\" style=\"background:#%02x%02x%02x\"></i>", rgb[0], rgb[1], rgb[2]);
        put_place(to, &r->examples[i]);
        fprintf(to, "; light %.3g ± %.2g %%", rgb_luminance(r->examples[i].value), 100 * r->examples[i].error);
        fputs(r->example_count < 2        ? ""
              : i == 0                    ? "<br>the least sure place"
              : i == r->example_count - 1 ? "<br>the surest place"
                                          : "",
              to);
        fputs("</figcaption></figure></li>\n", to);
    }
    fputs("</ul>\n", to);
    return ST_OK;
}

static enum status put_gathers(struct page *page, const struct light_contents *l, struct err *err)
{
    FILE *to = page->to;
    if (!l->gather_count) return ST_OK;
    fputs("<h3>The light that arrives</h3>\n<p class=\"muted\">Calculated from the pictures of the surfaces, the lamps "
          "and "
          "the outdoors: what a surface gets from everywhere around it.</p>\n",
          to);
    for (int i = 0; i < l->gather_count; i++) {
        const struct gather_card *g = &l->gathers[i];
        fputs("<h4>", to);
        if (g->is_view)
            html_printf(to, "View %s", g->name);
        else if (!strcmp(g->name, "irradiance"))
            fputs("Chosen points", to);
        else
            html_text(to, g->name);
        fputs("</h4>\n", to);
        if (g->is_view && put_view(page, g, err)) return err->status;
        put_shares(to, &g->record);
        put_error(to, &g->record);
        if (put_hemicubes(page, g, err)) return err->status;
    }
    return ST_OK;
}

enum status page_light(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!light_contents_any(&c->light)) return ST_OK;
    fputs("<section id=\"light\" aria-labelledby=\"light-title\" style=\"--ramp:", to);
    page_put_ramp(to, true);
    fputs("\">\n<h2 id=\"light-title\">Light</h2>\n", to);
    if (put_lamps(page, &c->light, err) || put_materials(page, &c->light, err) || put_gathers(page, &c->light, err))
        return err->status;
    fputs("</section>\n", to);
    return ST_OK;
}
