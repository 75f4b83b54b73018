/* lamp_light.h - the direct light of each lamp at the pixels of a picture, after an edit. */
#ifndef REMODEL_LAMP_LIGHT_H
#define REMODEL_LAMP_LIGHT_H

#include "stages/relight/pixels.h"

/* {0} is the empty state; everything but the names is owned. */
struct lamp_light {
    const char **names; /* of lights.txt, then those that the edit adds */
    float (**light)[3]; /* irradiance from the lamp alone, of each pixel */
    int count;
};

/* Gathers with `rays` rays a lamp and pixel. Lamps that are off are left out. The caller releases l in each case. Same
 * bits for any number of threads. */
enum status lamp_light_gather(struct lamp_light *l, const struct pixels *p, const struct light_change *c, int rays,
                              struct err *err);
void lamp_light_release(struct lamp_light *l);

#endif
