# run.sh - ids and what edits reveal are made view by view, the index of faces from all of them. Sourced by
# common/run/run_scene.sh.

run_ids()
{
    farm trace_ids ids-views
    farm trace_ids ids-reveal
    one ids
}
