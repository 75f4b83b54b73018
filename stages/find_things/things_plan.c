/* things_plan.c - see things_plan.h.
 *
 * What hangs from the ceiling is drawn first and what stands on the floor last, so that a lamp hides no table. A name
 * is in the middle of its box. Where another name is already there, it moves up or down by lines to the nearest place
 * that is free. */
#include "stages/find_things/things_plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/model/plan_sheet.h"

#define LINE   15.0 /* px, of a name's height */
#define LETTER 7.5  /* px, of a letter's width, nearly */

enum { MAX_LINES = 12 }; /* that a name moves */

struct name_place { /* px of the sheet */
    double x, y, half_width;
};

static void put_box(const struct plan_sheet *s, const struct thing *t)
{
    static const char *const classes[THING_SUPPORTS] = {"thing", "thing hung", "thing hung high", "thing hung"};
    double p[4][2] = {{t->low.x, t->low.y}, {t->high.x, t->low.y}, {t->high.x, t->high.y}, {t->low.x, t->high.y}};
    plan_sheet_put_polygon(s, p, 4, classes[t->support]);
}

static bool is_free(const struct name_place *places, int count, const struct name_place *at)
{
    for (int i = 0; i < count; i++)
        if (fabs(places[i].y - at->y) < LINE && fabs(places[i].x - at->x) < places[i].half_width + at->half_width)
            return false;
    return true;
}

static void put_name(const struct plan_sheet *s, const struct thing *t, struct name_place *places, int count)
{
    const double x = 0.5 * (t->low.x + t->high.x), y = 0.5 * (t->low.y + t->high.y);
    struct name_place at = {plan_sheet_x(s, x), plan_sheet_y(s, y), 0.5 * LETTER * (double)strlen(t->name)};
    const double middle = at.y;
    for (int k = 1; k <= 2 * MAX_LINES && !is_free(places, count, &at); k++)
        at.y = middle + (k & 1 ? 1 : -1) * ((k + 1) / 2) * LINE;
    if (!is_free(places, count, &at)) at.y = middle;
    places[count] = at;
    plan_sheet_put_text(s, x, y - (at.y - middle + 0.3 * LINE) / s->scale,
                        t->support == THING_ON_CEILING ? "label high" : "label", t->name);
}

enum status things_plan_write(const struct thing_list *list, const struct model_plan *plan, const char *path,
                              struct err *err)
{
    static const enum thing_support order[THING_SUPPORTS] = {THING_ON_CEILING, THING_ON_NONE, THING_ON_WALL,
                                                             THING_ON_FLOOR};
    struct outfile f = {0};
    struct plan_sheet s = {0};
    struct name_place *places = malloc(((size_t)list->count + 1) * sizeof *places);
    if (!places) return err_nomem(err, "names", (size_t)list->count * sizeof *places);
    if (!outfile_open(&f, path, err)) {
        plan_sheet_fit(&s, plan);
        for (int i = 0; i < list->count; i++) {
            plan_sheet_hold(&s, list->things[i].low.x, list->things[i].low.y);
            plan_sheet_hold(&s, list->things[i].high.x, list->things[i].high.y);
        }
        plan_sheet_begin(&s, f.fp, "Furniture on the plan of the model",
                         ".thing{fill:#1f78c8;fill-opacity:.18;stroke:#1f78c8;stroke-width:1.5}"
                         ".hung{stroke-dasharray:6 4}.high{fill:none;stroke:#999}"
                         ".label{font-size:13px;fill:#0b3d66;stroke:#fff;stroke-width:3;paint-order:stroke}"
                         ".label.high{fill:#777;stroke:#fff}");
        plan_sheet_put_plan(&s, plan);
        for (int k = 0; k < THING_SUPPORTS; k++)
            for (int i = 0; i < list->count; i++)
                if (list->things[i].support == order[k]) put_box(&s, &list->things[i]);
        for (int k = THING_SUPPORTS - 1, count = 0; k >= 0; k--) /* names of furniture move least */
            for (int i = 0; i < list->count; i++)
                if (list->things[i].support == order[k]) put_name(&s, &list->things[i], places, count++);
        plan_sheet_end(&s);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    free(places);
    return err->status;
}
