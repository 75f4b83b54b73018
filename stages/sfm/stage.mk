# sfm: camera poses by COLMAP, or a given model.
FOLLOWS.sfm := match_photos
READS.sfm := photos or hdr/*.jpg, their features and matches (runs COLMAP), or a given model
SHARED.sfm := yes
VARIABLES.sfm := SFM
SETTINGS.sfm := LENS
LIBS.sfm := -lsqlite3 -ljansson

## LENS=MODEL: with a new SCENE: the camera model of its lens, for example EQUISOLID for most fisheyes; it is written to scenes/SCENE/scene.cfg
## SFM=DIR: cameras of the photos by another program, in place of running COLMAP: COLMAP, Bundler, transforms.json, Metashape .xml, RealityScan .csv
