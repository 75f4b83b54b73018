/* fuzz.h - the entry point of a fuzz target: runs one input, returns 0, and aborts if an assertion fails. */
#ifndef REMODEL_TESTS_FUZZ_H
#define REMODEL_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
