/* fuzz.h - what a fuzz target exports: one input; it returns 0, and aborts where a promise is broken. */
#ifndef REMODEL_TESTS_FUZZ_H
#define REMODEL_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
