/* page_relit.h - the light that an edit makes, on the page of remodelled rooms and on that of numbers. */
#ifndef REMODEL_PAGE_RELIT_H
#define REMODEL_PAGE_RELIT_H

#include <stdio.h>

#include "stages/report/contents_relit.h"

/* How much of a picture has other light; %, as in struct relit_sight. */
void relit_put_change(FILE *to, double changed, double bounded, double kept);
/* What the colours of the change of light mean, and what of it is sure. */
void relit_put_legend(FILE *to);
/* How sure the light is: a sentence about the rounds of light. */
void relit_put_rounds(FILE *to, const struct relit_card *card);

#endif
