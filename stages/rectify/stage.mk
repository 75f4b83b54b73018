# rectify: linear pinhole views, resampled from the photos.
FOLLOWS.rectify := hdr_merge sfm_import
READS.rectify := one photo or hdr/ID.exr, read once, its lens, its mask
HELP.views := + rectified, linear views
