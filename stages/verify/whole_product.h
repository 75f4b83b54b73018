/* whole_product.h - whether a file is a whole product. Its kind follows from the table of products, by its path, its
 * name or its extension:
 *
 *   EXR                     decoded to the last pixel
 *   PNG, JPEG               decoded to the last pixel; the format must be the one that the extension names
 *   PLY                     decoded to the last point
 *   MP4                     boxes that fill the file: ftyp first, and a moov and an mdat
 *   SVG, HTML               text that ends with the closing tag of its root element
 *   JSON                    text that begins with { or [ and ends with the same bracket
 *   other texts             not empty, no NUL byte, a line break at the end; the first line of the product
 *   atlas, texture map, objects   read, an atlas with its pages
 *   any other               not empty: a job must not fail because its product's kind is not listed here
 */
#ifndef REMODEL_WHOLE_PRODUCT_H
#define REMODEL_WHOLE_PRODUCT_H

#include "common/base/err.h"

/* ST_DATA, with the file's name: it is damaged or cut off. ST_IO: it is missing or cannot be read. */
enum status product_verify(const char *path, struct err *err);

#endif
