# morph_views: a film from one photo to another.
FOLLOWS.morph_views := hdr_merge sfm_import
READS.morph_views := two photos, their cameras and lenses where there are any
SETTINGS.morph_views := MORPH
LIBS.morph_views := -lopencv_calib3d -lopencv_features2d -lopencv_imgproc -lopencv_core
HELP.morph := the film from one photo of MORPH to the other, along matches (all that a scene of two photos gets)

## MORPH="A B": the two photos, by id, that `make morph` goes between; by default those of a scene of two photos
