/* product.h - whether a file is a whole product, judged by its extension (in either case of letters):
 *
 *   .exr                    decoded to the last pixel
 *   .png .jpg .jpeg         decoded to the last pixel; the format must be the one that the extension names
 *   .ply                    decoded to the last point
 *   .mp4                    boxes that fill the file: ftyp first, and a moov and an mdat
 *   .svg .html              text that ends with the closing tag of its root element
 *   .json                   text that begins with { or [ and ends with the same bracket
 *   .txt .tsv .csv .mk .cfg .obj .mtl .py .log .md .round
 *                           text: not empty, no NUL byte, a line break at the end
 *   any other, or none      not empty: a job must not fail because its product's kind is not listed here
 */
#ifndef REMODEL_PRODUCT_H
#define REMODEL_PRODUCT_H

#include "common/base/err.h"

/* ST_DATA, with the file's name: it is damaged or cut off. ST_IO: it is missing or cannot be read. */
enum status product_verify(const char *path, struct err *err);

#endif
