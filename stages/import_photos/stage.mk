# import_photos: what the folder of photos holds: a record of each photo, brackets, parts of multi-lens pictures.
FOLLOWS.import_photos := simulate
READS.import_photos := the folder of photos
SHARED.import_photos := yes
VARIABLES.import_photos := PHOTOS SPLIT EXCLUDE

## SPLIT=CxR: each photo is of a multi-lens camera: C columns and R rows of small pictures, which become the photos
## EXCLUDE="NAMES": photos to leave out, by id or file name

ifndef GRAPH
ifneq ($(and $(SCENE),$(SPLIT)),)
  ifeq ($(shell [[ '$(subst ','\'',$(SPLIT))' =~ ^[1-9][0-9]?x[1-9][0-9]?$$ ]] && echo good),)
    $(error SPLIT=$(SPLIT): wanted COLUMNSxROWS, such as 3x2: how many pictures a photo holds)
  endif
  ifeq ($(SPLIT),1x1)
    $(error SPLIT=1x1 leaves each photo as it is; leave SPLIT out)
  endif
endif
else
# lists that products give are read with $(file), not `include`, for which make would first remake them, even under -n
$(eval $(file <$(S)/photos/photos.mk)) # PHOTO_IDS, and BRACKETED where photos are exposures of the same views
ORIGINALS := $(if $(SPLIT),$(S)/split,"$$REMODEL_PHOTOS")

.PHONY: look-photos
look:: look-photos
look-photos: look-slices
	+@stages/import_photos/look.sh $(BIN) $(S) scenes/$(SCENE)
endif
