# extract_features: local features of a photo.
FOLLOWS.extract_features := import_photos hdr_merge
READS.extract_features := one photo or hdr/*.jpg, its mask
SHARED.extract_features := yes
LIBS.extract_features := -lopencv_features2d -lopencv_imgproc -lopencv_core
HELP.features := + local features of each photo, by which photos are compared
