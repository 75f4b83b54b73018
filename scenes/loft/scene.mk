# Photographed by the project itself: scene.txt and cameras.txt, see docs/scenes.md
PHOTOS := out/loft/simulated/photos
# outdoors, where photographs of the rooms do not tell where the camera stood
LRI := out/loft/simulated/lri
LRI_SFM := out/loft/simulated/truth/lri
TRUTH := out/loft/simulated/truth
PRODUCTS := parallax model
