/* plan_file.c - writes plan.txt and merged.txt. */
#include "stages/build_model/building/plan_file.h"

#include "common/base/scan.h"

#include "common/product/product.h"

static void print_plan(const struct plan *plan, FILE *to)
{
    static const char *const ends[] = {"free", "corner", "meets"};
    for (int i = 0; i < plan->wall_count; i++) {
        const struct plan_wall *w = &plan->walls[i];
        const struct plan_line in = plan_wall_face(w, SIDE_IN);
        double span[2];
        if (w->removed) continue;
        plan_wall_span(plan, i, span);
        fprintf(to, "wall %s normal %.17g %.17g at %.17g thickness %.17g from %.17g to %.17g foot %.17g top %.17g",
                w->name, in.n[0], in.n[1], in.c, w->thickness, span[0], span[1], w->foot,
                plan_wall_top(plan, i, span[0], span[1]));
        for (int e = 0; e < 2; e++) {
            fprintf(to, " %s %s", e ? "end" : "start", ends[w->ends[e].kind]);
            if (w->ends[e].kind != FREE_END) fprintf(to, " %s", plan->walls[w->ends[e].other].name);
        }
        fputc('\n', to);
    }
    for (int i = 0; i < plan->opening_count; i++) {
        const struct plan_opening *o = &plan->openings[i];
        if (plan_opening_is_there(plan, o))
            fprintf(to, "%s %s on %s from %.17g %.17g to %.17g %.17g %s\n", plan_opening_word(o->kind), o->name,
                    plan->walls[o->wall].name, o->s[0], o->z[0], o->s[1], o->z[1], o->fill ? "closed" : "open");
    }
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        if (r->removed) continue;
        fprintf(to, "room %s floor %.17g ceiling %.17g %.17g %.17g", r->name, r->floor, r->lower.a[0][0],
                r->lower.a[0][1], r->lower.a[0][2]);
        for (int e = 0; e < r->edge_count; e++)
            fprintf(to, " %s %.17g %.17g", plan->walls[r->edges[e].wall].name, r->edges[e].corner[0],
                    r->edges[e].corner[1]);
        fputc('\n', to);
    }
    for (int i = 0; i < plan->room_count; i++) {
        const struct plan_room *r = &plan->rooms[i];
        if (!r->removed && r->lower.count > 1)
            fprintf(to, "gable %s ceiling %.17g %.17g %.17g\n", r->name, r->lower.a[1][0], r->lower.a[1][1],
                    r->lower.a[1][2]);
    }
    for (int i = 0; i < plan->slot_count; i++) {
        const struct plan_slot *o = &plan->slots[i];
        if (plan_slot_is_there(plan, o))
            fprintf(to, "%s %s on %s from %.17g %.17g to %.17g %.17g %s\n", plan_opening_word(o->kind), o->name,
                    plan->rooms[o->room].name, o->low[0], o->low[1], o->high[0], o->high[1],
                    o->fill ? "closed" : "open");
    }
    for (int i = 0; i < plan->box_count; i++) {
        const struct plan_box *b = &plan->boxes[i];
        if (!b->removed)
            fprintf(to, "box %s %.17g %.17g %.17g %.17g %.17g %.17g turn %.17g\n", b->name, b->low[0], b->low[1],
                    b->low[2], b->high[0], b->high[1], b->high[2], b->turn);
    }
}

enum status plan_write(const struct plan *plan, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_PLAN, path, prov, err)) return err->status;
    const locale_t before = uselocale(scan_c_locale());
    print_plan(plan, f.fp);
    uselocale(before);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

enum status plan_merged_write(const struct unite_log *log, const char *path, const struct provenance *prov,
                              struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_MERGED, path, prov, err)) return err->status;
    for (int i = 0; i < log->count; i++) {
        const struct unite_note *n = &log->notes[i];
        if (n->event == UNITE_MERGED)
            fprintf(f.fp, "merged %s %s\n", n->name, n->into);
        else
            fprintf(f.fp, "hidden %s\n", n->name);
    }
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
