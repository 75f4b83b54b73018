# trace_ids: the faces of the solid model in each view, where furniture hides them, and what edits reveal.
FOLLOWS.trace_ids := build_model rectify segment_depth
READS.trace_ids := the model, its axes and edits, cameras, one view's depth
HELP.ids := + faces of the solid model in each view, where furniture hides them, and what edits reveal
