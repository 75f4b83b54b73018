/* samples.h - memory for the samples of pictures. */
#ifndef REMODEL_SAMPLES_H
#define REMODEL_SAMPLES_H

#include <stddef.h>

/* Zeroed, aligned to 64 bytes, freed by free(); NULL: there is none. Large ones ask for huge pages: who walks a large
 * picture
 * down its rows, or fills it for the first time, would else wait for page after page. */
void *samples_alloc(size_t bytes);

#endif
