/* penumbra.h - edges of the old light that an edit takes away, fitted to the photograph.
 *
 * The light before an edit is computed from a model that is off by a centimetre, and from a sun that is off by a tenth
 * of a degree. The edge of an old patch of sun then lies a few pixels beside that in the photograph, and an outline of
 * the patch stays when one is divided by the other. */
#ifndef REMODEL_RELIGHT_PENUMBRA_H
#define REMODEL_RELIGHT_PENUMBRA_H

#include "common/gather/irradiance.h"
#include "stages/relight/quotients.h"

/* {0}: no edge was fitted. */
struct penumbra_stats {
    int points, fitted; /* places on old edges, and how many of them the photograph tells */
    double shift;       /* their root mean square shift, pixels */
};

/* Moves the quotients about old edges to where the photograph has the edges, and makes them as wide as there. matt: the
 * picture's radiance before it is relit, without gloss, R G B; before: the irradiance that it is divided by. Quotients
 * stay bit for bit where the light has no old edge, or the photograph does not tell it. Same bits for any number of
 * threads. ST_NOMEM. */
enum status penumbra_fit(float (*quotient)[4], struct penumbra_stats *stats, const float (*matt)[3],
                         const struct irradiance *before, const struct pixels *p, const struct relight_params *params,
                         struct err *err);

#endif
