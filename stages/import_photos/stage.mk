# import_photos: what the folder of photos holds: a record of each photo, brackets, parts of multi-lens pictures, frames of clips, views of panoramas.
FOLLOWS.import_photos := simulate
READS.import_photos := the folder of photos
SHARED.import_photos := yes
LIBS.import_photos := -lavformat -lavcodec -lavutil -lswscale -lopencv_video -lopencv_calib3d -lopencv_imgproc -lopencv_core
VARIABLES.import_photos := PHOTOS SPLIT EXCLUDE

## SPLIT=CxR: each photo is of a multi-lens camera: C columns and R rows of small pictures, which become the photos
## EXCLUDE="NAMES": photos to leave out, by id or file name
