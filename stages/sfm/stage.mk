# sfm: camera poses by COLMAP, or a given model.
FOLLOWS.sfm := import_photos hdr_merge
READS.sfm := photos or hdr/*.jpg (runs COLMAP), or a given model
SHARED.sfm := yes
VARIABLES.sfm := SFM
HELP.resfm := run COLMAP again, after photos were changed

## SFM=DIR: a COLMAP (text, binary) or Bundler model of the photos, used in place of running COLMAP
