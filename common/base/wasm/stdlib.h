/* stdlib.h - the system's, and qsort_r(), which older C libraries for WebAssembly lack (wasm_qsort_r.c). */
#ifndef REMODEL_WASM_STDLIB_H
#define REMODEL_WASM_STDLIB_H

#include_next <stdlib.h>

void qsort_r(void *items, size_t count, size_t size, int (*compare)(const void *, const void *, void *), void *ctx);

#endif
