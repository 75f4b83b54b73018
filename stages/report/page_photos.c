/* page_photos.c - the photographs, small, for people; and as a table. */
#include "common/capture/panorama_name.h"
#include "stages/report/page_parts.h"

/* Of the list of photos, whether the faces of a panorama begin or end before one: these are one item of the list. */
static bool is_face_of(const struct contents *c, int i, int k)
{
    return i >= 0 && k < c->photos.count &&
           panorama_name_same(c->photo_cards[i].record->file, c->photo_cards[k].record->file);
}

static enum status put_photo(struct page *page, const struct contents *c, const struct photo_card *card,
                             struct err *err)
{
    FILE *to = page->to;
    int yaw;
    const bool off = c->has_views && !card->views && !card->held_out;
    fputs("<li><figure>", to);
    if (!card->picture.rgb)
        fputs("<div class=\"none\">no picture</div>", to);
    else if (page_put_picture(page, &card->picture, 75, "Photograph", card->record->file, err))
        return err->status;
    fputs("<figcaption><b>", to);
    if (panorama_name_read(&yaw, card->record->file))
        page_put_photo_name(to, card->record->file);
    else
        html_text(to, card->record->file);
    fputs("</b>", to);
    if (card->held_out) page_put_tag(to, "kept aside to compare with");
    if (off) page_put_tag(to, "could not be placed");
    page_put_tag(to, card->problem);
    fputs("</figcaption></figure></li>\n", to);
    return ST_OK;
}

enum status page_photos(struct page *page, const struct contents *c, struct err *err)
{
    FILE *to = page->to;
    fputs("<section id=\"photos\" aria-labelledby=\"photos-title\">\n<h2 id=\"photos-title\">Photographs</h2>\n", to);
    fputs(c->photos.count ? "<ul class=\"photos\">\n" : "<p>No photographs are listed yet.</p>\n", to);
    for (int i = 0; i < c->photos.count; i++) {
        const bool follows = is_face_of(c, i - 1, i), goes_on = is_face_of(c, i, i + 1);
        if (goes_on && !follows) fputs("<li class=\"place\"><ul class=\"photos\">\n", to);
        if (put_photo(page, c, &c->photo_cards[i], err)) return err->status;
        if (follows && !goes_on) fputs("</ul></li>\n", to);
    }
    fputs(c->photos.count ? "</ul>\n</section>\n" : "</section>\n", to);
    return ST_OK;
}

void page_photo_table(FILE *to, const struct contents *c)
{
    if (!c->photos.count) return;
    fputs(
        "<section id=\"photos\" aria-labelledby=\"photos-title\">\n<h2 id=\"photos-title\">Photographs</h2>\n<details>"
        "<summary>Size, colours and fit of each</summary>\n<div class=\"wide\"><table>\n<thead><tr><th "
        "scope=\"col\">File</th><th scope=\"col\" class=\"n\">Size, px</th><th scope=\"col\">Colours</th><th "
        "scope=\"col\" class=\"n\">Views</th><th scope=\"col\" class=\"n\">Median error of its points, px</th><th "
        "scope=\"col\"></th></tr></thead>\n<tbody>\n",
        to);
    for (int i = 0; i < c->photos.count; i++) {
        const struct photo_card *card = &c->photo_cards[i];
        const struct photo_info *info = &card->record->info;
        fputs("<tr><th scope=\"row\">", to);
        html_text(to, card->record->file);
        fprintf(to, "</th><td class=\"n\">%d × %d</td><td>", info->width, info->height);
        html_text(to, *info->colour ? info->colour : "sRGB");
        fprintf(to, "</td><td class=\"n\">%d</td><td class=\"n\">", card->views);
        if (card->residual > 0) fprintf(to, "%.2f", card->residual);
        fputs("</td><td>", to);
        if (card->held_out) page_put_tag(to, "held out");
        if (c->has_views && !card->views && !card->held_out) page_put_tag(to, "not placed by SfM");
        page_put_tag(to, card->problem);
        fputs("</td></tr>\n", to);
    }
    fputs("</tbody>\n</table></div>\n</details>\n</section>\n", to);
}
