/* page.c - see page.h: the frame of the page; page_*.c hold its sections. */
#include "stages/report/page.h"

#include "common/base/version.h"
#include "stages/report/page_parts.h"
#include "stages/report/style.h"

static void put_head(FILE *to, const char *scene, const struct contents *c)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
          "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
          "content=\"default-src "
          "'none'; img-src data:; media-src data:; style-src 'unsafe-inline'\">\n<meta name=\"generator\" "
          "content=\"remodel " REMODEL_VERSION "\">\n<link rel=\"icon\" href=\"data:,\">\n<title>",
          to);
    html_text(to, scene);
    fputs(" · remodel " REMODEL_VERSION "</title>\n<style>\n", to);
    fputs(page_style, to);
    fputs("</style>\n</head>\n<body>\n<header>\n<h1>", to);
    html_text(to, scene);
    fputs("</h1>\n<p class=\"lead\">", to);
    page_put_plural(to, c->photos.count, "photograph", "photographs");
    fputs(" · ", to);
    page_put_plural(to, c->views.view_count, "view", "views");
    fputs(" · ", to);
    page_put_plural(to, c->depth_count, "depth map", "depth maps");
    int videos = 0;
    for (int i = 0; i < c->effect_count; i++) videos += c->effects[i].video != NULL;
    if (page_has_videos(c)) fputs(" · ", to), page_put_plural(to, videos, "video", "videos");
    if (c->model_count) fputs(" · ", to), page_put_plural(to, c->model_count, "model", "models");
    fputs(" · remodel " REMODEL_VERSION "</p>\n<nav aria-label=\"Contents\">", to);
    if (page_has_videos(c)) fputs("<a href=\"#video\">Video</a>", to);
    if (c->model_count) fputs("<a href=\"#model\">Model</a>", to);
    if (c->thing_sheet || c->thing_plan) fputs("<a href=\"#things\">Things</a>", to);
    if (c->has_remodel_page) fputs("<a href=\"remodel/index.html\">Remodelled rooms</a>", to);
    if (c->has_walk) fputs("<a href=\"walk/index.html\">Walk through the rooms</a>", to);
    if (c->texture_count) fputs("<a href=\"#textures\">Textures</a>", to);
    if (light_contents_any(&c->light)) fputs("<a href=\"#light\">Light</a>", to);
    if (c->relit_count) fputs("<a href=\"#relit\">Light of changes</a>", to);
    if (c->has_metrics || c->held.view_count) fputs("<a href=\"#evaluation\">Evaluation</a>", to);
    fputs("<a href=\"#photos\">Photographs</a>"
          "<a href=\"#depth\">Depth</a>",
          to);
    if (c->axes_count) fputs("<a href=\"#axes\">Axes</a>", to);
    fputs("<a href=\"#numbers\">Numbers</a>", to);
    if (c->lens_form_count) fputs("<a href=\"#lens\">Lens</a>", to);
    fputs(
        "<a href=\"#time\">Time and memory</a><a "
        "href=\"#parameters\">"
        "Parameters</a><a href=\"#warnings\">Warnings</a><a href=\"#skipped\">Left out</a></nav>\n</header>\n<main>\n",
        to);
}

enum status page_write(FILE *to, const char *scene, const struct contents *c, struct err *err)
{
    put_head(to, scene, c);
    if (page_videos(to, c, err) || page_models(to, c, err) || page_things(to, c, err) || page_textures(to, c, err) ||
        page_light(to, c, err) || page_relit(to, c, err) || page_evaluation(to, c, err) || page_photos(to, c, err) ||
        page_depths(to, c, err) || page_axes(to, c, err))
        return err->status;
    page_numbers(to, c);
    page_lens(to, c);
    page_usage(to, c);
    page_settings(to, c);
    page_warnings(to, c);
    page_left_out(to, c);
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION
          ". This file is self-contained.</footer>\n</body>\n</html>\n",
          to);
    return ST_OK;
}
