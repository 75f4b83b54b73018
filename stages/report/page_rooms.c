/* page_rooms.c - see page_rooms.h. */
#include "stages/report/page_rooms.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/memory_text.h"
#include "common/capture/panorama_name.h"
#include "common/texture/picture_made.h"
#include "stages/report/page_relit.h"

enum { QUALITY = 82, SIDE_QUALITY = 75 };

/* How much of the picture is photograph, and how much is guessed; of what the photo's frame shows. */
static void put_shares(FILE *to, const struct room_look *look)
{
    const double *shares = look->shares;
    const double scale = 100 / fmax(1, 100 - shares[MADE_NOTHING]);
    const double photo = scale * (shares[MADE_PHOTO] + shares[MADE_ORIGINAL]);
    const double other = scale * (shares[MADE_WARPED] + shares[MADE_OUTDOORS] + shares[MADE_CLUTTER]);
    const double guessed = scale * (shares[MADE_SYNTHESISED] + shares[MADE_UNSURE]);
    const double colour = scale * shares[MADE_COLOUR];
    if (!look->after.rgb) {
        fputs("In the old light this change alters nothing here.", to);
        return;
    }
    fprintf(to, "%.0f %% of this picture is the photograph", photo);
    if (other >= 0.5) fprintf(to, ", %.0f %% comes from other photographs", other);
    if (guessed >= 0.5) fprintf(to, ", %.0f %% is guessed", guessed);
    if (colour >= 0.5) fprintf(to, ", %.0f %% is a plain colour", colour);
    fputs(".", to);
}

static void put_attribute(struct page *page, const char *attribute, const char *file)
{
    if (file[0]) fprintf(page->to, " %s=\"%s%s\"", attribute, page->address, file);
}

/* The file of a picture; "" if there is none. */
static enum status write_layer(struct page *page, const struct picture *p, int quality, char file[PICTURE_NAME],
                               struct err *err)
{
    file[0] = '\0';
    return p->rgb ? page_write_picture(page, p, quality, file, err) : ST_OK;
}

/* A change as an item of the list: links to its pictures, and what is to be said of them. first: its picture after the
 * change, as the page shows it to begin with. */
static enum status put_look(struct page *page, const struct rooms *rooms, const struct room_look *look,
                            const char *before, char first[PICTURE_NAME], struct err *err)
{
    FILE *to = page->to;
    const char *change = rooms->changes[look->change].name;
    char after[PICTURE_NAME], relit[PICTURE_NAME], made[PICTURE_NAME], ratio[PICTURE_NAME];
    if (write_layer(page, &look->after, QUALITY, after, err) || write_layer(page, &look->relit, QUALITY, relit, err) ||
        write_layer(page, &look->made, 0, made, err) || write_layer(page, &look->ratio, SIDE_QUALITY, ratio, err))
        return err->status;
    if (!first[0]) snprintf(first, PICTURE_NAME, "%s", relit[0] ? relit : after);
    fputs("<li data-change=\"", to);
    html_text(to, change);
    fputs("\" data-name=\"", to);
    page_put_change(to, change);
    fputs("\"", to);
    put_attribute(page, "data-made", made);
    put_attribute(page, "data-ratio", ratio);
    fprintf(to, "><a class=\"day\" href=\"%s%s\">", page->address, after[0] ? after : before);
    page_put_change(to, change);
    fputs("</a>: <span class=\"day-says\">", to);
    put_shares(to, look);
    fputs("</span>", to);
    if (relit[0]) {
        fprintf(to, " <a class=\"new\" href=\"%s%s\">In the new light</a>: <span class=\"new-says\">", page->address,
                relit);
        relit_put_change(to, look->light, look->bounded, look->kept);
        fputs("</span>", to);
    }
    fputs("</li>\n", to);
    return ST_OK;
}

/* The list of changes is written to memory first, because the picture before it shows the first one. */
static enum status put_looks(struct page *page, const struct rooms *rooms, const struct room_photo *p,
                             const char *before, char **list, char first[PICTURE_NAME], struct err *err)
{
    struct memory_text m = {0};
    FILE *to = page->to;
    if (memory_text_open(&m, "a list of changes", err)) return err->status;
    page->to = m.to;
    for (int k = 0; !err->status && k < p->look_count; k++) put_look(page, rooms, &p->looks[k], before, first, err);
    if (!err->status && !memory_text_close(&m, "a list of changes", err)) {
        *list = m.text; /* which is the caller's now */
        m.text = NULL;
    }
    memory_text_release(&m);
    page->to = to;
    return err->status;
}

static enum status put_room(struct page *page, const struct rooms *rooms, const struct room_photo *p, struct err *err)
{
    FILE *to = page->to;
    const struct room_look *look = &p->looks[0];
    const char *change = rooms->changes[look->change].name;
    char before[PICTURE_NAME], first[PICTURE_NAME] = "", size[64];
    char *list = NULL;
    if (!page_write_picture(page, &p->before, QUALITY, before, err) &&
        !put_looks(page, rooms, p, before, &list, first, err)) {
        snprintf(size, sizeof size, "loading=\"lazy\" width=\"%d\" height=\"%d\"", p->before.width, p->before.height);
        fputs("<figure class=\"room\" data-photo=\"", to);
        page_put_photo_name(to, p->photo);
        fprintf(to, "\">\n<div class=\"ba\"><img class=\"after\" %s src=\"%s%s\" alt=\"", size, page->address, first);
        page_put_photo_name(to, p->photo);
        fputs(" after the change: ", to);
        page_put_change(to, change);
        fprintf(to, "\"><img class=\"before\" %s src=\"%s%s\" alt=\"", size, page->address, before);
        page_put_photo_name(to, p->photo);
        fputs(" before the change\"><i class=\"line\"></i><b class=\"left\">before</b><b class=\"right\">", to);
        page_put_change(to, change);
        fprintf(to,
                "%s</b><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" step=\"1\" aria-label=\"Line between "
                "before and after: ",
                look->relit.rgb ? ", new light" : "");
        page_put_photo_name(to, p->photo);
        fputs("\"></div>\n<figcaption><b>", to);
        page_put_photo_name(to, p->photo);
        fprintf(to, "</b>. <span class=\"says\"></span></figcaption>\n<ul class=\"looks\">\n%s</ul>\n</figure>\n",
                list);
    }
    free(list);
    return err->status;
}

