/* page_parts.c - see page_parts.h: the markup that sections share. */
#include "stages/report/page_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/image/false_colour.h"

void page_put_seconds(FILE *to, double seconds)
{
    if (seconds < 60)
        fprintf(to, "%.*f s", seconds < 10 ? 2 : 1, seconds);
    else if (seconds < 3600)
        fprintf(to, "%d min %02d s", (int)seconds / 60, (int)seconds % 60);
    else
        fprintf(to, "%.0f h %02d min", floor(seconds / 3600), (int)(fmod(seconds, 3600) / 60));
}

void page_put_mib(FILE *to, double mib)
{
    if (mib < 1024)
        fprintf(to, "%.*f MiB", mib < 10 ? 1 : 0, mib);
    else
        fprintf(to, "%.1f GiB", mib / 1024);
}

void page_put_plural(FILE *to, long long n, const char *singular, const char *plural)
{
    fprintf(to, "%lld %s", n, n == 1 ? singular : plural);
}

void page_put_spaced(FILE *to, const char *name)
{
    char text[256];
    snprintf(text, sizeof text, "%s", name);
    for (char *p = text; *p; p++)
        if (*p == '_') *p = ' ';
    html_text(to, text);
}

void page_put_tag(FILE *to, const char *text)
{
    if (!text[0]) return;
    fputs(" <span class=\"tag\">", to);
    html_text(to, text);
    fputs("</span>", to);
}

enum status page_put_picture(FILE *to, const struct picture *p, int quality, const char *alt, const char *name,
                             struct err *err)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    jpeg_encode(&bytes, &size, p->rgb, p->width, p->height, quality, err);
    if (!err->status) {
        fprintf(to, "<img width=\"%d\" height=\"%d\" alt=\"%s ", p->width, p->height, alt);
        html_text(to, name);
        fputs("\" src=\"data:image/jpeg;base64,", to);
        base64_write(to, bytes, size);
        fputs("\">", to);
    }
    free(bytes);
    return err->status;
}

void page_put_ramp(FILE *to, bool rising)
{
    fputs("linear-gradient(90deg", to);
    for (int k = 0; k <= 16; k++) {
        unsigned char rgb[3];
        colour_of_ramp((rising ? k : 16 - k) / 16.0, rgb);
        fprintf(to, ",#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    }
    fputs(")", to);
}

void page_put_view_metric(FILE *to, const struct contents *c, const char *view, const char *metric, const char *label)
{
    const struct metric_row *m = metric_rows_find(&c->view_metrics, view, metric);
    if (!m) return;
    const bool has_unit = strcmp(m->unit, "1") != 0;
    fprintf(to, ", %.4g ", m->value);
    if (has_unit) html_printf(to, "%s ", m->unit);
    fputs(label, to);
}

void page_put_slider(FILE *to, const char *label, const char *photo)
{
    fprintf(to,
            "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"0.5\" aria-label=\"%s\" "
            "oninput=\"this.parentNode.style.setProperty('--p',this.value+'%%')\">\n</div>\n<figcaption>Seen from "
            "photograph <b>",
            label);
    html_text(to, photo);
    fputs("</b></figcaption>\n", to);
}
