/* page_numbers.c - key numbers of the scene. */
#include "stages/report/page_parts.h"

/* Begins a row of the table: NAME, and the cell of its value. */
static void put_number_head(FILE *to, const char *name)
{
    fprintf(to, "<tr><th scope=\"row\">%s</th><td class=\"n\">", name);
}

/* Ends a row with a remark. */
static void put_number_tail(FILE *to, const char *remark)
{
    fprintf(to, "</td><td class=\"how\">%s</td></tr>\n", remark);
}

/* The view after `after` in descending order of inherited depth (NULL: the first one); NULL at the end. */
static const struct view_card *next_inherited(const struct contents *c, const struct view_card *after)
{
    const struct view_card *max = NULL;
    for (int i = 0; i < c->views.view_count; i++) {
        const struct view_card *v = &c->view_cards[i];
        const bool later = !after || v->inherited < after->inherited || (v->inherited == after->inherited && v > after);
        if (v->depth.z && v->inherited > 0 && later && (!max || v->inherited > max->inherited)) max = v;
    }
    return max;
}

/* The share of inherited depth, and the three views with most of it. */
static void put_inherited(FILE *to, const struct contents *c)
{
    const struct view_card *worst = NULL;
    put_number_head(to, "Inherited depth");
    fprintf(to, "%.2f %%", 100 * c->inherited);
    fputs("</td><td class=\"how\">of the views' pixels: no other view determines their depth", to);
    for (int k = 0; k < 3 && c->depth_count > 3 && (worst = next_inherited(c, worst)); k++) {
        fputs(k ? ", " : "; most in ", to);
        html_text(to, worst->view->name);
        fprintf(to, " (%.1f %%)", 100 * worst->inherited);
    }
    fputs("</td></tr>\n", to);
}

void page_numbers(FILE *to, const struct contents *c)
{
    const struct sfm_model *m = &c->views.model;
    int placed = 0;
    for (int i = 0; i < c->photos.count; i++) placed += c->photo_cards[i].views > 0;

    fputs("<section id=\"numbers\" aria-labelledby=\"numbers-title\">\n<h2 id=\"numbers-title\">Key numbers</h2>\n"
          "<div class=\"card\"><table class=\"numbers\">\n<tbody>\n",
          to);
    put_number_head(to, "Photographs");
    fprintf(to, "%d", c->photos.count);
    put_number_tail(to, "in the scene's list; excluded ones do not count");
    if (c->has_views) {
        put_number_head(to, "Views");
        fprintf(to, "%d", c->views.view_count);
        fputs("</td><td class=\"how\">", to);
        fputs("pinhole pictures that the photographs were turned into", to);
        if (c->has_photos) fprintf(to, "; %d of %d photographs could be placed", placed, c->photos.count);
        fputs("</td></tr>\n", to);
        put_number_head(to, "Points in space");
        fprintf(to, "%d", m->point_count);
        fputs("</td><td class=\"how\">", to);
        if (m->point_count) fprintf(to, "spots that several photographs show; %.1f views on average", c->track_mean);
        fputs("</td></tr>\n", to);
        if (m->point_count) {
            put_number_head(to, "Fit of these points");
            fprintf(to, "%.2f px", c->error_median);
            fputs("</td><td class=\"how\">", to);
            fprintf(to,
                    "half of them lie in the views within so many pixels of where they should be (reprojection "
                    "error); root mean square %.2f px</td></tr>\n",
                    c->error_rms);
        }
    }
    if (c->depth_count) {
        put_number_head(to, "Segments");
        fprintf(to, "%lld", c->segments);
        fputs("</td><td class=\"how\">", to);
        fprintf(to, "patches of a view that have one plane, in %d depth maps, %.0f per view</td></tr>\n",
                c->depth_count, (double)c->segments / c->depth_count);
        put_number_head(to, "Known depth");
        fprintf(to, "%.2f %%", 100 * c->known);
        put_number_tail(to, "of the views' pixels; the others are masked or outside the lens");
        if (c->inherited >= 0) put_inherited(to, c);
    }
    for (int i = 0; i < c->effect_count; i++) {
        const struct effect_card *e = &c->effects[i];
        if (!e->path.frame_count) continue;
        put_number_head(to, "Film");
        page_put_seconds(to, e->path.frame_count / e->path.fps);
        fputs("</td><td class=\"how\">", to);
        html_text(to, e->name);
        fprintf(to, ": %d of %d frames rendered, %d × %d, %.4g per second", e->frames_found, e->path.frame_count,
                e->path.frames[0].camera.width, e->path.frames[0].camera.height, e->path.fps);
        if (e->video) fprintf(to, ", %.1f MB", (double)e->video_bytes / 1e6);
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table></div>\n</section>\n", to);
}
