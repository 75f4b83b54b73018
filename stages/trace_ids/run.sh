# run.sh - ids and what edits reveal are made view by view, the index of faces from all of them; what they will take. Sourced
# by common/run/run_scene.sh.

# of commands, one a line, the views of those that trace
estimate_trace_ids()
{
    local commands=$work/trace.commands edits
    cat >"$commands"
    sed -nE 's/.* --reveal .*--view ([^ ]+) .*/\1 reveal/p; t; s/.* --view ([^ ]+) .*/\1 ids/p' "$commands" >"$work/traced.list"
    edits=$(grep -oE -- '--edit [^ ]+' "$commands" | sort -u || true)
    # shellcheck disable=SC2086 # a list of options
    "$bin/trace_ids" --config "$O/slice/trace_ids.cfg" --views "$O/views" --model "$O/model/model.txt" --axes "$O/model/axes.txt" \
        --out "$O/ids" --estimate "$work/traced.list" $edits
}

run_ids()
{
    farm trace_ids ids-views
    farm trace_ids ids-reveal
    one ids
}
