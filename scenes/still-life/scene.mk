# Rendered by the project itself from scene.txt and cameras.txt (docs/scenes.md).
PHOTOS := out/still-life/simulated/photos
TRUTH := out/still-life/simulated/truth
# COLMAP's model of these photos, with points seen by at least six views. It is fixed so that only a change of code
# changes the metrics; `SFM=` runs COLMAP.
SFM := scenes/still-life/sfm
PRODUCTS := parallax
