#include "stages/report/page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/version.h"
#include "stages/report/html.h"
#include "stages/report/style.h"

/* The order of the data's way; further stages follow in order of appearance. */
static const char *const CHAIN[] = {"import_photos", "hdr_merge",   "sfm",         "sfm_import",  "rectify",
                                    "segment_depth", "fuse_points", "find_axes",   "build_model", "plan_path",
                                    "render_views",  "pan_scan",    "encode_video"};
enum { CHAIN_LENGTH = sizeof CHAIN / sizeof *CHAIN };

static void put_seconds(FILE *to, double seconds)
{
    if (seconds < 60)
        fprintf(to, "%.*f s", seconds < 10 ? 2 : 1, seconds);
    else if (seconds < 3600)
        fprintf(to, "%d min %02d s", (int)seconds / 60, (int)seconds % 60);
    else
        fprintf(to, "%.0f h %02d min", floor(seconds / 3600), (int)(fmod(seconds, 3600) / 60));
}

static void put_mib(FILE *to, double mib)
{
    if (mib < 1024)
        fprintf(to, "%.*f MiB", mib < 10 ? 1 : 0, mib);
    else
        fprintf(to, "%.1f GiB", mib / 1024);
}

static void put_plural(FILE *to, long long n, const char *one, const char *many)
{
    fprintf(to, "%lld %s", n, n == 1 ? one : many);
}

/* A name with blanks for its underlines. */
static void put_words(FILE *to, const char *name)
{
    char words[256];
    snprintf(words, sizeof words, "%s", name);
    for (char *p = words; *p; p++)
        if (*p == '_') *p = ' ';
    html_text(to, words);
}

static enum status put_picture(FILE *to, const struct picture *p, int quality, const char *alt, const char *name,
                               struct err *err)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    enum status st = jpeg_encode(&bytes, &size, p->rgb, p->width, p->height, quality, err);
    if (!st) {
        fprintf(to, "<img width=\"%d\" height=\"%d\" alt=\"%s ", p->width, p->height, alt);
        html_text(to, name);
        fputs("\" src=\"data:image/jpeg;base64,", to);
        html_base64(to, bytes, size);
        fputs("\">", to);
    }
    free(bytes);
    return st;
}

/* --------------------------------------------------------------------------------------------------------- video */

/* 1, 2 or 5 times a power of ten, not below x. */
static double round_up(double x)
{
    double step = pow(10, floor(log10(x)));
    return x <= step ? step : x <= 2 * step ? 2 * step : x <= 5 * step ? 5 * step : 10 * step;
}

static void put_curve(FILE *to, const struct effect_card *e, const double *values, double top, const char *name)
{
    const double left = 44, right = 348, high = 12, low = 152;
    bool drawn = false; /* pen is down */
    fprintf(to, "<path class=\"%s\" d=\"", name);
    for (int i = 0; i < e->path.frame_count; i++) {
        if (values[i] < 0) {
            drawn = false;
            continue;
        }
        double x = left + (right - left) * i / (e->path.frame_count > 1 ? e->path.frame_count - 1 : 1);
        fprintf(to, "%s%.1f %.1f", drawn ? "L" : "M", x, low - (low - high) * values[i] / top);
        drawn = true;
    }
    fputs("\"/>\n", to);
}

/* Holes by frame, before and after filling, in percent of the picture. */
static void put_hole_plot(FILE *to, const struct effect_card *e)
{
    double most = -1, most_unfilled = -1;
    int worst = 0;
    for (int i = 0; i < e->path.frame_count; i++) {
        if (e->holes[i] > most) most = e->holes[i], worst = i;
        most_unfilled = fmax(most_unfilled, e->unfilled[i]);
    }
    if (most < 0) {
        fputs("<p class=\"muted\">No frame tells how large its holes are.</p>\n", to);
        return;
    }
    double top = round_up(fmax(fmax(most, most_unfilled), 1e-4)),
           seconds = e->path.frames[e->path.frame_count - 1].time;
    fprintf(
        to,
        "<h3>Holes in each frame</h3>\n<svg class=\"plot\" viewBox=\"0 0 360 186\" role=\"img\" aria-label=\"Share of "
        "each frame without any segment: at most %.3g %% (frame ",
        100 * most);
    html_text(to, e->path.frames[worst].camera.name);
    fputs(") before small holes are filled", to);
    if (most_unfilled >= 0) fprintf(to, ", at most %.3g %% after", 100 * most_unfilled);
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
    if (most_unfilled >= 0) put_curve(to, e, e->unfilled, top, "after");
    fprintf(to, "</svg>\n<ul class=\"key\"><li><i class=\"before\"></i>before filling, at most %.3g %%</li>",
            100 * most);
    if (most_unfilled >= 0)
        fprintf(to, "<li><i class=\"after\"></i>after filling, at most %.3g %%</li>", 100 * most_unfilled);
    fputs("</ul>\n", to);
}

