/* page_levels_part.c - light levels on the page of a scene: a plan and a photo of the photographed light, and the way
 * to the page that has sliders. */
#include "stages/report/contents_parts.h"
#include "stages/report/page_parts.h"

static enum status put_picture(struct page *page, const char *file, const char *words, const char *of, struct err *err)
{
    char name[PICTURE_NAME];
    if (page_copy_picture(page, file, ".svg", name, err)) return err->status;
    fprintf(page->to, "<figure><img loading=\"lazy\" alt=\"Light levels %s", words);
    html_text(page->to, of);
    fprintf(page->to, "\" src=\"%s%s\"><figcaption>Illuminance %s", page->address, name, words);
    html_text(page->to, of);
    fputs(", in the light of the photographs</figcaption></figure>\n", page->to);
    return ST_OK;
}

enum status page_levels_part(struct page *page, const struct contents *c, struct err *err)
{
    const char *const state = "photographed";
    struct name_list photos = {0};
    char folder[FILE_PATH], file[FILE_PATH], name[FILE_PATH];
    if (!c->has_levels) return ST_OK;
    fputs("<section id=\"levels\" aria-labelledby=\"levels-title\">\n<h2 id=\"levels-title\">Light levels</h2>\n<p>How "
          "bright the rooms and their places are, and what an edit changes. <a href=\"lux/index.html\">A page with "
          "sliders</a> dims lamps, chooses skies and hours, and compares edits.</p>\n<div class=\"plans\">\n",
          page->to);
    if (contents_product(file, c->folder, PRODUCT_LIGHT_PLAN, &(struct product_key){.lux = "lux", .name = state}))
        put_picture(page, file, "on the work planes", "", err);
    if (!err->status && !file_path(folder, c->folder, "lux", "", err))
        name_list_add_files(&photos, folder, "photographed.", ".svg", err);
    for (int i = 0; !err->status && i < photos.count && i < 1; i++) {
        snprintf(name, sizeof name, "%s.%s", state, photos.names[i]);
        if (contents_product(file, c->folder, PRODUCT_LIGHT_PLAN, &(struct product_key){.lux = "lux", .name = name}))
            put_picture(page, file, "of what a photograph shows, ", photos.names[i], err);
    }
    fputs("</div>\n</section>\n", page->to);
    name_list_release(&photos);
    return err->status;
}
