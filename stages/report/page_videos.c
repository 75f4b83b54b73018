/* page_videos.c - the camera moves: video, holes of each frame, the move in 2D, valid viewpoints, scores. */
#include <math.h>
#include <stdlib.h>

#include "stages/report/page_parts.h"
#include "stages/report/score_words.h"

/* 1, 2 or 5 times a power of ten, not below x. */
static double round_up(double x)
{
    double step = pow(10, floor(log10(x)));
    return x <= step ? step : x <= 2 * step ? 2 * step : x <= 5 * step ? 5 * step : 10 * step;
}

/* A curve of one value per frame, 0 to `top`; negative values are unknown and leave gaps. name: its CSS class. */
static void put_curve(FILE *to, const struct effect_card *e, const double *values, double top, const char *name)
{
    const double left = 44, right = 348, high = 12, low = 152;
    bool pen_down = false;
    fprintf(to, "<path class=\"%s\" d=\"", name);
    for (int i = 0; i < e->path.frame_count; i++) {
        if (values[i] < 0) {
            pen_down = false;
            continue;
        }
        double x = left + (right - left) * i / (e->path.frame_count > 1 ? e->path.frame_count - 1 : 1);
        fprintf(to, "%s%.1f %.1f", pen_down ? "L" : "M", x, low - (low - high) * values[i] / top);
        pen_down = true;
    }
    fputs("\"/>\n", to);
}

/* Holes of each frame, before and after filling, in percent of the picture. */
static void put_hole_plot(FILE *to, const struct effect_card *e)
{
    double max_holes = -1, max_unfilled = -1;
    int worst = 0;
    for (int i = 0; i < e->path.frame_count; i++) {
        if (e->holes[i] > max_holes) max_holes = e->holes[i], worst = i;
        max_unfilled = fmax(max_unfilled, e->unfilled[i]);
    }
    if (max_holes < 0) {
        fputs("<p class=\"muted\">No frame records the size of its holes.</p>\n", to);
        return;
    }
    double top = round_up(fmax(fmax(max_holes, max_unfilled), 1e-4)),
           seconds = e->path.frames[e->path.frame_count - 1].time;
    fprintf(
        to,
        "<h3>Holes in each frame</h3>\n<svg class=\"plot\" viewBox=\"0 0 360 186\" role=\"img\" aria-label=\"Share of "
        "each frame that no segment covers: at most %.3g %% (frame ",
        100 * max_holes);
    html_text(to, e->path.frames[worst].camera.name);
    fputs(") before small holes are filled", to);
    if (max_unfilled >= 0) fprintf(to, ", at most %.3g %% after", 100 * max_unfilled);
    fputs(".\">\n", to);
    for (int k = 0; k <= 2; k++) {
        double y = 152 - 70 * k;
        fprintf(to, "<line class=\"grid\" x1=\"44\" x2=\"348\" y1=\"%.0f\" y2=\"%.0f\"/>", y, y);
        fprintf(to, "<text x=\"38\" y=\"%.0f\" text-anchor=\"end\">%.3g %%</text>\n", y + 4, 50 * top * k);
    }
    for (int k = 0; k <= 2; k++)
        fprintf(to, "<text x=\"%d\" y=\"170\" text-anchor=\"%s\">%.2g s</text>\n", 44 + 152 * k,
                k == 0   ? "start"
                : k == 1 ? "middle"
                         : "end",
                seconds * k / 2);
    put_curve(to, e, e->holes, top, "before");
    if (max_unfilled >= 0) put_curve(to, e, e->unfilled, top, "after");
    fprintf(to, "</svg>\n<ul class=\"key\"><li><i class=\"before\"></i>before filling, at most %.3g %%</li>",
            100 * max_holes);
    if (max_unfilled >= 0)
        fprintf(to, "<li><i class=\"after\"></i>after filling, at most %.3g %%</li>", 100 * max_unfilled);
    fputs("</ul>\n", to);
}

/* The picture size and duration of the video, and the scores that plan_path gave the move. */
static void put_scores(FILE *to, const struct effect_card *e)
{
    const struct view *v = &e->path.frames[0].camera;
    fprintf(to, "<dl class=\"scores\">\n<div><dt>picture</dt><dd>%d × %d</dd></div>\n<div><dt>duration</dt><dd>",
            v->width, v->height);
    page_put_seconds(to, e->path.frame_count / e->path.fps);
    fputs(", ", to);
    page_put_plural(to, e->path.frame_count, "frame", "frames");
    fputs("</dd></div>\n", to);
    if (e->flicker.known)
        fprintf(to,
                "<div><dt>flicker</dt><dd>%.2g %%, %.2g %%</dd><dd class=\"under\">change of light between a frame and "
                "the next at one place of a surface: median and 95th percentile</dd></div>\n",
                100 * e->flicker.middle, 100 * e->flicker.high);
    for (int i = 0; i < e->path.score_count; i++) {
        const struct path_score *score = &e->path.scores[i];
        const struct score_words *words = score_words_find(score->name);
        fputs("<div><dt>", to);
        if (words)
            fputs(words->name, to);
        else
            page_put_spaced(to, score->name);
        fprintf(to, "</dt><dd>%.4g ", score->value);
        html_text(to, score->unit);
        fprintf(to, "</dd>%s%s%s</div>\n", words ? "<dd class=\"under\">" : "", words ? words->meaning : "",
                words ? "</dd>" : "");
    }
    fputs("</dl>\n", to);
}

