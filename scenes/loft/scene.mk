# Photographed by the project itself: scene.txt and cameras.txt, see docs/scenes.md
PHOTOS := out/loft/simulated/photos
TRUTH := out/loft/simulated/truth
PRODUCTS := parallax model