/* What plan_path says of the move, and the video's size and length. */
static void put_scores(FILE *to, const struct effect_card *e)
{
    const struct view *v = &e->path.frames[0].camera;
    fprintf(to, "<dl class=\"scores\">\n<div><dt>picture</dt><dd>%d × %d</dd></div>\n<div><dt>duration</dt><dd>",
            v->width, v->height);
    put_seconds(to, e->path.frame_count / e->path.fps);
    fputs(", ", to);
    put_plural(to, e->path.frame_count, "frame", "frames");
    fputs("</dd></div>\n", to);
    for (int i = 0; i < e->path.score_count; i++) {
        const struct path_score *score = &e->path.scores[i];
        fputs("<div><dt>", to);
        put_words(to, score->name);
        fprintf(to, "</dt><dd>%.4g ", score->value);
        html_text(to, score->unit);
        fputs("</dd></div>\n", to);
    }
    fputs("</dl>\n", to);
}

/* A video inside the page; label, and folder under parallax/, are of the effect's name and what follows it. */
static enum status put_video(FILE *to, const struct effect_card *e, const char *video, long long bytes,
                             const struct picture *poster, const char *label, const char *folder, struct err *err)
{
    fputs("<video controls loop muted autoplay playsinline", to);
    if (e->path.frame_count)
        fprintf(to, " width=\"%d\" height=\"%d\"", e->path.frames[0].camera.width, e->path.frames[0].camera.height);
    fprintf(to, " aria-label=\"%s ", label);
    html_text(to, e->name);
    fputs("\"", to);
    if (poster->rgb) {
        unsigned char *jpeg = NULL;
        size_t size = 0;
        if (jpeg_encode(&jpeg, &size, poster->rgb, poster->width, poster->height, 80, err)) return err->status;
        fputs(" poster=\"data:image/jpeg;base64,", to);
        html_base64(to, jpeg, size);
        fputs("\"", to);
        free(jpeg);
    }
    fputs(" src=\"data:video/mp4;base64,", to);
    if (html_base64_file(to, video, err)) return err->status;
    fputs("\">This browser plays no video.</video>\n<p class=\"muted\">The same video stands beside this page: "
          "<code>parallax/",
          to);
    html_text(to, e->name);
    fprintf(to, "%s/video.mp4</code> (%.1f MB).</p>\n", folder, (double)bytes / 1e6);
    return ST_OK;
}

/* The move in 2D beside the one in 3D. */
static enum status put_pan(FILE *to, const struct effect_card *e, struct err *err)
{
    const struct pan_card *p = &e->pan;
    fputs("<div>\n<h3>the same move in 2D</h3>\n", to);
    if (put_video(to, e, p->video, p->video_bytes, &p->poster, "Pan and zoom over one photograph after the move",
                  "/pan_scan", err))
        return err->status;
    fputs("<p class=\"muted\">Crops of one photograph", to);
    if (p->view[0]) {
        fputs(", <code>", to);
        html_text(to, p->view);
        fputs("</code>,", to);
    }
    fputs(" that follow the move as closely as a crop can", to);
    if (p->misfit[0] >= 0 && p->misfit[1] >= 0)
        fprintf(to, "; half of the scene's points are off by more than %.3g px in the first frame, %.3g px in the last",
                p->misfit[0], p->misfit[1]);
    fputs(".</p>\n</div>\n", to);
    return ST_OK;
}

/* From where the move can be shown. */
static enum status put_validity(FILE *to, const struct effect_card *e, struct err *err)
{
    fputs("<h3>Valid viewpoints</h3>\n<figure><img loading=\"lazy\" alt=\"Places of valid viewpoints of ", to);
    html_text(to, e->name);
    fputs("\" src=\"data:image/png;base64,", to);
    if (html_base64_file(to, e->validity, err)) return err->status;
    fputs("\"><figcaption>Start above end; left how far back, right how far towards the scene: dark blue not at all, "
          "yellow the farthest, grey nowhere. White: the views.</figcaption></figure>\n",
          to);
    return ST_OK;
}

static enum status put_effect(FILE *to, const struct effect_card *e, struct err *err)
{
    fprintf(to, "<article class=\"card effect%s\">\n<div>\n<h3>", e->pan.video ? " two" : "");
    put_words(to, e->name);
    fputs("</h3>\n", to);
    if (!e->video)
        fputs("<p>There is no video yet.</p>\n", to);
    else if (put_video(to, e, e->video, e->video_bytes, &e->poster, "Rendered camera move", "", err))
        return err->status;
    fputs("</div>\n", to);
    if (e->pan.video && put_pan(to, e, err)) return err->status;
    fputs("<div>\n", to);
    if (e->path.frame_count)
        put_hole_plot(to, e);
    else
        fputs("<p>There is no camera path that can be read.</p>\n", to);
    if (e->validity && put_validity(to, e, err)) return err->status;
    fputs("</div>\n", to);
    if (e->path.frame_count) put_scores(to, e);
    fputs("</article>\n", to);
    return ST_OK;
}

