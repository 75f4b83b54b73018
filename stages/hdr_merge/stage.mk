# hdr_merge: linear radiance of each view, from its exposures; of lighting reference images too.
FOLLOWS.hdr_merge := fit_response
READS.hdr_merge := the exposures of one view, response.txt; only where photos are brackets, TIFF, EXR or raw files; on request of a lighting reference image, which scenes/NAME/lri.txt may place in the model
SHARED.hdr_merge := yes
VARIABLES.hdr_merge := LRI LRI_SFM LRI_FRAME
STEPS.hdr_merge := hdr lri
HELP.hdr := bracketed photos merged; nothing where photos are no brackets
HELP.lri := lighting reference images of LRI merged: linear, on the scene's scale, still fisheye
RUN.hdr := farm
RUN.lri := farm
# the scene's cameras, its axes or its model, where the poses of the images must be moved to its frame or found in it
NEEDS.lri = $(if $(filter corners,$(LRI_FRAME)),model,$(if $(value REMODEL_LRI_SFM),$(if $(filter scene,$(LRI_FRAME)),,\
  $(if $(filter model,$(LRI_FRAME)),axes,sfm))))

## LRI=DIR: folder of lighting reference images, for `make lri`: fisheye photos of the light outside, bracketed
## LRI_SFM=DIR: a COLMAP text model that has their cameras, and some of the scene's photos
## LRI_FRAME=photos|scene|model: frame of LRI_SFM: found by these photos (default), the scene's, or that of model/axes.txt
## LRI_FRAME=corners: poses from corners of the model's windows that scenes/NAME/lri.txt marks; LRI_SFM gives lenses only

ifdef GRAPH
HDR := $(if $(BRACKETED),$(foreach p,$(PHOTO_IDS),$(S)/hdr/$(p).exr $(S)/hdr/$(p).jpg))
# what later stages take for the photos, and what a photo's view is made from; $(1): a photo's id
PICTURES := $(if $(BRACKETED),$(S)/hdr,$(ORIGINALS))
picture = $(if $(BRACKETED),$(S)/hdr/$(1).exr,$(S)/photos/$(1).txt)
.PHONY: hdr lri look-lri
hdr: $(HDR)

# a view's exposures; all qualities share them
define hdr_rules
$(S)/hdr/$(1).exr $(S)/hdr/$(1).jpg &: $(S)/photos/$(1).txt $(RESPONSE) $(call shared_needs,hdr_merge) | $(RESPONSE_STAMP)
	$$(hide)$$(call farm,hdr_merge,$(1),$(S)/hdr/$(1).jpg $(S)/hdr/$(1).exr,\
	  --id $(1) --photos $$(ORIGINALS) --records $(S)/photos --response $(RESPONSE) --out $(S)/hdr,,$(S))
endef
$(if $(BRACKETED),$(foreach p,$(PHOTO_IDS),$(eval $(call hdr_rules,$(p)))))

# lighting reference images: merged like a view's exposures, with the scene's curve; the EXR holds their lens and pose
LRI_IDS := $(call list_in,$(S)/lri/photos/photos.mk,PHOTO_IDS)
lri: $(LRI_IDS:%=$(S)/lri/%.exr) $(LRI_IDS:%=$(S)/lri/%.jpg)
LRI_RESPONSE := $(if $(BRACKETED),$(RESPONSE),$(wildcard scenes/$(SCENE)/response.txt))
LRI_FOLDER := "$$REMODEL_LRI"
LRI_MODEL := $(if $(value REMODEL_LRI_SFM),--model "$$$$REMODEL_LRI_SFM")
LRI_PLACE := $(if $(filter corners,$(LRI_FRAME)),corners,$(if $(LRI_MODEL),$(or $(filter scene model,$(LRI_FRAME)),photos)))
LRI_MARKS := scenes/$(SCENE)/lri.txt
LRI_PLACE.photos := --views $(O)/views --scene-records $(S)/photos
LRI_PLACE.model := --axes $(O)/model/axes.txt
LRI_PLACE.corners := --marks $(LRI_MARKS) --plan $(O)/model/plan.txt --axes $(O)/model/axes.txt
LRI_NEEDS.photos := $(addprefix $(O)/views/,cameras.txt images.txt points3D.txt lenses.txt)
LRI_NEEDS.model := $(O)/model/axes.txt
LRI_NEEDS.corners := $(LRI_MARKS) $(O)/model/plan.txt $(O)/model/axes.txt
define lri_rule
$(S)/lri/$(1).exr $(S)/lri/$(1).jpg &: $(S)/lri/photos/$(1).txt $(LRI_RESPONSE) $(S)/stamp/lri.txt $(LRI_NEEDS.$(LRI_PLACE)) \
  $(call shared_needs,hdr_merge) | $(if $(BRACKETED),$(RESPONSE_STAMP))
	$$(hide)$$(call farm,hdr_merge,lri.$(1),$(S)/lri/$(1).jpg $(S)/lri/$(1).exr,\
	  --id $(1) --photos $$(LRI_FOLDER) --records $(S)/lri/photos $(LRI_RESPONSE:%=--response %) $(LRI_MODEL) $(LRI_PLACE.$(LRI_PLACE)) --out $(S)/lri,,$(S))
endef
$(foreach p,$(LRI_IDS),$(eval $(call lri_rule,$(p))))

look-lri:
	+@stages/hdr_merge/look.sh $(BIN) $(S)
endif
