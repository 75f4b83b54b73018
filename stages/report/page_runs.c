/* page_runs.c - the stages' runs: time and memory, parameters, warnings, and what was left out. */
#include <math.h>
#include <string.h>

#include "stages/report/page_parts.h"

/* NULL: it left no log. */
static const struct stage_usage *stage_at(const struct usage_table *t, const char *name)
{
    for (int i = 0; i < t->stage_count; i++)
        if (!strcmp(t->stages[i].sum.stage, name)) return &t->stages[i];
    return NULL;
}

static void put_bar(FILE *to, double part, double whole)
{
    fprintf(to, "<span class=\"bar\"><i style=\"width:%.1f%%\"></i></span>",
            whole > 0 ? fmax(100 * part / whole, 0.5) : 0.5);
}

static void put_usage_row(FILE *to, const struct stage_usage *s, const struct usage *max)
{
    fputs("<tr><th scope=\"row\">", to);
    html_text(to, s->sum.stage);
    if (s->unfinished) fprintf(to, " <span class=\"tag\">%d unfinished</span>", s->unfinished);
    fprintf(to, "</th><td class=\"n\">%d", s->runs);
    fputs("</td><td class=\"n\">", to);
    page_put_seconds(to, s->sum.wall);
    put_bar(to, s->sum.wall, max->wall);
    fputs("</td><td class=\"n\">", to);
    page_put_seconds(to, s->sum.cpu);
    put_bar(to, s->sum.cpu, max->cpu);
    fputs("</td><td class=\"n peak\">", to);
    page_put_mib(to, s->sum.mib);
    put_bar(to, s->sum.mib, max->mib);
    fputs("</td></tr>\n", to);
}

void page_usage(FILE *to, const struct contents *c)
{
    const struct usage_table *t = &c->usage;
    struct usage sum = {0}, max = {0};
    fputs("<section id=\"time\" aria-labelledby=\"time-title\">\n<h2 id=\"time-title\">Time and memory</h2>\n", to);
    if (!t->stage_count) {
        fputs("<p>There are no logs.</p>\n</section>\n", to);
        return;
    }
    for (int i = 0; i < t->stage_count; i++) {
        const struct usage *u = &t->stages[i].sum;
        sum = (struct usage){"", sum.wall + u->wall, sum.cpu + u->cpu, fmax(sum.mib, u->mib)};
        max = (struct usage){"", fmax(max.wall, u->wall), fmax(max.cpu, u->cpu), fmax(max.mib, u->mib)};
    }
    fputs("<p>Totals of the latest runs of each stage; runs of a stage may overlap in time. Memory is the largest "
          "peak of a single run.</p>\n<div class=\"card wide\" role=\"region\" aria-labelledby=\"time-title\" "
          "tabindex=\"0\"><table>\n<thead><tr>"
          "<th scope=\"col\">Stage</th><th scope=\"col\" class=\"n\">Runs</th><th scope=\"col\" class=\"n\">Wall "
          "time</th>"
          "<th scope=\"col\" class=\"n\">CPU time</th><th scope=\"col\" class=\"n\">Peak "
          "memory</th></tr></thead>\n<tbody>\n",
          to);
    for (int i = 0; i < c->stages.count; i++) {
        const struct stage_usage *s = stage_at(t, c->stages.names[i]);
        if (s) put_usage_row(to, s, &max);
    }
    for (int i = 0; i < t->stage_count; i++) /* logs of other programs */
        if (!stage_list_has(&c->stages, t->stages[i].sum.stage)) put_usage_row(to, &t->stages[i], &max);
    fputs("</tbody>\n<tfoot><tr><th scope=\"row\">Total</th><td></td><td class=\"n\">", to);
    page_put_seconds(to, sum.wall);
    fputs("</td><td class=\"n\">", to);
    page_put_seconds(to, sum.cpu);
    fputs("</td><td class=\"n\">", to);
    page_put_mib(to, sum.mib);
    fputs("</td></tr></tfoot>\n</table></div>\n</section>\n", to);
}

