/* writers.h - a textured model in the formats of other programs. */
#ifndef REMODEL_EXPORT_WRITERS_H
#define REMODEL_EXPORT_WRITERS_H

#include "common/model/model_plan.h"
#include "common/product/exports.h"
#include "stages/export_model/export_faces.h"
#include "stages/export_model/export_lamps.h"
#include "stages/export_model/export_objects.h"
#include "stages/export_model/export_things.h"

struct export_scene {
    const char *name; /* of the scene and the edit, for titles */
    const struct solid_mesh *mesh;
    const struct export_faces *faces;
    const struct model_plan *plan;
    const struct export_objects *objects; /* that an edit puts into the model */
    const struct export_lamps *lamps;     /* that an edit adds */
    const struct export_things *things;   /* furniture that the photographs show */
    const int (*page_sizes)[2];
    int page_count;
    double exposure; /* of the pages */
    bool metric;     /* lengths are metres */
    const char *out; /* folder, which has the pages */
    const struct provenance *prov;
};

/* Each writes its file, and what that needs, to OUT. */
#define EXPORT_WRITER(format, file, name, write) enum status write(const struct export_scene *s, struct err *err);
EXPORTS(EXPORT_WRITER)

/* The 22 characters of a GUID, the same for the same text in each run. */
void ifc_guid(char guid[23], const char *text);
/* A STEP string in quotes: ' is doubled, what is not ASCII is written as \X2\...\X0\. */
void ifc_text(FILE *to, const char *text);

#endif
