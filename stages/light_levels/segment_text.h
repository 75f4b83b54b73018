/* segment_text.h - numbers on 8-bit pictures, in strokes: digits, ':', '-', '.', ' ', l, x, % and the signs < and >. */
#ifndef REMODEL_SEGMENT_TEXT_H
#define REMODEL_SEGMENT_TEXT_H

#include "common/image/draw.h"

/* Width of a text of this height, px. */
double segment_text_width(const char *text, double height);
/* left, top: its corner, px. Other characters are left out. */
void segment_text_draw(const struct canvas *k, double left, double top, double height, const char *text,
                       const unsigned char colour[3]);

#endif
