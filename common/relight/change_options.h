/* change_options.h - the options of stages that read light before and after an edit. */
#ifndef REMODEL_CHANGE_OPTIONS_H
#define REMODEL_CHANGE_OPTIONS_H

#include "common/base/cli.h"
#include "common/relight/light_change.h"

/* files: a struct light_change_files *; needed: CLI_REQUIRED, or CLI_OPTIONAL where the stage can do without */
#define CHANGE_OPTIONS(files, needed)                                                                      \
    CLI_STR("model", &(files)->base, needed, "the unedited model, model.txt"),                             \
        CLI_STR("edited", &(files)->edited, needed, "the edited model, model.txt"),                        \
        CLI_STR("map", &(files)->map, needed, "where its faces take their texture, texture.txt"),          \
        CLI_STR("axes", &(files)->axes, needed, "the models' frame, axes.txt"),                            \
        CLI_STR("vita", &(files)->vita, needed, "folder of the unedited view-independent atlas"),          \
        CLI_STR("outdoors", &(files)->outdoors, CLI_OPTIONAL,                                              \
                "what lies outside, by direction; without it, it is dark"),                                \
        CLI_STR("lights", &(files)->lights, CLI_OPTIONAL, "lamps and openings, lights.txt"),               \
        CLI_STR("references", &(files)->references, CLI_OPTIONAL,                                          \
                "folder of the lighting reference images that openings name"),                             \
        CLI_STR("objects", &(files)->objects, CLI_OPTIONAL, "synthetic objects of the edit, objects.txt"), \
        CLI_STR("things", &(files)->things, CLI_OPTIONAL,                                                  \
                "folder of the scene's things: where the edit changes one, they throw shadows"),           \
        CLI_STR("lux-scale", &(files)->lux_scale, CLI_OPTIONAL,                                            \
                "lx of the photographs' unit, scale.txt: lamps with IES files that the edit adds shine"),  \
        CLI_STR("edited-plan", &(files)->edited_plan, CLI_OPTIONAL,                                        \
                "plan.txt of the edit, by which such lamps guess a metre in a scene without a scale"),     \
        CLI_STR("scene", &(files)->scene, CLI_OPTIONAL, "folder of the objects' meshes and IES files")

#endif
