# find_axes: an interior's axes, floor, ceiling and scale.
FOLLOWS.find_axes := rectify fuse_points
READS.find_axes := cameras, points.ply, scenes/NAME/scale.txt and axes_fix.txt, a few views
STEPS.find_axes := axes
HELP.axes := + an interior's axes, floor, ceiling and scale, drawn on a few photos
NEEDS.axes := depth

ifdef GRAPH
AXES := $(O)/model/axes.txt
.PHONY: axes
axes: $(AXES)
# a user's marks; a file that came or went is a change whatever the files' times
MARKED := $(wildcard $(addprefix scenes/$(SCENE)/,scale.txt axes_fix.txt))
WAS_MARKED := $(shell sed -nE '/^[^#]/q; s/^. input (scale.txt|axes_fix.txt) .*/\1/p' $(AXES) 2>/dev/null)
$(AXES): $(VIEW_CAMERAS) $(O)/views/lenses.txt $(VIEW_EXR) $(POINTS) $(MARKED) $(S)/photos/list.txt $(call needs,find_axes) \
  $(if $(filter-out $(notdir $(MARKED)),$(WAS_MARKED))$(filter-out $(WAS_MARKED),$(notdir $(MARKED))),FORCE)
	$(call stage,find_axes,all,$(O),--views $(O)/views --records $(S)/photos --points $(POINTS) \
	  $(if $(filter %/scale.txt,$(MARKED)),--scale scenes/$(SCENE)/scale.txt) \
	  $(if $(filter %/axes_fix.txt,$(MARKED)),--fix scenes/$(SCENE)/axes_fix.txt) --out $@)
SHOWN += $(wildcard $(AXES))
endif
