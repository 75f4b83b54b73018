/* page_depths.c - each view beside its depth map, and the true depth where there is one. */
#include "stages/report/page_parts.h"

static enum status put_depth(struct page *page, const struct view_card *card, struct err *err)
{
    FILE *to = page->to;
    if (!card->depth.z) {
        fputs("<div class=\"none\">no depth yet</div>", to);
        return ST_OK;
    }
    if (!card->depth_picture.rgb) {
        fputs("<div class=\"none\">no pixel has a depth</div>", to);
        return ST_OK;
    }
    if (page_put_picture(page, &card->depth_picture, 80, "Depth of view", card->view->name, err)) return err->status;
    fprintf(to,
            "<div class=\"ramp\"></div><div class=\"ticks\"><span>%.3g</span><span>%.3g</span><span>%.3g</span></div>",
            card->near, 2 / (1 / card->near + 1 / card->far), card->far);
    return ST_OK;
}

static enum status put_view(struct page *page, const struct contents *c, const struct view_card *card, struct err *err)
{
    FILE *to = page->to;
    fprintf(to, "<figure>\n<div class=\"pair%s\"><div>", card->truth_picture.rgb ? " three" : "");
    if (!card->picture.rgb)
        fputs("<div class=\"none\">no picture yet</div>", to);
    else if (page_put_picture(page, &card->picture, 75, "View", card->view->name, err))
        return err->status;
    fputs("</div><div>", to);
    if (put_depth(page, card, err)) return err->status;
    if (card->truth_picture.rgb) {
        fputs("</div><div>", to);
        if (page_put_picture(page, &card->truth_picture, 80, "True depth of view", card->view->name, err))
            return err->status;
        fputs("<p class=\"under\">truth</p>", to);
    }
    fputs("</div></div>\n<figcaption><b>", to);
    html_text(to, card->view->name);
    fprintf(to, "</b> <span class=\"size\">%d × %d</span>", card->view->width, card->view->height);
    if (card->depth.z) fprintf(to, ", %.1f %% known", 100 * card->depth.known);
    if (card->depth.z && card->inherited >= 0) fprintf(to, ", %.1f %% inherited", 100 * card->inherited);
    if (card->depth.z) fprintf(to, ", %u segments", card->segments);
    page_put_view_metric(to, c, card->view->name, "depth.bad1", "off by more than 1 px");
    page_put_view_metric(to, c, card->view->name, "depth.error50", "median error");
    page_put_tag(to, card->problem);
    fputs("</figcaption>\n</figure>\n", to);
    return ST_OK;
}

enum status page_depths(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    fputs("<section id=\"depth\" aria-labelledby=\"depth-title\">\n<h2 id=\"depth-title\">Views and their depth</h2>\n",
          to);
    if (!c->views.view_count) {
        fputs("<p>There are no views yet.</p>\n</section>\n", to);
        return ST_OK;
    }
    if (c->depth_count)
        fputs(
            "<p class=\"muted\">Depth along the camera's axis, in scene units. Near is bright; equal colour steps are "
            "equal steps of 1/depth. The colours of a view span its own depths (the true ones where there is a truth) "
            "without the nearest and farthest 2 %. <span class=\"hatch\"></span>unknown: masked, or outside the lens. "
            "Inherited: no other view determines the depth (the point is not visible there, or the surface has no "
            "texture or repeats), so it is that of adjacent segments.</p>\n",
            to);
    fputs("<div class=\"pairs\" style=\"--ramp:", to);
    page_put_ramp(to, false);
    fputs("\">\n", to);
    const int all = c->views.view_count, shown = all < VIEWS_SHOWN ? all : VIEWS_SHOWN;
    for (int i = 0; i < shown; i++)
        if (put_view(page, c, &c->view_cards[(int64_t)i * all / shown], err)) return err->status;
    fputs("</div>\n", to);
    if (shown < all) fprintf(to, "<p>%d more views are not shown.</p>\n", all - shown);
    fputs("</section>\n", to);
    return ST_OK;
}
