/* passing.h - troubles that pass, such as short memory or an error of the disk. A page shows what it can of what is
 * missing or damaged; but one that hides what it could not read for a moment would stay. */
#ifndef REMODEL_REPORT_PASSING_H
#define REMODEL_REPORT_PASSING_H

#include "common/base/err.h"

/* ST_IO, with the sentence, if it tells of such a trouble. */
enum status passing_refuse(const char *sentence, struct err *err);

#endif
