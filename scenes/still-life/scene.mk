# Photographed by the project itself: scene.txt and cameras.txt, see docs/scenes.md
PHOTOS := out/still-life/simulated/photos
TRUTH := out/still-life/simulated/truth
# COLMAP's model of these photos, points of at least six views, so that figures move only with the code; `SFM=` runs COLMAP
SFM := scenes/still-life/sfm
PRODUCTS := parallax
