# hdr_merge: linear radiance of each view, from its exposures; of lighting reference images too.
FOLLOWS.hdr_merge := fit_response
READS.hdr_merge := the exposures of one view, response.txt; only where photos are brackets, TIFF, EXR or raw files; on request of a lighting reference image, which scenes/NAME/lri.txt may place in the model
SHARED.hdr_merge := yes
VARIABLES.hdr_merge := LRI LRI_SFM LRI_FRAME
HELP.hdr := bracketed photos merged; nothing where photos are no brackets
HELP.lri := lighting reference images of LRI merged: linear, on the scene's scale, still fisheye

## LRI=DIR: folder of lighting reference images, for `make lri`: fisheye photos of the light outside, bracketed
## LRI_SFM=DIR: a COLMAP text model that has their cameras, and some of the scene's photos
## LRI_FRAME=photos|scene|model: frame of LRI_SFM: found by these photos (default), the scene's, or that of model/axes.txt
## LRI_FRAME=corners: poses from corners of the model's windows that scenes/NAME/lri.txt marks; LRI_SFM gives lenses only