static void put_section_settings(FILE *to, const struct contents *c, int from, int end)
{
    const struct setting *items = c->settings.items;
    int changed = 0, known = 0;
    for (int i = from; i < end; i++) changed += items[i].changed, known += items[i].known;
    fputs(changed ? "<details open><summary><code>" : "<details><summary><code>", to);
    html_text(to, items[from].section[0] ? items[from].section : "no section");
    fputs("</code> <span class=\"muted\">", to);
    page_put_plural(to, end - from, "parameter", "parameters");
    if (changed)
        fprintf(to, ", %d changed", changed);
    else if (known == end - from)
        fputs(", all default", to);
    fputs("</span></summary>\n<table>\n<tbody>\n", to);
    for (int i = from; i < end; i++) {
        fputs(items[i].changed ? "<tr class=\"changed\"><th scope=\"row\"><code>" : "<tr><th scope=\"row\"><code>", to);
        html_text(to, items[i].key);
        fputs("</code></th><td><code>", to);
        html_text(to, items[i].value);
        fputs("</code></td><td class=\"how\">", to);
        if (items[i].changed)
            html_printf(to, "default %s", items[i].default_value[0] ? items[i].default_value : "is empty");
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table>\n</details>\n", to);
}

void page_settings(FILE *to, const struct contents *c)
{
    const struct setting *items = c->settings.items;
    fputs("<section id=\"parameters\" aria-labelledby=\"parameters-title\">\n<h2 "
          "id=\"parameters-title\">Parameters</h2>\n",
          to);
    if (!c->settings.count) {
        fputs("<p>There are no parameters.</p>\n</section>\n", to);
        return;
    }
    fputs("<div class=\"card\">\n", to);
    for (int k = 0; k <= c->stages.count; k++) /* sections of the stages in their order, then the others */
        for (int from = 0, end; from < c->settings.count; from = end) {
            const char *section = items[from].section;
            for (end = from + 1; end < c->settings.count && !strcmp(items[end].section, section);) end++;
            if (k < c->stages.count ? !strcmp(section, c->stages.names[k]) : !stage_list_has(&c->stages, section))
                put_section_settings(to, c, from, end);
        }
    fputs("</div>\n</section>\n", to);
}

void page_warnings(FILE *to, const struct contents *c)
{
    fputs("<section id=\"warnings\" aria-labelledby=\"warnings-title\">\n<h2 id=\"warnings-title\">Warnings</h2>\n",
          to);
    if (!c->usage.warning_count)
        fputs("<p>The logs contain no warnings.</p>\n", to);
    else
        fputs("<div class=\"card\"><ul class=\"list\">\n", to);
    for (int i = 0; i < c->usage.warning_count; i++) {
        const struct log_warning *w = &c->usage.warnings[i];
        fputs("<li><code>", to);
        html_text(to, w->stage);
        fputs("</code> <span class=\"muted\">", to);
        html_text(to, w->item);
        if (w->count > 1) fprintf(to, " and %d more", w->count - 1);
        fputs("</span><br>", to);
        html_text(to, w->text);
        fputs("</li>\n", to);
    }
    if (c->usage.warnings_dropped) fprintf(to, "<li>and %d more, in the logs</li>\n", c->usage.warnings_dropped);
    fputs(c->usage.warning_count ? "</ul></div>\n</section>\n" : "</section>\n", to);
}

/* The stages of the pipeline without a log; `report` is running. */
static void put_idle_stages(FILE *to, const struct contents *c)
{
    int count = 0;
    for (int i = 0; c->usage.stage_count && i < c->stages.count; i++) {
        const char *name = c->stages.names[i];
        if (stage_at(&c->usage, name) || !strcmp(name, REPORT_STAGE)) continue;
        fprintf(to, "%s<code>", count++ ? ", " : "<li>These stages left no log, so they have not run for this scene: ");
        html_text(to, name);
        fputs("</code>", to);
    }
    if (count) fputs(".</li>\n", to);
}

void page_left_out(FILE *to, const struct contents *c)
{
    int count = c->note_count + c->left_out_count;
    fputs(
        "<section id=\"skipped\" aria-labelledby=\"skipped-title\">\n<h2 id=\"skipped-title\">Left out, and why</h2>\n"
        "<div class=\"card\"><ul class=\"list\">\n",
        to);
    for (int i = 0; i < c->note_count; i++) {
        fputs("<li>", to);
        html_text(to, c->notes[i]);
        fputs("</li>\n", to);
    }
    for (int i = 0; i < c->left_out_count; i++) {
        fputs("<li><b>", to);
        html_text(to, c->left_out[i]);
        fputs(
            "</b> is in the folder of photographs but not in the scene's list: it was excluded, or added later.</li>\n",
            to);
    }
    for (int i = 0; c->has_views && i < c->photos.count; i++) {
        if (c->photo_cards[i].views || c->photo_cards[i].held_out) continue;
        fputs("<li><b>", to);
        html_text(to, c->photo_cards[i].record->file);
        fputs("</b> could not be placed: it has too few matches with the other photographs, or belongs to a smaller "
              "SfM model that was not used.</li>\n",
              to);
        count++;
    }
    if (!count) fputs("<li>No photograph is left out.</li>\n", to);
    put_idle_stages(to, c);
    fputs("</ul></div>\n</section>\n", to);
}
