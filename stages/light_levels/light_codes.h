/* light_codes.h - arrays of light as 16-bit numbers in base64, for pages.
 *
 * Light: 0 is none, otherwise n is low (high / low)^((n - 1) / 65534), with low = high / 1e7. Numbers of either sign: n
 * is most (n - 32768) / 32767. Both are exact to some ten-thousandths. The low byte comes first. */
#ifndef REMODEL_LIGHT_CODES_H
#define REMODEL_LIGHT_CODES_H

#include <stdio.h>

#include "common/base/err.h"

/* Write the base64 of the numbers. light_codes_highest(): the `high` of light, light_codes_most(): the `most` of signed
 * numbers. ST_NOMEM. */
double light_codes_highest(const float *values, size_t count);
double light_codes_most(const float *values, size_t count);
enum status light_codes_put(FILE *to, const float *values, size_t count, double high, struct err *err);
enum status light_codes_put_signed(FILE *to, const float *values, size_t count, double most, struct err *err);

/* The reverse, of bytes that base64_read() gave: 2 * count of them. */
void light_codes_take(float *values, const unsigned char *bytes, size_t count, double high);
void light_codes_take_signed(float *values, const unsigned char *bytes, size_t count, double most);
double light_codes_low(double high);

/* Runs of equal numbers: how many and which, each seven bits a byte, the last byte of a number below 128. */
enum status light_codes_put_runs(FILE *to, const int *values, size_t count, struct err *err);
/* False: the bytes are not those of `count` numbers. */
int light_codes_take_runs(int *values, const unsigned char *bytes, size_t size, size_t count);

#endif