/* What the changes are, in the words of their scripts; page.js shows that of the chosen one. */
static void put_about(FILE *to, const struct rooms *rooms)
{
    bool any = false;
    for (int i = 0; i < rooms->change_count; i++) {
        const struct room_change *change = &rooms->changes[i];
        if (!change->about[0] || !change->photos) continue;
        fputs(any ? "<div data-change=\"" : "<dl class=\"about looks\">\n<div data-change=\"", to);
        any = true;
        html_text(to, change->name);
        fputs("\"><dt>", to);
        page_put_change(to, change->name);
        fputs("</dt><dd>", to);
        html_text(to, change->about);
        fputs("</dd></div>\n", to);
    }
    if (any) fputs("</dl>\n", to);
}

/* Begins a place: the faces of a panorama. */
static void put_place(FILE *to, const char *photo)
{
    int yaw;
    char name[256];
    snprintf(name, sizeof name, "%.*s", (int)panorama_name_read(&yaw, photo), photo);
    fputs("<section class=\"place\" aria-label=\"Panorama ", to);
    html_text(to, name);
    fputs("\">\n<h3>Panorama ", to);
    html_text(to, name);
    fputs("</h3>\n", to);
}

enum status page_rooms(struct page *page, const struct rooms *rooms, struct err *err)
{
    if (!rooms->photo_count) return ST_OK;
    put_about(page->to, rooms);
    fputs("<div class=\"rooms\">\n", page->to);
    for (int i = 0; i < rooms->photo_count; i++) {
        /* faces of one panorama stand together: rooms_choice.c */
        const struct room_photo *p = &rooms->photos[i];
        const bool follows = i && panorama_name_same(p[-1].photo, p->photo);
        const bool goes_on = i + 1 < rooms->photo_count && panorama_name_same(p->photo, p[1].photo);
        if (goes_on && !follows) put_place(page->to, p->photo);
        if (put_room(page, rooms, p, err)) return err->status;
        if (follows && !goes_on) fputs("</section>\n", page->to);
    }
    fputs("</div>\n", page->to);
    if (rooms->photos_changed > rooms->photo_count) {
        fputs("<p class=\"muted\">", page->to);
        page_put_plural(page->to, rooms->photos_changed - rooms->photo_count, "more photograph shows",
                        "more photographs show");
        fputs(" a change; the ones that show most are here.</p>\n", page->to);
    }
    return ST_OK;
}

static bool any_relit(const struct rooms *rooms)
{
    for (int i = 0; i < rooms->photo_count; i++)
        for (int k = 0; k < rooms->photos[i].look_count; k++)
            if (rooms->photos[i].looks[k].relit.rgb) return true;
    return false;
}

/* What is sure of the light, and what is guessed. */
static void put_new_light(FILE *to, bool relit)
{
    if (!relit) {
        fputs("The light is that of the day of the photographs: a new window does not brighten the room yet. ", to);
        return;
    }
    fputs("The old light is that of the day of the photographs. The new light multiplies the photograph by how much "
          "the light on each surface changes, calculated from the shape of the rooms and the light that the "
          "photographs show. So shadows and patches of sun that were photographed stay where the light stays, and "
          "patterns and colours are real. The change itself is calculated: it is sure where the photographs show where "
          "the light comes from, and a guess where they do not, such as the sky beyond what a window shows, or behind "
          "furniture. Where the guess would go wrong visibly it is limited, and the picture of the change is striped. "
          "Surfaces that the change makes are lit as if they were matt. ",
          to);
}

void page_rooms_how(FILE *to, const struct rooms *rooms)
{
    const bool relit = any_relit(rooms);
    fputs("<section id=\"how\">\n<h2>What is real</h2>\n<p>Where a change alters nothing, a picture is the photograph "
          "itself. Where it reveals something, other photographs fill in if they show it. What no photograph shows is "
          "guessed from what is beside it. ",
          to);
    put_new_light(to, relit);
    fputs("</p>\n<p>Tick \"show what is real\" under a picture to see this in colours:</p>\n<ul class=\"key\">\n", to);
    for (int k = MADE_PHOTO; k < MADE_COUNT; k++) {
        const struct picture_made_kind *kind = picture_made_kind((enum picture_made)k);
        fprintf(to, "<li><i style=\"background:#%02x%02x%02x\"></i>%s</li>\n", kind->rgb[0], kind->rgb[1], kind->rgb[2],
                kind->label);
    }
    fputs("</ul>\n", to);
    if (relit) {
        fputs("<p>In the new light it shows how the light changes, in grey:</p>\n", to);
        relit_put_legend(to);
    }
    if (rooms->note_count) fputs("<ul class=\"list\">\n", to);
    for (int i = 0; i < rooms->note_count; i++) {
        fputs("<li>", to);
        html_text(to, rooms->notes[i]);
        fputs("</li>\n", to);
    }
    if (rooms->note_count) fputs("</ul>\n", to);
    fputs("</section>\n", to);
}
