# segment_depth: layered depth of each view, in rounds.
FOLLOWS.segment_depth := rectify find_frame
READS.segment_depth := the frame of the room, one view and the neighbours it selects; its given depth, if there is any; after the first round, their depth maps of the round before and how much these had changed
LIBS.segment_depth := -lembree3
VARIABLES.segment_depth := DEPTH
HELP.depth := + layered depth maps

## DEPTH=DIR: depth that is known already: DIR/VIEW.exr or .png of any view (docs/formats.md); the others are matched
