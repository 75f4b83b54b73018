/* transport.h - light at samples of an edited model, as a linear function of what the samples send out.
 *
 * A sample j of a face sends out its texel times the quotient of irradiance after the edit to before it, or, where the
 * edit gives the face a colour, albedo / pi times its irradiance. Either way a ray that meets a face brings a fixed
 * colour times the values of three samples. Rays are traced once; rounds of light are then sums over numbers in
 * memory. */
#ifndef REMODEL_TRANSPORT_H
#define REMODEL_TRANSPORT_H

#include "common/relight/light_change.h"
#include "stages/update_vita/face_nets.h"

/* What arrives at a sample from the value `from`: 2 j for the quotient of sample j, 2 j + 1 for its irradiance. */
struct transport_entry {
    int from;
    float rgb[3];
};

struct transport_row {
    struct rgb gathered;             /* irradiance in the unedited model; 0 where the sample has no place there */
    struct rgb before;               /* the same, continued into what furniture hid */
    double own;                      /* how far things that stay hide the sample, 0 to 1: its light is not continued */
    struct rgb fixed;                /* irradiance in the edited one that no sample changes: lamps, the sky */
    struct transport_entry *entries; /* in order of `from`; owned */
    int count;
};

/* A sample: of a face net, or behind those an element of an object. */
struct transport_sample {
    struct gather_point after;
    struct light_place place; /* its colour: the mean around the sample */
};

/* {0} is the empty state; everything but the change and the nets is owned. */
struct transport {
    const struct light_change *change;
    const struct face_nets *nets;
    struct transport_sample *samples;
    struct transport_row *rows;
    bool *coloured; /* of each face of the edited model: the edit gives it a colour somewhere */
    int count;
};

/* Sets the samples of `nets`, then of the objects' elements. The caller releases t in each case. */
enum status transport_init(struct transport *t, const struct light_change *change, const struct face_nets *nets,
                           struct err *err);
/* Takes in the samples that were added to the nets since, without rows yet. Rows that are there stay: they send to the
 * samples of their time. */
enum status transport_grow(struct transport *t, struct err *err);
void transport_release(struct transport *t);

/* Computes `count` rows from `first` on with `rays` rays each. Same bits for any number of threads. done: told of
 * samples. */
enum status transport_trace(struct transport *t, int first, int count, int rays,
                            void (*done)(void *ctx, int64_t samples), void *done_ctx, struct err *err);

/* Whether the bake filled the place from around it, because furniture hid it. */
bool transport_is_hole(const struct transport *t, int sample);

/* Irradiance at a sample, from the values of all samples, rgb each: 2 j the quotient, 2 j + 1 the irradiance of sample
 * j. */
struct rgb transport_gather(const struct transport_row *row, const struct rgb *values);

#endif
