/* page_levels.c - see page_levels.h.
 *
 * The data of the room and of each edit, LUX/levels.js, go into the page, so that it opens from a file without a
 * server. Pictures stay files. Without scripts the page has links to all pictures and tables. */
#include "stages/report/page_levels.h"

#include <string.h>

#include "common/base/file_bytes.h"
#include "common/base/version.h"
#include "stages/report/contents_parts.h"

/* A variant: the unedited room, or an edit. */
struct levels_variant {
    const char *name;       /* "": the unedited room */
    char folder[FILE_PATH]; /* below the scene's */
    const char *address;    /* of that folder from the page */
};

static enum status find_variant(struct levels_variant *v, const char *edit, struct err *err)
{
    *v = (struct levels_variant){.name = edit, .folder = "lux", .address = edit};
    return *edit ? file_path(v->folder, "lux", edit, "", err) : ST_OK;
}

static bool has_product(char path[FILE_PATH], const struct levels_sources *from, const struct levels_variant *v,
                        enum product_id id)
{
    return contents_product(path, from->folder, id, &(struct product_key){.lux = v->folder});
}

/* ------------------------------------------------------------------------------------------------------------- data */

static enum status put_data(struct page *page, const struct levels_sources *from, const struct levels_variant *v,
                            struct err *err)
{
    struct file_bytes data = {0};
    char path[FILE_PATH], relit[FILE_PATH];
    if (!has_product(path, from, v, PRODUCT_LIGHT_SCRIPT)) return ST_OK;
    if (file_bytes_read(&data, path, err)) return err->status;
    fprintf(page->to, "<script>\nvariants.push({name: '%s'", v->name);
    if (has_product(relit, from, v, PRODUCT_LIGHT_RELIT)) {
        fputs(", relit: '", page->to);
        html_address(page->to, v->address);
        fputs(*v->address ? "/relit.js'" : "relit.js'", page->to);
    }
    fputs("});\n", page->to);
    fwrite(data.bytes, 1, data.size, page->to);
    fputs("</script>\n", page->to);
    file_bytes_release(&data);
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- controls */

static void put_controls(FILE *to)
{
    fputs(
        "<section class=\"needs-js\" aria-labelledby=\"plan-title\">\n<h2 id=\"plan-title\">On the plan</h2>\n"
        "<div class=\"levels\">\n<div>\n"
        "<fieldset><legend>Daylight</legend>\n"
        "<label>Sky <select id=\"sky\"><option value=\"photographed\">as photographed</option><option "
        "value=\"none\">none, night</option><option value=\"overcast\">overcast, 10 000 lx outdoors</option><option "
        "value=\"hour\">an hour of a day</option></select></label>\n"
        "<p id=\"no-rooms\" class=\"tag\">The model has no room, so that the sky would shine in where floors and "
        "ceilings "
        "should be: computed skies and daylight factors mean nothing. Add lines <code>room NAME WALL WALL WALL</code> "
        "to model.txt.</p>\n<p id=\"no-site\" class=\"muted\">For hours of a day, say where the rooms are: "
        "<code>site LATITUDE LONGITUDE ZONE north DEGREES</code> in the scene's states.txt.</p>\n"
        "<div id=\"hours\"><label>Day <select id=\"day\"></select></label>\n"
        "<label>Clouds <select id=\"cover\"><option value=\"0\">clear</option><option "
        "value=\"1\">partly cloudy</option><option value=\"2\">overcast</option></select></label>\n"
        "<label for=\"hour\">Hour, without summer time <output id=\"clock\" for=\"hour\"></output></label>"
        "<input type=\"range\" id=\"hour\" min=\"0\" max=\"0\" value=\"0\">\n"
        "<p class=\"muted\" id=\"altitude\"></p><button type=\"button\" id=\"play\">Play the day</button></div>\n"
        "</fieldset>\n"
        "<fieldset><legend>Lamps</legend>\n<p><button type=\"button\" id=\"on\">All on</button> <button "
        "type=\"button\" id=\"off\">All off</button></p>\n<p id=\"no-scale\" class=\"tag\">What the photographs "
        "show is in their own unit, planned lamps and computed skies are in lx: their sum needs a measured point "
        "(lux.txt).</p>\n"
        "<div id=\"lamps\"></div>\n</fieldset>\n"
        "<fieldset id=\"windows\"><legend>Blinds</legend>\n<p class=\"muted\">How much of its light each window "
        "lets through.</p>\n<div id=\"blinds\"></div>\n</fieldset>\n"
        "<fieldset id=\"edits\"><legend>Edit</legend>\n<label>Edit <select id=\"edit\"></select></label>\n"
        "<div id=\"compare\"><label>Show <select id=\"show\"><option value=\"after\">after</option><option "
        "value=\"before\">before</option><option value=\"difference\">difference</option></select></label></div>\n"
        "</fieldset>\n</div>\n"
        "<div>\n<canvas id=\"plan\" role=\"application\" tabindex=\"0\" aria-label=\"Plan of the rooms\"></canvas>\n"
        "<div class=\"bar\" id=\"bar\"></div><div class=\"ticks\" id=\"ticks\"></div>\n"
        "<p class=\"muted\" id=\"unit\"></p>\n<p role=\"status\"><span id=\"said\"></span> <span "
        "id=\"point\"></span></p>\n"
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of light levels\"><table "
        "class=\"values\" id=\"values\"></table></div>\n"
        "<div id=\"in-photos\"><h3>In the photographs</h3>\n<p class=\"muted\">The photographs, in this light. "
        "<label>Exposure <select id=\"exposure\"><option value=\"own\">of each picture its own</option><option "
        "value=\"kept\">as it is now</option><option value=\"photo\">as the photograph</option></select></label></p>\n"
        "<div class=\"relit\" id=\"relit\"></div></div>\n"
        "</div>\n</div>\n</section>\n",
        to);
}

/* --------------------------------------------------------------------------------------------------------- pictures */

/* "STATE.PHOTO" at its first point: names of states have none. */
static void put_link(FILE *to, const struct levels_variant *v, const char *picture)
{
    const char *point = strchr(picture, '.');
    const int length = point ? (int)(point - picture) : (int)strlen(picture);
    fputs("<li><a ", to);
    if (point) {
        fprintf(to, "data-state=\"%.*s\" data-photo=\"", length, picture);
        html_text(to, point + 1);
        fprintf(to, "\" data-change=\"%s\" ", v->name);
    }
    fputs("href=\"", to);
    html_address(to, v->address);
    fputs(*v->address ? "/" : "", to);
    html_address(to, picture);
    fprintf(to, ".svg\">%.*s, ", length, picture);
    html_text(to, point ? point + 1 : "plan");
    if (*v->name) fputs(", after ", to), page_put_change(to, v->name);
    fputs("</a></li>\n", to);
}

static enum status put_pictures(struct page *page, const struct levels_sources *from, const struct name_list *edits,
                                struct err *err)
{
    FILE *to = page->to;
    fputs(
        "<section aria-labelledby=\"photos-title\">\n<h2 id=\"photos-title\">Over the photographs</h2>\n<p>What falls "
        "on the surfaces that a photograph shows. The colours are the same in all pictures of a unit; lines bear their "
        "numbers.</p>\n<p class=\"pick needs-js\"><label>State <select id=\"state\"></select></label></p>\n<div "
        "class=\"shots\" id=\"shots\"></div>\n<ul class=\"list plain\">\n",
        to);
    for (int i = -1; !err->status && i < edits->count; i++) {
        struct levels_variant v;
        struct name_list names = {0};
        char folder[FILE_PATH];
        if (!find_variant(&v, i < 0 ? "" : edits->names[i], err) &&
            !file_path(folder, from->folder, v.folder, "", err) &&
            !name_list_add_files(&names, folder, "", ".svg", err))
            for (int k = 0; k < names.count; k++) put_link(to, &v, names.names[k]);
        name_list_release(&names);
    }
    fputs("</ul>\n</section>\n", to);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------- films, files */

static enum status put_films(struct page *page, const struct levels_sources *from, const struct name_list *edits,
                             struct err *err)
{
    FILE *to = page->to;
    int count = 0;
    for (int i = -1; !err->status && i < edits->count; i++) {
        struct levels_variant v;
        struct name_list names = {0};
        char folder[FILE_PATH];
        if (!find_variant(&v, i < 0 ? "" : edits->names[i], err) && !file_path(folder, from->folder, v.folder, "", err))
            name_list_add_files(&names, folder, "", ".mp4", err);
        for (int k = 0; !err->status && k < names.count; k++) {
            if (!count++)
                fputs("<section aria-labelledby=\"films-title\">\n<h2 id=\"films-title\">A day as a film</h2>\n<div "
                      "class=\"films\">\n",
                      to);
            fputs("<figure><video controls loop playsinline preload=\"metadata\" aria-label=\"Light levels over a "
                  "day\" src=\"",
                  to);
            html_address(to, v.address);
            fputs(*v.address ? "/" : "", to);
            html_address(to, names.names[k]);
            fputs(".mp4\"></video><figcaption>", to);
            html_text(to, names.names[k]);
            if (*v.name) fputs(", after ", to), page_put_change(to, v.name);
            fputs("</figcaption></figure>\n", to);
        }
        name_list_release(&names);
    }
    if (count) fputs("</div>\n</section>\n", to);
    return err->status;
}

static void put_files(FILE *to, const struct levels_sources *from, const struct levels_variant *v)
{
    static const struct file {
        enum product_id id;
        const char *file, *words;
    } files[] = {{PRODUCT_LIGHT_SHEET, "sheet.tsv", "all states, rooms, faces and places, with intervals"},
                 {PRODUCT_QUANTITIES, "quantities.csv", "areas and reflectances of faces"},
                 {PRODUCT_OPENING_SCHEDULE, "openings.csv", "windows and doors with their sizes"}};
    char path[FILE_PATH];
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        if (!has_product(path, from, v, files[i].id)) continue;
        fputs("<li><a href=\"", to);
        html_address(to, v->address);
        fprintf(to, "%s%s\">%s</a>", *v->address ? "/" : "", files[i].file, files[i].file);
        if (*v->name) fputs(" after ", to), page_put_change(to, v->name);
        fprintf(to, ": %s</li>\n", files[i].words);
    }
}

static enum status put_end(struct page *page, const struct levels_sources *from, const struct name_list *edits,
                           struct err *err)
{
    FILE *to = page->to;
    fputs("<section aria-labelledby=\"files-title\">\n<h2 id=\"files-title\">Tables</h2>\n<ul class=\"list\">\n", to);
    for (int i = -1; !err->status && i < edits->count; i++) {
        struct levels_variant v;
        if (!find_variant(&v, i < 0 ? "" : edits->names[i], err)) put_files(to, from, &v);
    }
    fputs(
        "</ul>\n</section>\n<section aria-labelledby=\"how-title\">\n<h2 id=\"how-title\">How sure this is</h2>\n"
        "<p>Light is computed from the photographs by groups, and added up here: what is shown for a state of lamps "
        "and "
        "sky is exact for the model. The model is not: the tables have the interval that holds the true mean 95 times "
        "in 100. Surfaces count as matt, panes let 80 % of the light through, and other buildings do not hide the "
        "sky. Skies of an hour are usual ones for the height of the sun.</p>\n</section>\n",
        to);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------------- all */

/* The edits that have data. */
static enum status find_edits(struct name_list *edits, const struct levels_sources *from, struct err *err)
{
    struct name_list all = {0};
    char folder[FILE_PATH], path[FILE_PATH];
    if (!file_path(folder, from->folder, "lux", "", err)) name_list_add_files(&all, folder, "", "", err);
    for (int i = 0; !err->status && i < all.count; i++) {
        struct levels_variant v;
        if (!find_variant(&v, all.names[i], err) && has_product(path, from, &v, PRODUCT_LIGHT_SCRIPT))
            name_list_add(edits, all.names[i], strlen(all.names[i]), err);
    }
    name_list_release(&all);
    return err->status;
}

static enum status put_body(struct page *page, const struct levels_sources *from, const struct levels_variant *room,
                            const struct name_list *edits, struct err *err)
{
    static const char *const styles[] = {"page.css", "levels.css"};
    FILE *to = page->to;
    page->loads = true;
    if (page_put_head(page, from->scene, ", light levels", styles, 2, err)) return err->status;
    fputs("<p class=\"lead\">How bright it is on the work planes of the rooms, on named places and on what the "
          "photographs show, for lamps, skies and hours that you choose.</p>\n",
          to);
    if (from->back) {
        fputs("<nav aria-label=\"Pages\"><a href=\"", to);
        html_address(to, from->back);
        fputs("\">The page of the scene</a></nav>\n", to);
    }
    fputs("</header>\n<main>\n", to);
    put_controls(to);
    if (put_pictures(page, from, edits, err) || put_films(page, from, edits, err) || put_end(page, from, edits, err))
        return err->status;
    fputs("</main>\n<footer>Made by remodel " REMODEL_VERSION
          ".</footer>\n<script>\nconst variants = [];\nconst remodelLevels = (data) => { variants[variants.length - "
          "1].data = data; };\n</script>\n",
          to);
    put_data(page, from, room, err);
    for (int i = 0; !err->status && i < edits->count; i++) {
        struct levels_variant v;
        if (!find_variant(&v, edits->names[i], err)) put_data(page, from, &v, err);
    }
    if (err->status || page_put_part(page, "script", "relit.js", err) ||
        page_put_part(page, "script", "levels.js", err))
        return err->status;
    fputs("</body>\n</html>\n", to);
    return ST_OK;
}

enum status levels_page_write(struct page *page, const struct levels_sources *from, struct err *err)
{
    struct name_list edits = {0};
    struct levels_variant room = {.name = "", .folder = "lux", .address = ""};
    char path[FILE_PATH];
    if (!has_product(path, from, &room, PRODUCT_LIGHT_SCRIPT))
        return err_set(err, ST_DATA, "found no light levels in %s/lux; make them first: make lux.", from->folder);
    if (!find_edits(&edits, from, err)) put_body(page, from, &room, &edits, err);
    name_list_release(&edits);
    return err->status;
}
