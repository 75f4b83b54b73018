# pan_scan: the same move in 2D, crops of one photograph.
FOLLOWS.pan_scan := segment_depth plan_path
READS.pan_scan := one view, its layers, the path; on request
STEPS.pan_scan := pan_scan
HELP.pan_scan := the same move in 2D, crops of one photograph, to compare; from then on the page shows it too
NEEDS.pan_scan := path

ifdef GRAPH
pan_exr = $(FRAMES_$(1):%=$(P)/$(1)/pan_scan/frames/%.exr)
.PHONY: pan_frames pan_scan
pan_frames: $(foreach e,$(EFFECTS),$(call pan_exr,$(e)))
pan_scan: $(EFFECTS:%=$(P)/%/pan_scan/video.mp4)
# which view it shows depends on the path
define pan_rule
$(1:%=$(P)/$(2)/pan_scan/frames/%.exr) &: $(call path_txt,$(2)) $(VIEW_CAMERAS) $(VIEW_EXR) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,pan_scan)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=$(P)/$(2)/pan_scan/frames/%.exr) -- $$^); \
	  $$(call farm,pan_scan,$(2)-$(firstword $(1)),$(1:%=$(P)/$(2)/pan_scan/frames/%.exr),--views $(O)/views \
	  --depth $(O)/depth --path $(P)/$(2) --out $(P)/$(2)/pan_scan/frames --frames,$$$$stale)
endef
$(foreach e,$(EFFECTS),$(call chunks,pan_rule,$(FRAMES_$(e)),$(e)))
SHOWN += $(wildcard $(EFFECTS:%=$(P)/%/pan_scan/video.mp4))
endif
