# segment_depth: layered depth of each view, in rounds.
FOLLOWS.segment_depth := rectify find_frame
READS.segment_depth := the frame of the room, one view and the neighbours it selects; its given depth, if there is any; after the first round, their depth maps of the round before and how much these had changed; once there is a model, the model and its axes
VARIABLES.segment_depth := DEPTH
HELP.depth := + layered depth maps
HELP.model_depth := + depth maps of a scene with a model, which fill what no photo shows with the faces behind it

## DEPTH=DIR: depth that is known already: DIR/VIEW.exr or .png of any view (docs/formats.md); the others are matched. Of one photo, the file
