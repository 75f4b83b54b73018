/* page_model.c - the axes of the room, the solid models and the furniture, to be checked by eye. */
#include "stages/report/page_parts.h"

enum status page_axes(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!c->axes_count) return ST_OK;
    fputs("<section id=\"axes\" aria-labelledby=\"axes-title\">\n<h2 id=\"axes-title\">Axes of the room</h2>\n"
          "<p class=\"muted\">x is red, y green, z blue. Yellow outlines the floor, cyan the ceiling: the rectangle of "
          "the "
          "outermost walls, drawn over whatever is in front of it.</p>\n<div class=\"pairs\">\n",
          to);
    for (int i = 0; i < c->axes_count; i++) {
        fputs("<figure>", to);
        if (page_put_picture(page, &c->axes[i].picture, 85, "Axes drawn on view", c->axes[i].view, err))
            return err->status;
        fputs("<figcaption><b>", to);
        html_text(to, c->axes[i].view);
        fputs("</b></figcaption></figure>\n", to);
    }
    fputs("</div>\n</section>\n", to);
    return ST_OK;
}

/* A picture that stands among the scene's products. */
static void put_model_picture(struct page *page, const char *folder, const char *file, const char *caption,
                              const char *name)
{
    FILE *to = page->to;
    if (!file) return;
    fprintf(to, "<figure><img loading=\"lazy\" alt=\"%s ", caption);
    html_text(to, name);
    fputs("\" src=\"", to);
    page_put_product(page, folder, file);
    fputs("\"><figcaption><b>", to);
    html_text(to, name);
    fprintf(to, "</b> %s</figcaption></figure>\n", caption);
}

/* Plan, view from above, and edges on the photographs. */
void page_models(struct page *page, const struct contents *c)
{
    FILE *to = page->to;
    if (!c->model_count) return;
    fputs("<section id=\"model\" aria-labelledby=\"model-title\">\n<h2 id=\"model-title\">Model</h2>\n", to);
    for (int i = 0; i < c->model_count; i++) {
        const struct model_card *m = &c->models[i];
        const char *name = m->name[0] ? m->name : "model";
        fputs("<h3>", to);
        html_text(to, m->name[0] ? m->name : "as photographed");
        fputs("</h3>\n<div class=\"pairs\">\n", to);
        put_model_picture(page, c->folder, m->plan, "plan", name);
        put_model_picture(page, c->folder, m->view, "from above, cut below the ceiling", name);
        fputs("</div>\n<details><summary>Edges on the photographs <span class=\"muted\">red: visible; thin: hidden "
              "by another part of the model; blue: glass</span></summary>\n<div class=\"pairs\">\n",
              to);
        for (int k = 0; k < m->overlay_count; k++)
            put_model_picture(page, c->folder, m->overlays[k], "edges of the model", m->overlay_ids[k]);
        fputs("</div>\n", to);
        if (m->overlays_left_out) {
            fputs("<p class=\"muted\">", to);
            page_put_plural(to, m->overlays_left_out, "more photograph is", "more photographs are");
            fputs(" in the folder remodel/", to);
            html_text(to, m->name);
            fputs("/overlay.</p>\n", to);
        }
        fputs("</details>\n", to);
    }
    fputs("</section>\n", to);
}

static void put_things_picture(struct page *page, const char *folder, const char *file, const char *alt,
                               const char *caption)
{
    if (!file) return;
    fprintf(page->to, "<figure><img loading=\"lazy\" alt=\"%s\" src=\"", alt);
    page_put_product(page, folder, file);
    fprintf(page->to, "\"><figcaption>%s</figcaption></figure>\n", caption);
}

void page_things(struct page *page, const struct contents *c)
{
    FILE *to = page->to;
    if (!c->thing_sheet && !c->thing_plan) return;
    fputs("<section id=\"things\" aria-labelledby=\"things-title\">\n<h2 id=\"things-title\">Things</h2>\n"
          "<p class=\"muted\">Furniture and whatever else is in front of the walls. An edit can clear, move or copy a "
          "thing that has a name in things.txt.</p>\n",
          to);
    put_things_picture(page, c->folder, c->thing_sheet, "Pictures of all things with their names",
                       "Each thing in the view that shows it best, with its size and its support.");
    put_things_picture(page, c->folder, c->thing_plan, "Plan of the rooms with all things",
                       "From above: the box around each thing. Dashed: it hangs on a wall or from the ceiling.");
    fputs("</section>\n", to);
}
