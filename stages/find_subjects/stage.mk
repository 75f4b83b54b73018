# find_subjects: what a move can show: faces, or rectangles that a user draws.
FOLLOWS.find_subjects := segment_depth
READS.find_subjects := cameras, the most central views and those that confirm what they show, their layers; or scenes/NAME/subjects.txt
WRITES.find_subjects := parallax/subjects.txt
LIBS.find_subjects := -lopencv_objdetect -lopencv_imgproc -lopencv_core
STEPS.find_subjects := subjects
HELP.subjects := + faces, or the rectangles of scenes/SCENE/subjects.txt
NEEDS.subjects := depth

ifdef GRAPH
P := $(O)/parallax
SUBJECTS := $(P)/subjects.txt
.PHONY: subjects
subjects: $(SUBJECTS)
# rectangles that a user drew, in place of faces; a file that came or went is a change whatever its time
DRAWN := $(wildcard scenes/$(SCENE)/subjects.txt)
WERE_DRAWN := $(shell grep -om1 '^. input subjects.txt' $(SUBJECTS) 2>/dev/null)
$(SUBJECTS): $(CAMERAS) $(O)/views/lenses.txt $(if $(DRAWN),$(DRAWN),$(VIEW_EXR)) $(DEPTH_EXR) $(DEPTH_TXT) \
  $(call needs,find_subjects) $(if $(DRAWN),$(if $(WERE_DRAWN),,FORCE),$(if $(WERE_DRAWN),FORCE))
	$(call stage,find_subjects,all,$(O),--views $(O)/views --depth $(O)/depth --records $(S)/photos \
	  $(DRAWN:%=--subjects %) --out $@)
endif
