# suggest_model: a first model script of walls, rooms, doorways and windows.
FOLLOWS.suggest_model := find_axes
READS.suggest_model := cameras, points.ply, axes.txt, all views, interior layers; on request
STEPS.suggest_model := suggest
HELP.suggest := + a first model script from the points, for you to correct: O/model/suggested.txt
NEEDS.suggest := depth

ifdef GRAPH
.PHONY: suggest
suggest: $(O)/model/suggested.txt
$(O)/model/suggested.txt: $(AXES) $(VIEW_CAMERAS) $(VIEW_EXR) $(DEPTH_EXR) $(DEPTH_TXT) $(POINTS) \
  $(call needs,suggest_model)
	$(call stage,suggest_model,all,$(O),--views $(O)/views --depth $(O)/depth --points $(POINTS) --axes $(AXES) \
	  --out $@)
endif
