/* page_few_numbers.c - what the scene is in a few numbers, each with a sentence, for people. */
#include "stages/report/page_parts.h"

static void begin(FILE *to, const char *name) { fprintf(to, "<div><dt>%s</dt><dd class=\"value\">", name); }

static void end(FILE *to, const char *sentence) { fprintf(to, "</dd><dd>%s</dd></div>\n", sentence); }

static void put_seconds_of_work(FILE *to, const struct usage_table *usage)
{
    double cpu = 0;
    for (int i = 0; i < usage->stage_count; i++) cpu += usage->stages[i].sum.cpu;
    if (!(cpu > 0)) return;
    begin(to, "Work of the computer");
    page_put_seconds(to, cpu);
    end(to, "of one processor core. With several cores it takes less time.");
}

void page_few_numbers(FILE *to, const struct contents *c)
{
    int placed = 0, held = 0;
    for (int i = 0; i < c->photos.count; i++) placed += c->photo_cards[i].views > 0, held += c->photo_cards[i].held_out;
    if (!c->photos.count && !c->usage.stage_count) return;
    fputs("<section id=\"few-numbers\" aria-labelledby=\"few-numbers-title\">\n<h2 id=\"few-numbers-title\">In a few "
          "numbers</h2>\n<dl class=\"few-numbers\">\n",
          to);
    if (c->has_views && c->photos.count) {
        begin(to, "Photographs used");
        fprintf(to, "%d of %d", placed, c->photos.count);
        end(to, placed + held < c->photos.count
                    ? "The others could not be placed: they show too little of what other photographs show."
                    : "All of them fit together.");
    }
    if (c->views.model.point_count) {
        begin(to, "Points found in space");
        fprintf(to, "%d", c->views.model.point_count);
        end(to, "Spots that several photographs show. From them it is known where the camera stood.");
        begin(to, "How well they fit");
        fprintf(to, "%.2f px", c->error_median);
        end(to, "Half of these spots lie in the photographs within so many pixels of where they should be. Below 1 is "
                "good.");
    }
    put_seconds_of_work(to, &c->usage);
    fputs("</dl>\n</section>\n", to);
}