/* A video beside the page. Its label is "LABEL EFFECT". */
static enum status put_video(struct page *page, const struct effect_card *e, const char *video, long long bytes,
                             const struct picture *poster, const char *label, const char *folder, struct err *err)
{
    FILE *to = page->to;
    fputs("<video controls loop muted playsinline preload=\"none\"", to);
    if (e->path.frame_count)
        fprintf(to, " width=\"%d\" height=\"%d\"", e->path.frames[0].camera.width, e->path.frames[0].camera.height);
    fprintf(to, " aria-label=\"%s ", label);
    html_text(to, e->name);
    fputs("\"", to);
    if (poster->rgb) {
        char file[PICTURE_NAME];
        if (page_write_picture(page, poster, 80, file, err)) return err->status;
        fprintf(to, " poster=\"%s%s\"", page->address, file);
    }
    fputs(" src=\"", to);
    page_put_product(page, folder, video);
    fprintf(to, "\">This browser cannot play the video.</video>\n<p class=\"muted\">%.1f MB.</p>\n",
            (double)bytes / 1e6);
    return ST_OK;
}

/* The move in 2D beside the one in 3D. */
static enum status put_pan(struct page *page, const char *folder, const struct effect_card *e, struct err *err)
{
    FILE *to = page->to;
    const struct pan_card *p = &e->pan;
    fputs("<div>\n<h3>the same move in 2D</h3>\n", to);
    if (put_video(page, e, p->video, p->video_bytes, &p->poster, "Pan and zoom over one photograph after the move",
                  folder, err))
        return err->status;
    fputs("<p class=\"muted\">Crops of one photograph", to);
    if (p->view[0]) {
        fputs(", <code>", to);
        html_text(to, p->view);
        fputs("</code>,", to);
    }
    fputs(" that follow the move as closely as crops can", to);
    if (p->misfit[0] >= 0 && p->misfit[1] >= 0)
        fprintf(to, "; the median error of the scene's points is %.3g px in the first frame, %.3g px in the last",
                p->misfit[0], p->misfit[1]);
    fputs(".</p>\n</div>\n", to);
    return ST_OK;
}

static void put_validity(struct page *page, const char *folder, const struct effect_card *e)
{
    FILE *to = page->to;
    fputs("<h3>Where the camera may go</h3>\n<figure><img loading=\"lazy\" alt=\"Viewpoints that show no hole, of ",
          to);
    html_text(to, e->name);
    fputs("\" src=\"", to);
    page_put_product(page, folder, e->validity);
    fputs(
        "\"><figcaption>Top: the start of the move; bottom: its end. Left: how far back the camera can go; right: how "
        "far towards the scene. Dark blue: not at all; yellow: farthest; grey: too much would be missing there. White: "
        "where photographs were taken.</figcaption></figure>\n",
        to);
}

static enum status put_effect(struct page *page, const char *folder, const struct effect_card *e, struct err *err)
{
    FILE *to = page->to;
    fprintf(to, "<article class=\"card effect%s\">\n<div>\n<h3>", e->pan.video ? " two" : "");
    page_put_spaced(to, e->name);
    fputs("</h3>\n", to);
    if (!e->video)
        fputs("<p>There is no video yet.</p>\n", to);
    else if (put_video(page, e, e->video, e->video_bytes, &e->poster, "Rendered camera move", folder, err))
        return err->status;
    fputs("</div>\n", to);
    if (e->pan.video && put_pan(page, folder, e, err)) return err->status;
    fputs("<div>\n", to);
    if (e->path.frame_count)
        put_hole_plot(to, e);
    else
        fputs("<p>The camera path is missing or cannot be read.</p>\n", to);
    if (e->validity) put_validity(page, folder, e);
    fputs("</div>\n", to);
    if (e->path.frame_count) put_scores(to, e);
    fputs("</article>\n", to);
    return ST_OK;
}

bool page_has_videos(const struct contents *c) { return c->effect_count || !c->model_count; }

enum status page_videos(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    if (!page_has_videos(c)) return ST_OK;
    fputs("<section id=\"video\" aria-labelledby=\"video-title\">\n<h2 id=\"video-title\">Video</h2>\n", to);
    if (!c->effect_count) fputs("<p>No camera move has been planned yet, so there is no video.</p>\n", to);
    for (int i = 0; i < c->effect_count; i++)
        if (put_effect(page, c->folder, &c->effects[i], err)) return err->status;
    fputs("</section>\n", to);
    return ST_OK;
}
