# find_subjects: what a move can show: faces, or rectangles that a user draws.
FOLLOWS.find_subjects := segment_depth choose_views
READS.find_subjects := parallax/views.txt, cameras, the most central views and those that confirm what they show, their layers; or scenes/NAME/subjects.txt
LIBS.find_subjects := -lopencv_objdetect -lopencv_imgproc -lopencv_core
STEPS.find_subjects := subjects
HELP.subjects := + faces, or the rectangles of scenes/SCENE/subjects.txt
NEEDS.subjects := depth film_views

ifdef GRAPH
SUBJECTS := $(P)/subjects.txt
.PHONY: subjects
subjects: $(SUBJECTS)
# rectangles that a user drew (DRAWN) are in place of faces; a file that came or went is a change whatever its time
WERE_DRAWN := $(shell grep -om1 '^. input subjects.txt' $(SUBJECTS) 2>/dev/null)
$(SUBJECTS): $(VIEW_CAMERAS) $(O)/views/lenses.txt $(if $(DRAWN),$(DRAWN),$(VIEW_EXR)) $(DEPTH_EXR) $(DEPTH_TXT) \
  $(FILM_VIEWS) $(call needs,find_subjects) $(if $(DRAWN),$(if $(WERE_DRAWN),,FORCE),$(if $(WERE_DRAWN),FORCE)) | $(FILM_VIEWS_STAMP)
	$(call stage,find_subjects,all,$(O),--views $(O)/views --depth $(O)/depth --records $(S)/photos --film-views $(FILM_VIEWS) \
	  $(DRAWN:%=--subjects %) --out $@)
endif
