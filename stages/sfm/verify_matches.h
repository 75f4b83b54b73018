/* verify_matches.h - matches of the photos that agree with one geometry, by COLMAP. */
#ifndef REMODEL_VERIFY_MATCHES_H
#define REMODEL_VERIFY_MATCHES_H

#include "stages/sfm/colmap_job.h"

/* Verifies the matches of the job's photos, whose features its database holds, and adds the pairs that pass to the
 * database. The result does not depend on the number of threads. */
enum status verify_matches(const struct colmap_job *job, struct err *err);

#endif
