# plan_path's files for other programs: valid, and made again if missing
. tests/lib.sh
project export
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/; s/^seconds = .*/seconds = 0.25/; s/^max_side = .*/max_side = 96/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t path >log 2>&1 || { cat log; fail "make"; }
move=out/t/parallax/establishing_dolly

python_parses_both_files()
{
    command -v python3 >/dev/null || skip "python3 is not installed"
    n=$(awk '$1 == "frames" { print $2 }' $move/path.txt)
    m=$(python3 -c 'import json, sys; r = json.load(open(sys.argv[1])); print(len(r["frames"]), r["frames"][0]["file_path"])' $move/transforms.json)
    [ "$m" = "$n frames/0001.exr" ] || fail "transforms.json: $m, wanted $n"
    python3 -c 'import ast, sys; ast.parse(open(sys.argv[1], encoding="utf-8").read())' $move/blender.py || fail "blender.py is not valid Python"
}

a_missing_file_is_made_again()
{
    for f in transforms.json blender.py; do
        sum=$(sha256sum <$move/$f)
        rm $move/$f
        make -s DEPS=manual SCENE=t path >log 2>&1 || { cat log; fail "make"; }
        [ "$(sha256sum <$move/$f)" = "$sum" ] || fail "$f differs"
    done
}

for t in python_parses_both_files a_missing_file_is_made_again; do run "$t"; done
