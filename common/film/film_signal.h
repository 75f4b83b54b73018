/* film_signal.h - the formats of films: codec, colour and samples; and the signal of a picture in them.
 *
 * Pictures are scene-linear, with Rec.709 primaries and 1 for the white of an 8-bit picture. A film of high dynamic
 * range shows this white at FILM_WHITE cd/m2, the reference white of [ITU 2023]. See film_signal.c. */
#ifndef REMODEL_FILM_SIGNAL_H
#define REMODEL_FILM_SIGNAL_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/image/image.h"

#define FILM_WHITE    203.0  /* cd/m2 of the radiance 1 */
#define FILM_HLG_PEAK 1000.0 /* cd/m2 of the display that the HLG signal is meant for */

enum film_curve { FILM_SRGB, FILM_HLG, FILM_PQ };

struct film_format {
    const char *name;              /* "h264" */
    const char *ending;            /* of its files: "mp4" */
    const char *encoder, *samples; /* of ffmpeg: "libx264", "yuv420p10le" */
    enum film_curve curve;
    int depth;       /* bits of a sample: 8, interleaved RGB, or 10, planes of Y Cb Cr */
    int chroma_rows; /* rows of luma per row of chroma: 1 or 2; columns: 2 */
};

/* The format of that name, or NULL. */
const struct film_format *film_format_find(const char *name);
/* All names, as "h264, av1, ...". */
const char *film_format_names(void);

/* Signals of light, 0 to 1 [ITU 2018]; f: cd/m2. */
double film_pq_from_light(double f);
/* The signal of a grey. */
double film_hlg_from_light(double f);

/* Bytes of a picture in the format. */
size_t film_format_bytes(const struct film_format *format, int width, int height);
/* Fills `out`. Sides are even. peak: light is clipped there, cd/m2, in PQ. ST_NOMEM. */
enum status film_format_signal(const struct film_format *format, const struct image *linear, double peak, void *out,
                               struct err *err);

struct film_light {           /* of a film in PQ, cd/m2 [CTA 2015] */
    double max_cll, max_fall; /* maximum of a pixel; of the mean of a frame; each of max(R, G, B) */
};
/* Takes a picture into account; for film_format_signal() with this peak. */
void film_light_add(struct film_light *light, const struct image *linear, double peak);

#endif
