# run.sh - marked materials. Sourced by common/run/run_scene.sh.

run_materials()
{
    if [ -e "$folder/materials.txt" ] && [ -e "$folder/model.txt" ]; then one materials; else
        echo "There is no $folder/materials.txt or no model: nothing is marked whose material could be fitted."
    fi
}
