/* page_relit.h - the light that an edit makes, on the page of remodelled rooms and on that of the scene. */
#ifndef REMODEL_PAGE_RELIT_H
#define REMODEL_PAGE_RELIT_H

#include <stdio.h>

#include "stages/report/contents_relit.h"

extern const char relit_style[]; /* CSS, after that of sliders */

/* Views with sliders and the change of light, of edit `number` of the page; nothing if there are none. ST_NOMEM. */
enum status relit_put_edit(FILE *to, const struct relit_card *card, int number, struct err *err);
/* What the colours of the change of light mean, and what of it is sure. */
void relit_put_legend(FILE *to);
/* How sure the light is: a sentence about the rounds of light. */
void relit_put_rounds(FILE *to, const struct relit_card *card);

#endif
