/* page_parts.h - the sections of the page, one function each, and the markup they share. */
#ifndef REMODEL_PAGE_PARTS_H
#define REMODEL_PAGE_PARTS_H

#include "stages/report/contents.h"
#include "stages/report/html.h"

/* Sections in page order. A section without content writes nothing, or a sentence that says what is missing.
 * ST_NOMEM; ST_IO: a file that the page embeds cannot be read. */
enum status page_videos(FILE *to, const struct contents *c, struct err *err);
enum status page_models(FILE *to, const struct contents *c, struct err *err);
enum status page_things(FILE *to, const struct contents *c, struct err *err);
enum status page_textures(FILE *to, const struct contents *c, struct err *err);
enum status page_light(FILE *to, const struct contents *c, struct err *err);
enum status page_relit(FILE *to, const struct contents *c, struct err *err);
enum status page_evaluation(FILE *to, const struct contents *c, struct err *err);
enum status page_photos(FILE *to, const struct contents *c, struct err *err);
enum status page_depths(FILE *to, const struct contents *c, struct err *err);
enum status page_axes(FILE *to, const struct contents *c, struct err *err);
void page_lens(FILE *to, const struct contents *c);
void page_numbers(FILE *to, const struct contents *c);
void page_usage(FILE *to, const struct contents *c);
void page_settings(FILE *to, const struct contents *c);
void page_warnings(FILE *to, const struct contents *c);
void page_left_out(FILE *to, const struct contents *c);

/* Whether the page has a section of videos: not for a scene that makes a model alone. */
bool page_has_videos(const struct contents *c);

/* Numbers with their units. */
void page_put_seconds(FILE *to, double seconds);
void page_put_mib(FILE *to, double mib);
void page_put_plural(FILE *to, long long n, const char *singular, const char *plural);

/* A name with spaces for its underscores. */
void page_put_spaced(FILE *to, const char *name);

/* An inline label; nothing if the text is "". */
void page_put_tag(FILE *to, const char *text);

/* An <img> with the picture as JPEG of a quality from 1 to 100; its alternative text is "ALT NAME". */
enum status page_put_picture(FILE *to, const struct picture *p, int quality, const char *alt, const char *name,
                             struct err *err);

/* A CSS gradient of the colours of colour_of_ramp(), from left to right; rising: from dark to light. */
void page_put_ramp(FILE *to, bool rising);

/* ", VALUE UNIT LABEL" of a view's metric; nothing if it was not measured. */
void page_put_view_metric(FILE *to, const struct contents *c, const char *view, const char *metric, const char *label);

/* Closes a <div class="ba"> of pictures over each other: the slider that moves the line between them, and whose
 * photograph they are seen from. */
void page_put_slider(FILE *to, const char *label, const char *photo);

#endif
