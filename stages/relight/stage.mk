# relight: pictures of edited models under the light that the edits make.
FOLLOWS.relight := update_vita render_model fit_materials encode_video plan_tour
READS.relight := what update_vita reads and writes, remodelled pictures, ids and depth of original views, lights/materials.txt
LIBS.relight := -lembree3
STEPS.relight := unlit relight relit-tour-unlit relit-tour-frames relit-tour
NEEDS.relight := textures outdoors relit-vita unlit
RUN.unlit := farm
RUN.relight := farm
RUN.relit-tour-unlit := farm
RUN.relit-tour-frames := farm
NEEDS.relit-tour-unlit := textures outdoors tour-path
NEEDS.relit-tour-frames := relit-vita relit-tour-unlit
NEEDS.relit-tour := relit-tour-frames
HELP.relit-tour := films through the rooms of each edit under the light that it makes
HELP.relight := pictures after each edit under the light that it makes, of the views RELIT_VIEWS; with CAMERAS=DIR: from these cameras
PRODUCT.relight := relight

## RELIT_VIEWS="P Q": for `make relight`: photos, or views of them, to relight; all: every photo (four, spread over the list)

ifdef GRAPH
spread_four = $(shell awk '{ for (i = 0; i < 4 && i < NF; i++) print $$(int(i * NF / (NF < 4 ? NF : 4)) + 1) }' <<<'$(1)')
RELIT_WANTED := $(if $(MODEL_SCRIPT),$(if $(RELIT_VIEWS),$(if $(filter all,$(RELIT_VIEWS)),$(VIEWPOINTS),$(RELIT_VIEWS)),$(call spread_four,$(VIEWPOINTS))))
RELIT_NAMES := $(filter $(RELIT_WANTED) $(RELIT_WANTED:%=%@%),$(VIEWS))
ifneq ($(filter-out $(VIEWPOINTS) $(VIEWS) all,$(RELIT_VIEWS)),)
  $(if $(VIEWS),$(error RELIT_VIEWS=$(RELIT_VIEWS): wanted photos or views of this scene, which are: $(VIEWPOINTS)))
endif
relit_args = $(call change_args,$(1)) --relit $(O)/relight/$(1) $(GIVEN_MATERIALS:%=--materials %) --views $(O)/views
# $(1): an edit; $(2): a photo; $(3): its views
define unlit_rule
$(3:%=$(O)/relight/$(1)/unlit/%.txt) &: $(call model_needs,$(O)/remodel/$(1)) $(O)/vdta/$(2)/atlas.txt $(foreach v,$(3),$(O)/views/$(v).exr \
  $(O)/ids/$(v).exr $(O)/depth/$(v).exr)
	$$(hide)$$(call farm,render_model,unlit-$(1)-$(2),$(3:%=$(O)/relight/$(1)/unlit/%.txt),$(call model_args,$(O)/remodel/$(1)) \
	  $(3:%=--view %) --set radiance=all --out $(O)/relight/$(1)/unlit)
$(3:%=$(O)/relight/$(1)/%.txt) &: $(3:%=$(O)/relight/$(1)/unlit/%.txt) $(O)/relight/$(1)/vita/atlas.txt $(call change_needs,$(1)) $(GIVEN_MATERIALS) \
  $(call needs,relight)
	$$(hide)$$(call farm,relight,$(1)-$(2),$(3:%=$(O)/relight/$(1)/%.txt),$(call relit_args,$(1)) --ids $(O)/ids --depth $(O)/depth \
	  --pictures $(O)/relight/$(1)/unlit $(3:%=--picture %) --out $(O)/relight/$(1))
endef
RELIT_PHOTOS := $(foreach p,$(VIEWPOINTS),$(if $(filter $(p) $(p)@%,$(RELIT_NAMES)),$(p)))
$(foreach e,$(RELIT_EDITS),$(foreach p,$(RELIT_PHOTOS),$(eval $(call unlit_rule,$(e),$(p),$(filter $(p) $(p)@%,$(RELIT_NAMES))))))
RELIT_TXT := $(foreach e,$(RELIT_EDITS),$(RELIT_NAMES:%=$(O)/relight/$(e)/%.txt))
# given cameras: render_model draws them as `make remodel` does
define relit_cameras_rule
$(O)/relight/$(1)/cameras/pictures.txt: $(O)/remodel/$(1)/cameras/pictures.txt $(O)/relight/$(1)/vita/atlas.txt $(call change_needs,$(1)) $(GIVEN_MATERIALS) \
  $(call needs,relight)
	$$(hide)$$(call farm,relight,cameras-$(1),$$@,$(call relit_args,$(1)) --pictures $(O)/remodel/$(1)/cameras --list --out $(O)/relight/$(1)/cameras)
