/* page_parts.c - see page_parts.h: the markup that sections share. */
#include "stages/report/page_parts.h"

#include "common/capture/panorama_name.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/hash.h"
#include "common/base/outfile.h"
#include "common/base/version.h"
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

void page_put_change(FILE *to, const char *name)
{
    char words[256];
    snprintf(words, sizeof words, "%s", name);
    for (char *c = words; *c; c++)
        if (*c == '-' || *c == '_') *c = ' ';
    html_text(to, words);
}

/* ------------------------------------------------------------------------------------------------------------ files */

static enum status add_picture(struct page *page, const char *name, struct err *err)
{
    if (name_list_has(&page->pictures, name)) return ST_OK;
    return name_list_add(&page->pictures, name, strlen(name), err);
}

/* Names the file by what identifies it; written: it is there. */
static enum status begin_picture(struct page *page, const void *bytes, size_t size, const char *ending,
                                 char name[PICTURE_NAME], char path[FILE_PATH], bool *written, struct err *err)
{
    char hash[HASH_TEXT];
    hash_bytes(hash, bytes, size);
    snprintf(name, PICTURE_NAME, "%.16s%s", hash, ending);
    if (file_path(path, page->folder, name, "", err)) return err->status;
    *written = path_is_file(path);
    return add_picture(page, name, err);
}

enum status page_write_picture(struct page *page, const struct picture *p, int quality, char name[PICTURE_NAME],
                               struct err *err)
{
    char path[FILE_PATH], ending[16];
    bool written = false;
    snprintf(ending, sizeof ending, "-%d%s", p->width, quality ? ".jpg" : ".png");
    if (begin_picture(page, p->rgb, 3 * (size_t)p->width * (size_t)p->height, ending, name, path, &written, err) ||
        written)
        return err->status;
    return quality ? jpeg_write(path, p->rgb, p->width, p->height, quality, err)
                   : png_write(path, p->rgb, p->width, p->height, 3, err);
}

enum status page_put_picture(struct page *page, const struct picture *p, int quality, const char *alt, const char *name,
                             struct err *err)
{
    char file[PICTURE_NAME];
    if (page_write_picture(page, p, quality, file, err)) return err->status;
    fprintf(page->to, "<img loading=\"lazy\" width=\"%d\" height=\"%d\" alt=\"%s ", p->width, p->height, alt);
    html_text(page->to, name);
    fprintf(page->to, "\" src=\"%s%s\">", page->address, file);
    return ST_OK;
}

enum status page_copy_picture(struct page *page, const char *file, const char *ending, char name[PICTURE_NAME],
                              struct err *err)
{
    struct file_bytes bytes = {0};
    char path[FILE_PATH];
    bool written = false;
    if (file_bytes_read(&bytes, file, err)) return err->status;
    if (!begin_picture(page, bytes.bytes, bytes.size, ending, name, path, &written, err) && !written)
        outfile_copy(path, file, err);
    file_bytes_release(&bytes);
    return err->status;
}

void page_put_product(struct page *page, const char *folder, const char *path)
{
    const size_t length = strlen(folder);
    fputs(page->scene, page->to);
    if (!strncmp(path, folder, length)) path += length + strspn(path + length, "/");
    html_address(page->to, path);
}

/* A name that begin_picture() gave: 16 digits, and what follows. */
static bool is_picture_name(const char *name)
{
    return strspn(name, "0123456789abcdef") == 16 && strchr("-.", name[16]) && strlen(name) < PICTURE_NAME;
}

void page_remove_old(const char *folder, const struct name_list *kept)
{
    struct dirent **names = NULL;
    const int count = scandir(folder, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char path[FILE_PATH];
        struct err none = ERR_INIT;
        const char *name = names[i]->d_name;
        if (is_picture_name(name) && !name_list_has(kept, name) && !file_path(path, folder, name, "", &none))
            unlink(path);
        free(names[i]);
    }
    free(names);
}

/* ------------------------------------------------------------------------------------------------------------- head */

enum status page_put_part(struct page *page, const char *tag, const char *file, struct err *err)
{
    char path[FILE_PATH];
    struct file_bytes part = {0};
    if (file_path(path, page->parts, file, "", err) || file_bytes_read(&part, path, err)) return err->status;
    fprintf(page->to, "<%s>\n", tag);
    fwrite(part.bytes, 1, part.size, page->to);
    fprintf(page->to, "</%s>\n", tag);
    file_bytes_release(&part);
    return ST_OK;
}

enum status page_put_head(struct page *page, const char *title, const char *more, const char *const *styles, int count,
                          struct err *err)
{
    FILE *to = page->to;
    fprintf(
        to,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" "
        "content=\"default-src 'none'; img-src 'self' file: data:; media-src 'self' file:; style-src "
        "'unsafe-inline'; script-src 'unsafe-inline'%s\">\n<meta name=\"generator\" content=\"remodel " REMODEL_VERSION
        "\">\n<link rel=\"icon\" href=\"data:,\">\n<title>",
        page->loads ? " 'self' file:" : "");
    html_text(to, title);
    fprintf(to, "%s</title>\n", more);
    for (int i = 0; i < count; i++)
        if (page_put_part(page, "style", styles[i], err)) return err->status;
    fputs("</head>\n<body>\n<header>\n<h1>", to);
    html_text(to, title);
    fprintf(to, "%s</h1>\n", more);
    return ST_OK;
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

void page_put_photo_name(FILE *to, const char *photo)
{
    int yaw;
    const size_t length = panorama_name_read(&yaw, photo);
    char name[256];
    snprintf(name, sizeof name, "%.*s", (int)(length ? length : strlen(photo)), photo);
    fputs(length ? "Panorama " : "Photograph ", to);
    html_text(to, name);
    if (length && yaw <= 180)
        fprintf(to, yaw ? ", %d degrees to the right" : ", straight ahead", yaw);
    else if (length)
        fprintf(to, ", %d degrees to the left", 360 - yaw);
}
