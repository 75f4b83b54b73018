# encode_video: videos from frames.
FOLLOWS.encode_video := morph_views pan_scan render_views
READS.encode_video := frames (runs ffmpeg)
STEPS.encode_video := video
HELP.video := + the video
NEEDS.video = $(if $(PAIR),morph,frames)
PRODUCT.parallax := video

ifdef GRAPH
.PHONY: video
video: $(if $(PAIR),$(M)/video.mp4,$(EFFECTS:%=$(P)/%/video.mp4))
define video_rules
$(P)/$(1)/video.mp4: $(call frame_exr,$(1)) $(call path_txt,$(1)) $(call needs,encode_video)
	$$(call stage,encode_video,$(1),$(O),--path $(P)/$(1) --frames $(P)/$(1)/frames --out $$@)
$(P)/$(1)/pan_scan/video.mp4: $(call pan_exr,$(1)) $(call path_txt,$(1)) $(call needs,encode_video)
	$$(call stage,encode_video,$(1)-pan_scan,$(O),--path $(P)/$(1) --frames $(P)/$(1)/pan_scan/frames --out $$@)
endef
$(foreach e,$(EFFECTS),$(eval $(call video_rules,$(e))))
$(M)/video.mp4: $(MORPH_EXR) $(MORPH_TXT) $(call needs,encode_video)
	$(call stage,encode_video,morph,$(O),--path $(M) --frames $(M)/frames --out $@)
SHOWN += $(EFFECTS:%=$(P)/%/video.mp4)
endif
