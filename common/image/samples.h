/* samples.h - memory for samples of images. */
#ifndef REMODEL_SAMPLES_H
#define REMODEL_SAMPLES_H

#include <stddef.h>

/* Zeroed memory, aligned to 64 bytes; free with free(). NULL: out of memory. Large blocks use huge pages, which saves
 * page faults when an image is first filled, and TLB misses when it is walked down its columns. */
void *samples_alloc(size_t bytes);

#endif
