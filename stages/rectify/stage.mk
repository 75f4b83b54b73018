# rectify: linear pinhole views, resampled from the photos.
FOLLOWS.rectify := hdr_merge sfm_import
READS.rectify := one photo or hdr/ID.exr, read once, its lens, its mask
STEPS.rectify := views
HELP.views := + rectified, linear views
NEEDS.views := sfm
RUN.views := farm

ifdef GRAPH
VIEW_EXR := $(VIEWS:%=$(O)/views/%.exr)
HELD_EXR := $(HELD:%=$(H)/views/%.exr)
.PHONY: views
views: $(VIEW_EXR) $(HELD_EXR)
# A photo is read once for all of its views that are missing or stale. $(1): a photo; $(2): the folder of the cameras;
# $(3): the photo's views there
define rectify_rule
$(3:%=$(2)/%.exr) &: $(call picture,$(1)) $(addprefix $(2)/,cameras.txt images.txt points3D.txt lenses.txt) \
  $(wildcard $(S)/stamp/mask/$(1).txt) $(call needs,rectify)
	$$(hide)stale=$$$$(common/run/stale.sh views $(3:%=$(2)/%.exr) -- $$^); \
	  $$(call farm,rectify,$(if $(filter $(H)/%,$(2)),heldout-)$(1),$(3:%=$(2)/%.exr),--photo $(1) \
	  --photos $$(PICTURES) $(MASKS) --records $(S)/photos --views $(2) --out $(2),$$$$stale)
endef
rectify_rules = $(foreach p,$(sort $(foreach v,$(1),$(call photo_of,$(v)))),$(eval $(call rectify_rule,$(p),$(2),$(filter $(p) $(p)@%,$(1)))))
$(call rectify_rules,$(VIEWS),$(O)/views)
$(call rectify_rules,$(HELD),$(H)/views)
endif