endef
$(if $(GIVEN),$(foreach e,$(RELIT_EDITS),$(eval $(call relit_cameras_rule,$(e)))))
.PHONY: unlit relight
unlit: $(if $(GIVEN),$(RELIT_EDITS:%=$(O)/remodel/%/cameras/pictures.txt),$(foreach e,$(RELIT_EDITS),$(RELIT_NAMES:%=$(O)/relight/$(e)/unlit/%.txt)))
relight: $(if $(GIVEN),$(RELIT_EDITS:%=$(O)/relight/%/cameras/pictures.txt),$(RELIT_TXT))
# films: pictures of the tour's frames, then their light, that of the atlas, then the video
RELIT_TOURS := $(filter $(RELIT_EDITS:%=$(O)/remodel/%/tour),$(TOUR_MODELS:%=%/tour))
relit_tour = $(O)/relight/$(1)/tour
define relit_unlit_rule
$(1:%=%.exr) &: $(call tour_path,$(O)/remodel/$(2)/tour) $(call model_needs,$(O)/remodel/$(2)) $(VDTA_TXT) $(IDS_EXR) $(DEPTH_EXR)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=%.exr) -- $$^); \
	  $$(call farm,render_model,relit-unlit-$(2)-$(notdir $(firstword $(1))),$(1:%=%.exr),$(call model_args,$(O)/remodel/$(2)) \
	  --path $(O)/remodel/$(2)/tour --set radiance=all --out $(call relit_tour,$(2))/unlit --frames,$$$$stale)
endef
define relit_frames_rule
$(1:$(call relit_tour,$(2))/unlit/%=$(call relit_tour,$(2))/frames/%.exr) &: $(1:%=%.exr) $(O)/relight/$(2)/vita/atlas.txt $(call change_needs,$(2)) \
  $(call needs,relight)
	$$(hide)$$(call farm,relight,tour-$(2)-$(notdir $(firstword $(1))),$(1:$(call relit_tour,$(2))/unlit/%=$(call relit_tour,$(2))/frames/%.exr),$(call \
	  relit_args,$(2)) --set light=atlas --frames --pictures $(call relit_tour,$(2))/unlit $(foreach f,$(notdir $(1)),--picture $(f)) --out $(call relit_tour,$(2))/frames)
endef
define relit_video
$(call relit_tour,$(2))/video.mp4: $(1:$(call relit_tour,$(2))/unlit/%=$(call relit_tour,$(2))/frames/%.exr) $(call tour_path,$(O)/remodel/$(2)/tour) $(call needs,encode_video)
	$$(call stage,encode_video,relit-$(2),$(O),--path $(O)/remodel/$(2)/tour --frames $(call relit_tour,$(2))/frames --out $$@)
endef
relit_frames = $(patsubst %.exr,%,$(call tour_frames,$(O)/remodel/$(1)/tour))
relit_names = $(patsubst $(O)/remodel/$(1)/tour/frames/%,$(call relit_tour,$(1))/unlit/%,$(call relit_frames,$(1)))
$(foreach e,$(RELIT_TOURS:$(O)/remodel/%/tour=%),$(eval RELIT_FRAMES_$(e) := $(call relit_names,$(e)))$(call chunks,relit_unlit_rule,$(RELIT_FRAMES_$(e)),$(e))$(call \
  chunks,relit_frames_rule,$(RELIT_FRAMES_$(e)),$(e))$(if $(RELIT_FRAMES_$(e)),$(eval $(call relit_video,$(RELIT_FRAMES_$(e)),$(e)))))
.PHONY: relit-tour relit-tour-unlit relit-tour-frames
relit-tour-unlit: $(foreach e,$(RELIT_TOURS:$(O)/remodel/%/tour=%),$(RELIT_FRAMES_$(e):%=%.exr))
relit-tour-frames: $(foreach e,$(RELIT_TOURS:$(O)/remodel/%/tour=%),$(RELIT_FRAMES_$(e):$(call relit_tour,$(e))/unlit/%=$(call relit_tour,$(e))/frames/%.exr))
relit-tour: $(foreach e,$(RELIT_TOURS:$(O)/remodel/%/tour=%),$(if $(RELIT_FRAMES_$(e)),$(call relit_tour,$(e))/video.mp4))
SHOWN_ALWAYS += $(wildcard $(O)/relight/*/tour/video.mp4)
# plain make shows what there is; with the product it makes it. The pictures are measured where they are shown.
RELIT_MEASURED := $(call $(if $(filter relight,$(PRODUCTS)),made,wildcard),$(RELIT_TXT))
SHOWN_ALWAYS += $(RELIT_MEASURED)
endif
