# render_model: the model and its edits under photographic texture, from the photos' views, from given cameras, and as films.
FOLLOWS.render_model := bake_outdoors bake_vdta bake_vita encode_video plan_tour
READS.render_model := the models, texture.txt, atlases, outdoors.exr, the views with their ids and depth, the tour or the cameras
LIBS.render_model := -lembree3
VARIABLES.render_model := CAMERAS CAMERAS_FRAME
STEPS.render_model := remodel tour
HELP.remodel := what the photos would show after each edit, EDIT=E: after one; with CAMERAS=DIR: from these cameras
NEEDS.remodel := textures outdoors
RUN.remodel := farm
PRODUCT.remodel := remodel
PRODUCT.tour := tour
HELP.tour := films through the rooms, of the model and of each edit
NEEDS.tour := textures outdoors tour-path

## EDIT=E: for `make remodel`, `tour` and `relight`: after this edit alone
## DRAW="E F": edits that these goals and plain `make` draw, usually in scene.mk (all)
## CAMERAS=DIR: a COLMAP text model whose cameras `make remodel` draws the model and its edits from
## CAMERAS_FRAME=scene|model|truth: its frame: O/views (default), the room's model, or TRUTH, which has the photos' cameras

ifdef GRAPH
# the frame of a model's folder $(1), what its pictures are drawn from, and what they depend on
edited = $(filter $(O)/remodel/%,$(1))
model_args = --model $(1)/model.txt $(if $(edited),--base $(O)/model/model.txt --map $(1)/texture.txt) --axes $(AXES) --views $(O)/views \
  --vdta $(O)/vdta --vita $(O)/vita --ids $(O)/ids --depth $(O)/depth --outdoors $(OUTDOORS)
model_needs = $(1)/model.txt $(if $(edited),$(1)/texture.txt) $(O)/model/model.txt $(AXES) $(VIEW_CAMERAS) $(O)/views/lenses.txt $(VITA_TXT) $(OUTDOORS) \
  $(call needs,render_model)
GIVEN := $(if $(value REMODEL_CAMERAS),yes)
.PHONY: remodel remodel-views remodel-cameras tour tour-frames
remodel: $(if $(GIVEN),remodel-cameras,remodel-views)

# $(1): an edit; $(2): a photo; $(3): its views
define picture_rule
$(3:%=$(O)/remodel/$(1)/pictures/%.txt) &: $(call model_needs,$(O)/remodel/$(1)) $(O)/vdta/$(2)/atlas.txt $(foreach v,$(3),$(O)/views/$(v).exr \
  $(O)/ids/$(v).exr $(O)/depth/$(v).exr)
	$$(hide)$$(call farm,render_model,$(1)-$(2),$(3:%=$(O)/remodel/$(1)/pictures/%.txt),$(call model_args,$(O)/remodel/$(1)) \
	  $(3:%=--view %) --out $(O)/remodel/$(1)/pictures)
endef
$(foreach e,$(DRAWN_EDITS),$(foreach p,$(VIEWPOINTS),$(eval $(call picture_rule,$(e),$(p),$(filter $(p) $(p)@%,$(VIEWS))))))
PICTURES_TXT := $(foreach e,$(DRAWN_EDITS),$(VIEWS:%=$(O)/remodel/$(e)/pictures/%.txt))
remodel-views: $(PICTURES_TXT)

# given cameras may see any room: which views and atlases they use is known when they have been drawn
CAMERA_ARGS = --cameras "$$REMODEL_CAMERAS" $(if $(filter truth,$(CAMERAS_FRAME)),--frame-of "$$REMODEL_TRUTH" --records $(S)/photos,$(if \
  $(CAMERAS_FRAME),--frame $(CAMERAS_FRAME)))
define cameras_rule
$(1)/cameras/pictures.txt: $(call model_needs,$(1)) $(VDTA_TXT) $(VIEW_EXR) $(IDS_EXR) $(DEPTH_EXR) $(S)/photos/list.txt $(O)/stamp/cameras.txt
	$$(hide)$$(call farm,render_model,cameras-$(notdir $(1)),$$@,$(call model_args,$(1)) $$(CAMERA_ARGS) --out $(1)/cameras)
endef
DRAWN_MODELS := $(if $(EDIT)$(DRAW),,$(O)/model) $(DRAWN_EDITS:%=$(O)/remodel/%)
$(if $(MODELS),$(foreach m,$(DRAWN_MODELS),$(eval $(call cameras_rule,$(m)))))
remodel-cameras: $(if $(MODELS),$(DRAWN_MODELS:%=%/cameras/pictures.txt))
look::
	+@stages/render_model/look.sh $(O)/stamp/cameras.txt

# films: their frames are known when the tours have been planned
TOURS := $(filter $(DRAWN_MODELS:%=%/tour),$(TOUR_MODELS:%=%/tour))
tour_frames = $(shell sed -nE 's|^frame ([0-9]+) .*|$(1)/frames/\1.exr|p' $(1)/path.txt 2>/dev/null)
tour_path = $(addprefix $(1)/,path.txt pairs.txt path/cameras.txt path/images.txt)
# $(1): frames; $(2): their tour
define tour_rule
$(1) &: $(call tour_path,$(2)) $(call model_needs,$(2:%/tour=%)) $(VDTA_TXT) $(IDS_EXR) $(DEPTH_EXR)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1) -- $$^); \
	  $$(call farm,render_model,tour-$(notdir $(2:%/tour=%))-$(basename $(notdir $(firstword $(1)))),$(1),$(call model_args,$(2:%/tour=%)) \
	  --path $(2) --out $(2)/frames --frames,$$$$stale)
endef
define tour_video
$(2)/video.mp4: $(1) $(call tour_path,$(2)) $(call needs,encode_video)
	$$(call stage,encode_video,tour-$(notdir $(2:%/tour=%)),$(O),--path $(2) --frames $(2)/frames --out $$@)
endef
$(foreach t,$(TOURS),$(eval FRAMES_OF_$(t) := $(call tour_frames,$(t)))$(call chunks,tour_rule,$(FRAMES_OF_$(t)),$(t))$(eval $(call \
  tour_video,$(FRAMES_OF_$(t)),$(t))))
tour-frames: $(foreach t,$(TOURS),$(FRAMES_OF_$(t)))
tour: $(TOURS:%=%/video.mp4)
SHOWN_ALWAYS += $(call $(if $(filter remodel,$(PRODUCTS)),made,wildcard),$(PICTURES_TXT)) $(wildcard $(TOURS:%=%/video.mp4))
endif