/* A scene of which a model alone is made lacks no video. */
static bool shows_video(const struct contents *c) { return c->effect_count || !c->model_count; }

static enum status put_videos(FILE *to, const struct contents *c, struct err *err)
{
    if (!shows_video(c)) return ST_OK;
    fputs("<section id=\"video\" aria-labelledby=\"video-title\">\n<h2 id=\"video-title\">Video</h2>\n", to);
    if (!c->effect_count) fputs("<p>No camera move was planned yet, so there is no video.</p>\n", to);
    for (int i = 0; i < c->effect_count; i++)
        if (put_effect(to, &c->effects[i], err)) return err->status;
    fputs("</section>\n", to);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ pictures */

static enum status put_photos(FILE *to, const struct contents *c, struct err *err)
{
    fputs("<section id=\"photos\" aria-labelledby=\"photos-title\">\n<h2 id=\"photos-title\">Photographs</h2>\n", to);
    if (!c->photos.count)
        fputs("<p>No photographs are listed yet.</p>\n", to);
    else
        fputs("<ul class=\"strip\">\n", to);
    for (int i = 0; i < c->photos.count; i++) {
        const struct photo_card *card = &c->photo_cards[i];
        bool off = c->has_views && !card->views && !card->held_out;
        fprintf(to, "<li%s><figure>", off ? " class=\"off\"" : "");
        if (card->picture.rgb) {
            if (put_picture(to, &card->picture, 80, "Photograph", card->record->file, err)) return err->status;
        } else {
            fprintf(to, "<div class=\"none\">no picture</div>");
        }
        fputs("<figcaption><b>", to);
        html_text(to, card->record->file);
        fprintf(to, "</b> <span class=\"size\">%d × %d</span>", card->record->info.width, card->record->info.height);
        if (card->views > 1) fprintf(to, ", %d views", card->views);
        if (card->held_out) fputs(" <span class=\"tag\">held out</span>", to);
        if (off) fputs(" <span class=\"tag\">not placed by SfM</span>", to);
        if (card->trouble[0]) {
            fputs(" <span class=\"tag\">", to);
            html_text(to, card->trouble);
            fputs("</span>", to);
        }
        fputs("</figcaption></figure></li>\n", to);
    }
    fputs(c->photos.count ? "</ul>\n</section>\n" : "</section>\n", to);
    return ST_OK;
}

static enum status put_depth(FILE *to, const struct view_card *card, struct err *err)
{
    if (!card->depth.z) {
        fputs("<div class=\"none\">no depth yet</div>", to);
        return ST_OK;
    }
    if (!card->depth_picture.rgb) {
        fputs("<div class=\"none\">no depth is known</div>", to);
        return ST_OK;
    }
    if (put_picture(to, &card->depth_picture, 90, "Depth of view", card->view->name, err)) return err->status;
    fprintf(to,
            "<div class=\"ramp\"></div><div class=\"ticks\"><span>%.3g</span><span>%.3g</span><span>%.3g</span></div>",
            card->near, 2 / (1 / card->near + 1 / card->far), card->far);
    return ST_OK;
}

/* " · 12.3 % off by more than 1 px" of a view's metric, if it was measured. */
static void put_view_metric(FILE *to, const struct contents *c, const char *view, const char *name, const char *words)
{
    const struct metric_row *m = metric_rows_find(&c->view_metrics, view, name);
    if (m)
        fprintf(to, ", %.4g%s%s %s", m->value, strcmp(m->unit, "1") ? " " : "", strcmp(m->unit, "1") ? m->unit : "",
                words);
}

static enum status put_view(FILE *to, const struct contents *c, const struct view_card *card, struct err *err)
{
    fprintf(to, "<figure>\n<div class=\"pair%s\"><div>", card->truth_picture.rgb ? " three" : "");
    if (!card->picture.rgb)
        fputs("<div class=\"none\">no picture yet</div>", to);
    else if (put_picture(to, &card->picture, 80, "View", card->view->name, err))
        return err->status;
    fputs("</div><div>", to);
    if (put_depth(to, card, err)) return err->status;
    if (card->truth_picture.rgb) {
        fputs("</div><div>", to);
        if (put_picture(to, &card->truth_picture, 90, "True depth of view", card->view->name, err)) return err->status;
        fputs("<p class=\"under\">truth</p>", to);
    }
    fputs("</div></div>\n<figcaption><b>", to);
    html_text(to, card->view->name);
    fprintf(to, "</b> <span class=\"size\">%d × %d</span>", card->view->width, card->view->height);
    if (card->depth.z) fprintf(to, ", %.1f %% known", 100 * card->depth.known);
    if (card->depth.z && card->inherited >= 0) fprintf(to, ", %.1f %% inherited", 100 * card->inherited);
    if (card->depth.z) fprintf(to, ", %u segments", card->segments);
    put_view_metric(to, c, card->view->name, "depth.bad1", "off by more than 1 px");
    put_view_metric(to, c, card->view->name, "depth.error50", "median error");
    if (card->trouble[0]) {
        fputs(" <span class=\"tag\">", to);
        html_text(to, card->trouble);
        fputs("</span>", to);
    }
    fputs("</figcaption>\n</figure>\n", to);
    return ST_OK;
}

static enum status put_depths(FILE *to, const struct contents *c, struct err *err)
{
    fputs("<section id=\"depth\" aria-labelledby=\"depth-title\">\n<h2 id=\"depth-title\">Views and their depth</h2>\n",
          to);
    if (!c->views.view_count) {
        fputs("<p>There are no views yet.</p>\n</section>\n", to);
        return ST_OK;
    }
    if (c->depth_count)
        fputs("<p class=\"muted\">Depth along the camera's axis in scene units. Near is bright; equal steps of colour "
              "are equal "
              "steps of 1/depth over each view's own range, leaving out 2 % at either end (of the truth, where there "
              "is one). <span "
              "class=\"hatch\"></span>unknown: masked, or outside of the lens. Inherited: nothing in other views tells "
              "this depth (not seen there, or blank, or repeated); it is that of what touches it.</p>\n",
              to);
    fputs("<div class=\"pairs\" style=\"--ramp:linear-gradient(90deg", to);
    for (int k = 16; k >= 0; k--) {
        unsigned char rgb[3];
        depth_colour(k / 16.0, rgb);
        fprintf(to, ",#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    }
    fputs(")\">\n", to);
    for (int i = 0; i < c->views.view_count; i++)
        if (put_view(to, c, &c->view_cards[i], err)) return err->status;
    fputs("</div>\n</section>\n", to);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------- evaluation */

static const char *metric_words(const char *name)
{
    static const char *const WORDS[][2] = {
        {"camera.center_max", "camera's place, worst"},
        {"camera.center_median", "camera's place, median"},
        {"camera.placed", "photographs placed, of those the truth knows"},
        {"camera.rotation_max", "camera's turn, worst"},
        {"camera.rotation_median", "camera's turn, median"},
        {"camera.scale", "one scene unit, in units of the truth"},
        {"axes.angle", "turn from the found axes to the true ones"},
        {"axes.ceiling", "height of the ceiling, off by"},
        {"axes.floor", "height of the floor, off by"},
        {"axes.scale", "scale.txt against the cameras"},
        {"axes.up", "angle between found and true up"},
        {"depth.bad1", "disparity off by more than 1 px, or no depth"},
        {"depth.bad1_visible", "the same where another photograph sees the point"},
        {"depth.bad2", "disparity off by more than 2 px, or no depth"},
        {"depth.bad2_visible", "the same where another photograph sees the point"},
        {"depth.baseline", "distance of the two cameras of that disparity"},
        {"depth.error50", "relative depth error, half of the pixels have less"},
        {"depth.error50_visible", "the same where another photograph sees the point"},
        {"depth.error90", "relative depth error, 90 % have less"},
        {"depth.error90_visible", "the same where another photograph sees the point"},
        {"depth.error95", "relative depth error, 95 % have less"},
        {"depth.error95_visible", "the same where another photograph sees the point"},
        {"depth.known", "pixels with a depth"},
        {"depth.occluded", "pixels that no other photograph sees"},
        {"depth.within2", "known pixels whose depth is off by at most 2 %"},
        {"depth.within2_visible", "the same where another photograph sees the point"},
        {"holdout.holes", "of the held-out pictures, seen by no view"},
        {"holdout.pictures", "held-out pictures compared"},
        {"holdout.psnr", "rendered against photographed, mean"},
        {"holdout.psnr_covered", "the same without holes"},
        {"holdout.ssim", "structural similarity, mean"},
        {"holdout.ssim_covered", "the same without holes"},
        {"model.missing", "openings of the truth that the model has not"},
        {"model.openings", "openings, the edge that is farthest off"},
        {"model.openings_median", "openings, half of them are off by less"},
        {"model.strange", "walls and openings that the truth has not"},
        {"model.walls", "walls, the one that is farthest off"},
        {"model.walls_median", "walls, half of them are off by less"},
    };
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++)
        if (!strcmp(WORDS[i][0], name)) return WORDS[i][1];
    return "";
}

static enum status put_held(FILE *to, const struct contents *c, const struct held_card *card, struct err *err)
{
    const struct picture *pictures[2] = {&card->picture, &card->frame};
    static const char *const ALTS[2] = {"Held-out photograph", "Rendered in place of"};
    static const char *const UNDER[2] = {"photograph", "rendered"};
    fputs("<figure>\n<div class=\"pair\">", to);
    for (int k = 0; k < 2; k++) {
        fputs("<div>", to);
        if (!pictures[k]->rgb)
            fputs("<div class=\"none\">no picture yet</div>", to);
        else if (put_picture(to, pictures[k], 85, ALTS[k], card->view->name, err))
            return err->status;
        fprintf(to, "<p class=\"under\">%s</p></div>", UNDER[k]);
    }
    fputs("</div>\n<figcaption><b>", to);
    html_text(to, card->view->name);
    fprintf(to, "</b> <span class=\"size\">%d × %d</span>", card->view->width, card->view->height);
    put_view_metric(to, c, card->view->name, "holdout.psnr", "PSNR");
    put_view_metric(to, c, card->view->name, "holdout.ssim", "SSIM");
    put_view_metric(to, c, card->view->name, "holdout.holes", "holes");
    if (card->trouble[0]) {
        fputs(" <span class=\"tag\">", to);
        html_text(to, card->trouble);
        fputs("</span>", to);
    }
    fputs("</figcaption>\n</figure>\n", to);
    return ST_OK;
}

/* Where the room stands, to be checked by eye. */
static enum status put_axes(FILE *to, const struct contents *c, struct err *err)
{
    if (!c->axes_count) return ST_OK;
    fputs("<section id=\"axes\" aria-labelledby=\"axes-title\">\n<h2 id=\"axes-title\">Axes of the room</h2>\n"
          "<p class=\"muted\">x red, y green, z blue; yellow the floor's outline, cyan the ceiling's: the rectangle of "
          "the "
          "outermost walls, not hidden by what stands before it.</p>\n<div class=\"pairs\">\n",
          to);
    for (int i = 0; i < c->axes_count; i++) {
        fputs("<figure>", to);
        if (put_picture(to, &c->axes[i].picture, 85, "Axes drawn on view", c->axes[i].view, err)) return err->status;
        fputs("<figcaption><b>", to);
        html_text(to, c->axes[i].view);
        fputs("</b></figcaption></figure>\n", to);
    }
    fputs("</div>\n</section>\n", to);
    return ST_OK;
}

static enum status put_model_picture(FILE *to, const char *file, const char *type, const char *what, const char *name,
                                     struct err *err)
{
    if (!file) return ST_OK;
    fprintf(to, "<figure><img loading=\"lazy\" alt=\"%s ", what);
    html_text(to, name);
    fprintf(to, "\" src=\"data:image/%s;base64,", type);
    if (html_base64_file(to, file, err)) return err->status;
    fprintf(to, "\"><figcaption><b>");
    html_text(to, name);
    fprintf(to, "</b> %s</figcaption></figure>\n", what);
    return ST_OK;
}

/* Solid models, to be checked by eye: plan, view from above, edges on the photographs. */
static enum status put_models(FILE *to, const struct contents *c, struct err *err)
{
    if (!c->model_count) return ST_OK;
    fputs("<section id=\"model\" aria-labelledby=\"model-title\">\n<h2 id=\"model-title\">Model</h2>\n", to);
    for (int i = 0; i < c->model_count; i++) {
        const struct model_card *m = &c->models[i];
        const char *name = m->name[0] ? m->name : "model";
        fputs("<h3>", to);
        html_text(to, m->name[0] ? m->name : "as photographed");
        fputs("</h3>\n<div class=\"pairs\">\n", to);
        if (put_model_picture(to, m->plan, "svg+xml", "plan", name, err) ||
            put_model_picture(to, m->view, "png", "from above, cut below the ceiling", name, err))
            return err->status;
        fputs("</div>\n<details><summary>Its edges on the photographs <span class=\"muted\">red: seen; thin: behind "
              "something of the model; blue: glass</span></summary>\n<div class=\"pairs\">\n",
              to);
        for (int k = 0; k < m->overlay_count; k++)
            if (put_model_picture(to, m->overlays[k], "jpeg", "edges of the model", m->named[k], err))
                return err->status;
        fputs("</div>\n</details>\n", to);
    }
    fputs("</section>\n", to);
    return ST_OK;
}

static void put_metrics(FILE *to, const struct metric_rows *r)
{
    fputs("<div class=\"card wide\" role=\"region\" aria-labelledby=\"evaluation-title\" tabindex=\"0\"><table>\n"
          "<thead><tr><th scope=\"col\">Metric</th><th scope=\"col\" class=\"n\">Value</th><th scope=\"col\">Unit</th>"
          "<th scope=\"col\">Better</th><th scope=\"col\">What it is</th></tr></thead>\n<tbody>\n",
          to);
    for (int i = 0; i < r->count; i++) {
        const struct metric_row *m = &r->rows[i];
        fputs("<tr><th scope=\"row\"><code>", to);
        html_text(to, m->name);
        fprintf(to, "</code></th><td class=\"n\">%.5g</td><td>", m->value);
        html_text(to, strcmp(m->unit, "1") ? m->unit : "");
        fputs("</td><td>", to);
        html_text(to, strcmp(m->direction, "none") ? m->direction : "");
        fprintf(to, "</td><td class=\"how\">%s</td></tr>\n", metric_words(m->name));
    }
    fputs("</tbody>\n</table></div>\n", to);
}

static enum status put_evaluation(FILE *to, const struct contents *c, struct err *err)
{
    if (!c->has_metrics && !c->held.view_count) return ST_OK;
    fputs("<section id=\"evaluation\" aria-labelledby=\"evaluation-title\">\n<h2 id=\"evaluation-title\">Measured "
          "against truth and held-out photographs</h2>\n",
          to);
    if (c->metrics.count)
        put_metrics(to, &c->metrics);
    else
        fputs("<p>Nothing was measured yet.</p>\n", to);
    if (c->metrics.note_count) fputs("<ul class=\"list muted\">\n", to);
    for (int i = 0; i < c->metrics.note_count; i++) {
        fputs("<li>", to);
        html_text(to, c->metrics.notes[i]);
        fputs("</li>\n", to);
    }
    if (c->metrics.note_count) fputs("</ul>\n", to);
    if (c->held.view_count) fputs("<h3>Held-out photographs</h3>\n<div class=\"pairs\">\n", to);
    for (int i = 0; i < c->held.view_count; i++)
        if (put_held(to, c, &c->held_cards[i], err)) return err->status;
    if (c->held.view_count) fputs("</div>\n", to);
    fputs("</section>\n", to);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- figures */

static void put_number_head(FILE *to, const char *what)
{
    fprintf(to, "<tr><th scope=\"row\">%s</th><td class=\"n\">", what);
}

static void put_number_tail(FILE *to, const char *how) { fprintf(to, "</td><td class=\"how\">%s</td></tr>\n", how); }

/* The view with most inherited depth, of those that come after `after` in that order (NULL: of all); NULL: none is left. */
static const struct view_card *next_inherited(const struct contents *c, const struct view_card *after)
{
    const struct view_card *most = NULL;
    for (int i = 0; i < c->views.view_count; i++) {
        const struct view_card *v = &c->view_cards[i];
        const bool later = !after || v->inherited < after->inherited || (v->inherited == after->inherited && v > after);
        if (v->depth.z && v->inherited > 0 && later && (!most || v->inherited > most->inherited)) most = v;
    }
    return most;
}

/* How much depth no other view tells, and where most of it is. */
static void put_inherited(FILE *to, const struct contents *c)
{
    const struct view_card *worst = NULL;
    put_number_head(to, "Inherited depth");
    fprintf(to, "%.2f %%", 100 * c->inherited);
    fputs("</td><td class=\"how\">of the views' pixels: nothing in other views tells their depth", to);
    for (int k = 0; k < 3 && c->depth_count > 3 && (worst = next_inherited(c, worst)); k++) {
        fputs(k ? ", " : "; most in ", to);
        html_text(to, worst->view->name);
        fprintf(to, " (%.1f %%)", 100 * worst->inherited);
    }
    fputs("</td></tr>\n", to);
}

static void put_numbers(FILE *to, const struct contents *c)
{
    const struct sfm_model *m = &c->views.model;
    int placed = 0;
    for (int i = 0; i < c->photos.count; i++) placed += c->photo_cards[i].views > 0;

    fputs("<section id=\"numbers\" aria-labelledby=\"numbers-title\">\n<h2 id=\"numbers-title\">Key numbers</h2>\n"
          "<div class=\"card\"><table class=\"numbers\">\n<tbody>\n",
          to);
    put_number_head(to, "Photographs");
    fprintf(to, "%d", c->photos.count);
    put_number_tail(to, "in the list, without those left out");
    if (c->has_views) {
        put_number_head(to, "Views");
        fprintf(to, "%d", c->views.view_count);
        fputs("</td><td class=\"how\">", to);
        if (c->has_photos) fprintf(to, "%d of %d photographs placed by SfM", placed, c->photos.count);
        fputs("</td></tr>\n", to);
        put_number_head(to, "Sparse points");
        fprintf(to, "%d", m->point_count);
        fputs("</td><td class=\"how\">", to);
        if (m->point_count) fprintf(to, "each seen by %.1f views on average", c->track_mean);
        fputs("</td></tr>\n", to);
        if (m->point_count) {
            put_number_head(to, "Reprojection error");
            fprintf(to, "%.2f px", c->error_median);
            fputs("</td><td class=\"how\">", to);
            fprintf(to, "median, recomputed in the rectified views; root mean square %.2f px</td></tr>\n",
                    c->error_rms);
        }
    }
    if (c->depth_count) {
        put_number_head(to, "Segments");
        fprintf(to, "%lld", c->segments);
        fputs("</td><td class=\"how\">", to);
        fprintf(to, "in %d depth maps, %.0f a view</td></tr>\n", c->depth_count, (double)c->segments / c->depth_count);
        put_number_head(to, "Known depth");
        fprintf(to, "%.2f %%", 100 * c->known);
        put_number_tail(to, "of the views' pixels; the others are masked or outside of the lens");
        if (c->inherited >= 0) put_inherited(to, c);
    }
    for (int i = 0; i < c->effect_count; i++) {
        const struct effect_card *e = &c->effects[i];
        if (!e->path.frame_count) continue;
        put_number_head(to, "Video");
        put_seconds(to, e->path.frame_count / e->path.fps);
        fputs("</td><td class=\"how\">", to);
        html_text(to, e->name);
        fprintf(to, ": %d of %d frames made, %d × %d, %.4g a second", e->frames_found, e->path.frame_count,
                e->path.frames[0].camera.width, e->path.frames[0].camera.height, e->path.fps);
        if (e->video) fprintf(to, ", %.1f MB", (double)e->video_bytes / 1e6);
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table></div>\n</section>\n", to);
}

static const struct stage_usage *stage_at(const struct usage_table *t, const char *name)
{
    for (int i = 0; i < t->stage_count; i++)
        if (!strcmp(t->stages[i].sum.stage, name)) return &t->stages[i];
    return NULL;
}

static bool in_chain(const char *name)
{
    for (int i = 0; i < CHAIN_LENGTH; i++)
        if (!strcmp(CHAIN[i], name)) return true;
    return false;
}

static void put_bar(FILE *to, double part, double whole)
{
    fprintf(to, "<span class=\"bar\"><i style=\"width:%.1f%%\"></i></span>",
            whole > 0 ? fmax(100 * part / whole, 0.5) : 0.5);
}

static void put_usage_row(FILE *to, const struct stage_usage *s, const struct usage *most)
{
    fputs("<tr><th scope=\"row\">", to);
    html_text(to, s->sum.stage);
    if (s->unfinished) fprintf(to, " <span class=\"tag\">%d did not end</span>", s->unfinished);
    fprintf(to, "</th><td class=\"n\">%d", s->runs);
    fputs("</td><td class=\"n\">", to);
    put_seconds(to, s->sum.wall);
    put_bar(to, s->sum.wall, most->wall);
    fputs("</td><td class=\"n\">", to);
    put_seconds(to, s->sum.cpu);
    put_bar(to, s->sum.cpu, most->cpu);
    fputs("</td><td class=\"n peak\">", to);
    put_mib(to, s->sum.mib);
    put_bar(to, s->sum.mib, most->mib);
    fputs("</td></tr>\n", to);
}

static void put_usage(FILE *to, const struct contents *c)
{
    const struct usage_table *t = &c->usage;
    struct usage sum = {0}, most = {0};
    fputs("<section id=\"time\" aria-labelledby=\"time-title\">\n<h2 id=\"time-title\">Time and memory</h2>\n", to);
    if (!t->stage_count) {
        fputs("<p>No stage left a log.</p>\n</section>\n", to);
        return;
    }
    for (int i = 0; i < t->stage_count; i++) {
        const struct usage *u = &t->stages[i].sum;
        sum = (struct usage){"", sum.wall + u->wall, sum.cpu + u->cpu, fmax(sum.mib, u->mib)};
        most = (struct usage){"", fmax(most.wall, u->wall), fmax(most.cpu, u->cpu), fmax(most.mib, u->mib)};
    }
    fputs("<p>Summed over each stage's latest runs; runs of one stage may have gone on side by side. Memory is the "
          "largest peak of "
          "one run.</p>\n<div class=\"card wide\" role=\"region\" aria-labelledby=\"time-title\" "
          "tabindex=\"0\"><table>\n<thead><tr>"
          "<th scope=\"col\">Stage</th><th scope=\"col\" class=\"n\">Runs</th><th scope=\"col\" class=\"n\">Wall "
          "clock</th>"
          "<th scope=\"col\" class=\"n\">Processor</th><th scope=\"col\" class=\"n\">Peak "
          "memory</th></tr></thead>\n<tbody>\n",
          to);
    for (int i = 0; i < CHAIN_LENGTH; i++) {
        const struct stage_usage *s = stage_at(t, CHAIN[i]);
        if (s) put_usage_row(to, s, &most);
    }
    for (int i = 0; i < t->stage_count; i++)
        if (!in_chain(t->stages[i].sum.stage)) put_usage_row(to, &t->stages[i], &most);
    fputs("</tbody>\n<tfoot><tr><th scope=\"row\">All</th><td></td><td class=\"n\">", to);
    put_seconds(to, sum.wall);
    fputs("</td><td class=\"n\">", to);
    put_seconds(to, sum.cpu);
    fputs("</td><td class=\"n\">", to);
    put_mib(to, sum.mib);
    fputs("</td></tr></tfoot>\n</table></div>\n</section>\n", to);
}

/* ----------------------------------------------------------------------------------------------------- the rest */

static void put_section_settings(FILE *to, const struct contents *c, int from, int end)
{
    const struct setting *items = c->settings.items;
    int changed = 0, known = 0;
    for (int i = from; i < end; i++) changed += items[i].changed, known += items[i].known;
    fputs(changed ? "<details open><summary><code>" : "<details><summary><code>", to);
    html_text(to, items[from].section[0] ? items[from].section : "no section");
    fputs("</code> <span class=\"muted\">", to);
    put_plural(to, end - from, "parameter", "parameters");
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
        if (items[i].changed) html_printf(to, "default %s", items[i].usual[0] ? items[i].usual : "is empty");
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table>\n</details>\n", to);
}

static void put_settings(FILE *to, const struct contents *c)
{
    const struct setting *items = c->settings.items;
    fputs("<section id=\"parameters\" aria-labelledby=\"parameters-title\">\n<h2 "
          "id=\"parameters-title\">Parameters</h2>\n",
          to);
    if (!c->settings.count) {
        fputs("<p>No stage left its parameters.</p>\n</section>\n", to);
        return;
    }
    fputs("<div class=\"card\">\n", to);
    for (int k = 0; k <= CHAIN_LENGTH; k++) /* the chain's stages in its order, then the others */
        for (int from = 0, end; from < c->settings.count; from = end) {
            const char *section = items[from].section;
            for (end = from + 1; end < c->settings.count && !strcmp(items[end].section, section);) end++;
            if (k < CHAIN_LENGTH ? !strcmp(section, CHAIN[k]) : !in_chain(section))
                put_section_settings(to, c, from, end);
        }
    fputs("</div>\n</section>\n", to);
}

static void put_warnings(FILE *to, const struct contents *c)
{
    fputs("<section id=\"warnings\" aria-labelledby=\"warnings-title\">\n<h2 id=\"warnings-title\">Warnings</h2>\n",
          to);
    if (!c->usage.warning_count)
        fputs("<p>The logs hold no warning.</p>\n", to);
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

static void put_skipped(FILE *to, const struct contents *c)
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
        fputs("</b> stands in the folder of photographs but not in the scene's list: it was excluded, or added "
              "since.</li>\n",
              to);
    }
    for (int i = 0; c->has_views && i < c->photos.count; i++) {
        if (c->photo_cards[i].views || c->photo_cards[i].held_out) continue;
        fputs("<li><b>", to);
        html_text(to, c->photo_cards[i].record->file);
        fputs("</b> could not be placed: too little of it matches the other photographs, or it lies in a smaller model "
              "that was not "
              "chosen.</li>\n",
              to);
        count++;
    }
    for (int i = 0; c->usage.stage_count && i < CHAIN_LENGTH; i++) {
        if (stage_at(&c->usage, CHAIN[i])) continue;
        fprintf(to, "<li>The stage <code>%s</code> left no log: it has not run for this scene.</li>\n", CHAIN[i]);
        count++;
    }
    if (!count) fputs("<li>Nothing: every photograph is used and every stage has run.</li>\n", to);
    fputs("</ul></div>\n</section>\n", to);
}

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
    put_plural(to, c->photos.count, "photograph", "photographs");
    fputs(" · ", to);
    put_plural(to, c->views.view_count, "view", "views");
    fputs(" · ", to);
    put_plural(to, c->depth_count, "depth map", "depth maps");
    int videos = 0;
    for (int i = 0; i < c->effect_count; i++) videos += c->effects[i].video != NULL;
    if (shows_video(c)) fputs(" · ", to), put_plural(to, videos, "video", "videos");
    if (c->model_count) fputs(" · ", to), put_plural(to, c->model_count, "model", "models");
    fputs(" · remodel " REMODEL_VERSION "</p>\n<nav aria-label=\"Contents\">", to);
    if (shows_video(c)) fputs("<a href=\"#video\">Video</a>", to);
    if (c->model_count) fputs("<a href=\"#model\">Model</a>", to);
    if (c->has_metrics || c->held.view_count) fputs("<a href=\"#evaluation\">Measured</a>", to);
    fputs("<a href=\"#photos\">Photographs</a>"
          "<a href=\"#depth\">Depth</a>",
          to);
    if (c->axes_count) fputs("<a href=\"#axes\">Axes</a>", to);
    fputs(
        "<a href=\"#numbers\">Numbers</a><a href=\"#time\">Time and memory</a><a "
        "href=\"#parameters\">"
        "Parameters</a><a href=\"#warnings\">Warnings</a><a href=\"#skipped\">Left out</a></nav>\n</header>\n<main>\n",
        to);
}

enum status page_write(FILE *to, const char *scene, const struct contents *c, struct err *err)
{
    put_head(to, scene, c);
    if (put_videos(to, c, err) || put_models(to, c, err) || put_evaluation(to, c, err) || put_photos(to, c, err) ||
        put_depths(to, c, err) || put_axes(to, c, err))
        return err->status;
    put_numbers(to, c);
    put_usage(to, c);
    put_settings(to, c);
    put_warnings(to, c);
    put_skipped(to, c);
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION
          ". This file holds everything it shows.</footer>\n</body>\n</html>\n",
          to);
    return ST_OK;
}
