/* page_photos.c - thumbnails of the photographs. */
#include "stages/report/page_parts.h"

enum status page_photos(FILE *to, const struct contents *c, struct err *err)
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
            if (page_put_picture(to, &card->picture, 80, "Photograph", card->record->file, err)) return err->status;
        } else {
            fprintf(to, "<div class=\"none\">no picture</div>");
        }
        fputs("<figcaption><b>", to);
        html_text(to, card->record->file);
        fprintf(to, "</b> <span class=\"size\">%d × %d</span>", card->record->info.width, card->record->info.height);
        if (*card->record->info.colour) {
            fputs(", ", to);
            html_text(to, card->record->info.colour);
        }
        if (card->views > 1) fprintf(to, ", %d views", card->views);
        if (card->residual > 0) fprintf(to, ", residual %.2f px", card->residual);
        if (card->held_out) page_put_tag(to, "held out");
        if (off) page_put_tag(to, "not placed by SfM");
        page_put_tag(to, card->problem);
        fputs("</figcaption></figure></li>\n", to);
    }
    fputs(c->photos.count ? "</ul>\n</section>\n" : "</section>\n", to);
    return ST_OK;
}
