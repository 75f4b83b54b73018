# run.sh - the film between two photos. Sourced by common/run/run_scene.sh.

run_morph()
{
    local id
    print_graph write # the photos are known only now
    [ -e "$O/stamp/morph.txt" ] ||
        usage "make morph goes from one photo to another: make morph $again MORPH=\"A B\", with ids that $S/photos/list.txt lists."
    for id in $(<"$O/stamp/morph.txt"); do
        [ -e "$S/photos/$id.txt" ] || usage "MORPH: there is no photo $id; $S/photos/list.txt lists them."
    done
    one morph-path
    farm morph_views morph-frames "$cores" 1
    one morph
}
