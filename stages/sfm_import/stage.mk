# sfm_import: the SfM model as rectified pinhole views.
FOLLOWS.sfm_import := sfm
READS.sfm_import := sfm/, photos/
SETTINGS.sfm_import := HOLDOUT HOLDOUT_VIEWS
HELP.sfm := + camera poses: COLMAP, or the model in SFM

## HOLDOUT=N: every Nth photo, the first included, is kept out of depth and rendering, to compare; in out/SCENE+holdoutN
## HOLDOUT_VIEWS="NAMES": the same for these photos or views, in out/SCENE+holdout
