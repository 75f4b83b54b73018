# Photographed by the project itself: scene.txt and cameras.txt, see docs/scenes.md
PHOTOS := out/still-life/simulated/photos
TRUTH := out/still-life/simulated/truth
PRODUCTS := parallax
