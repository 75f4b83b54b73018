/* judgement.h - what is said about a set of photographs. */
#ifndef REMODEL_JUDGEMENT_H
#define REMODEL_JUDGEMENT_H

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "stages/judge_photos/judge_params.h"
#include "stages/judge_photos/photo_measures.h"

struct judged_photo {
    const struct photo_record *record;
    struct photo_measures measures;
    bool readable;
    int features;
    int links; /* photos that it overlaps */
    int group; /* index of the first photo of those that overlaps connect to it */
};

struct judgement {
    struct judged_photo *photos; /* owned */
    int count;
    const struct judge_params *params;
};

/* Adds an overlap of two photos: counts it and joins their groups. */
void judgement_link(struct judgement *j, int first, int second);
/* Puts views of one panorama, which have one place, into one group. */
void judgement_join_panoramas(struct judgement *j);

/* Writes out/SCENE/judgement.txt and says the same: warnings about photos, advice about the set. */
enum status judgement_write(const struct judgement *j, const char *path, const struct provenance *prov,
                            struct err *err);

#endif
