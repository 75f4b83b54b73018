/* page_parts.h - what a page is written to, the sections of both pages of a scene, and the markup they share. */
#ifndef REMODEL_PAGE_PARTS_H
#define REMODEL_PAGE_PARTS_H

#include "common/base/hash.h"
#include "common/graph/name_list.h"
#include "stages/report/contents.h"
#include "stages/report/html.h"

enum { PICTURE_NAME = HASH_TEXT + 8 };

/* A page, and the folder of its pictures. Their names are hashes of what they show, so that an older page keeps its
 * pictures until the new one is there. */
struct page {
    FILE *to;
    const char *parts;         /* folder of page.css, page.js, ... */
    const char *folder;        /* of the pictures; it is made */
    const char *address;       /* of that folder from the page, "" or with a / at its end */
    bool loads;                /* it loads scripts beside it */
    const char *scene;         /* address of the scene's folder from the page, "" or with a / at its end */
    struct name_list pictures; /* files of the folder that the page shows; owned */
};

/* Removes pictures of the folder that are not in `kept`. What cannot be removed stays. */
void page_remove_old(const char *folder, const struct name_list *kept);

/* The sections of the page for people, in its order. A section without content writes nothing.
 * ST_NOMEM; ST_IO: a picture cannot be written. */
enum status page_films(struct page *page, const struct contents *c, struct err *err);
enum status page_plan(struct page *page, const struct contents *c, struct err *err);
enum status page_levels_part(struct page *page, const struct contents *c, struct err *err);
enum status page_photos(struct page *page, const struct contents *c, struct err *err);
void page_few_numbers(FILE *to, const struct contents *c);

/* The sections of the page of numbers, in its order; some say what is missing. */
enum status page_videos(struct page *page, const struct contents *c, struct err *err);
void page_models(struct page *page, const struct contents *c);
void page_things(struct page *page, const struct contents *c);
enum status page_textures(struct page *page, const struct contents *c, struct err *err);
enum status page_light(struct page *page, const struct contents *c, struct err *err);
enum status page_relit(struct page *page, const struct contents *c, struct err *err);
enum status page_evaluation(struct page *page, const struct contents *c, struct err *err);
enum status page_depths(struct page *page, const struct contents *c, struct err *err);
enum status page_axes(struct page *page, const struct contents *c, struct err *err);
void page_photo_table(FILE *to, const struct contents *c);
void page_lens(FILE *to, const struct contents *c);
void page_numbers(FILE *to, const struct contents *c);
void page_usage(FILE *to, const struct contents *c);
void page_settings(FILE *to, const struct contents *c);
void page_warnings(FILE *to, const struct contents *c);
void page_left_out(FILE *to, const struct contents *c);

/* Whether the page of numbers has a section of videos: not for a scene that makes a model alone. */
bool page_has_videos(const struct contents *c);

/* The beginning of a page up to its title; styles: files of page->parts. */
enum status page_put_head(struct page *page, const char *title, const char *more, const char *const *styles, int count,
                          struct err *err);
/* A file of page->parts between <TAG> and </TAG>. ST_IO. */
enum status page_put_part(struct page *page, const char *tag, const char *file, struct err *err);

/* "Photograph NAME", or of a face of a panorama "Panorama NAME, 60 degrees to the right". */
void page_put_photo_name(FILE *to, const char *photo);

/* Numbers with their units. */
void page_put_seconds(FILE *to, double seconds);
void page_put_mib(FILE *to, double mib);
void page_put_plural(FILE *to, long long n, const char *singular, const char *plural);

/* A name with spaces for its underscores. */
void page_put_spaced(FILE *to, const char *name);
/* The name of a change as words: with spaces for _ and -. */
void page_put_change(FILE *to, const char *name);

/* An inline label; nothing if the text is "". */
void page_put_tag(FILE *to, const char *text);

/* Writes a picture into the page's folder: JPEG of a quality from 1 to 100, or PNG (0). name: its file. */
enum status page_write_picture(struct page *page, const struct picture *p, int quality, char name[PICTURE_NAME],
                               struct err *err);
/* The same, with an <img> whose alternative text is "ALT NAME". The browser loads it when it is near. */
enum status page_put_picture(struct page *page, const struct picture *p, int quality, const char *alt, const char *name,
                             struct err *err);
/* Copies a picture file into the page's folder; ending: ".svg". */
enum status page_copy_picture(struct page *page, const char *file, const char *ending, char name[PICTURE_NAME],
                              struct err *err);
/* The address of a product of the scene, for an attribute; folder: the scene's. */
void page_put_product(struct page *page, const char *folder, const char *path);

/* A CSS gradient of the colours of colour_of_ramp(), from left to right; rising: from dark to light. */
void page_put_ramp(FILE *to, bool rising);

/* ", VALUE UNIT LABEL" of a view's metric; nothing if it was not measured. */
void page_put_view_metric(FILE *to, const struct contents *c, const char *view, const char *metric, const char *label);

#endif
