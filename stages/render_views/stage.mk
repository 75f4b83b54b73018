# render_views: a film's frames, and the cameras of held-out photos.
FOLLOWS.render_views := segment_depth plan_path
READS.render_views := parallax/views.txt, all layers, the path, effects.txt
STEPS.render_views := frames
HELP.frames := + its frames
NEEDS.frames := path

ifdef GRAPH
frame_exr = $(FRAMES_$(1):%=$(P)/$(1)/frames/%.exr)
.PHONY: frames heldout
frames: $(foreach e,$(EFFECTS),$(call frame_exr,$(e)))
# frames come in chunks, a process each; of a chunk only the frames that are missing or stale are rendered. $(1): frames;
# $(2): their film
effect_layers = $(P)/$(1)/effects.txt $(if $(filter $(1),$(FILMS)),,$(wildcard scenes/$(SCENE)/effects.txt))
# a film of keys may go anywhere, so it is rendered from all views
film_views_of = $(if $(filter $(1),$(FILMS)),,$(FILM_VIEWS))
define chunk_rule
$(1:%=$(P)/$(2)/frames/%.exr) &: $(call path_txt,$(2)) $(call effect_layers,$(2)) $(VIEW_CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) \
  $(call film_views_of,$(2)) $(call needs,render_views) | $(if $(filter $(2),$(FILMS)),,$(FILM_VIEWS_STAMP))
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=$(P)/$(2)/frames/%.exr) -- $$^); \
	  $$(call farm,render_views,$(2)-$(firstword $(1)),$(1:%=$(P)/$(2)/frames/%.exr),--views $(O)/views --depth $(O)/depth \
	  --path $(P)/$(2) $(addprefix --film-views ,$(call film_views_of,$(2))) $(addprefix --effects ,$(call effect_layers,$(2))) --out $(P)/$(2)/frames --frames,$$$$stale)
endef
$(foreach e,$(EFFECTS),$(call chunks,chunk_rule,$(FRAMES_$(e)),$(e)))

# the held-out photos' cameras, rendered from the other views
HELD_FRAMES := $(HELD:%=$(H)/frames/%.exr)
heldout: $(HELD_FRAMES)
define heldout_rule
$(1:%=$(H)/frames/%.exr) &: $(HELD_CAMERAS) $(VIEW_CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,render_views)
	$$(hide)$$(call farm,render_views,heldout-$(firstword $(1)),$(1:%=$(H)/frames/%.exr),--views $(O)/views \
	  --depth $(O)/depth --cameras $(H)/views --out $(H)/frames $(1:%=--camera %))
endef
$(call chunks,heldout_rule,$(HELD))
endif
