# fuse_points: oriented points on which the depth maps of several views agree.
FOLLOWS.fuse_points := segment_depth
READS.fuse_points := cameras, all interior layers
STEPS.fuse_points := points
HELP.points := + oriented points on which the depth maps agree (for any viewer, and for axes and model)
NEEDS.points := depth

ifdef GRAPH
POINTS := $(O)/points/points.ply
.PHONY: points
points: $(POINTS)
$(POINTS): $(VIEW_CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,fuse_points)
	$(call stage,fuse_points,all,$(O),--views $(O)/views --depth $(O)/depth --out $@)
endif
