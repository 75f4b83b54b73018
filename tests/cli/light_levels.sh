# light_levels: rooms, places and states of a synthetic room; an edit beside it; a year; threads; errors; make lux
. tests/lib.sh
project light_levels
photos set --size 128x96 >/dev/null
boxed t textures
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
printf '[bake_outdoors]\nheight = 64\nedge = 1\nmax_clutter = 1\n[light_levels]\npatches = 300\nrays = 64\npoint_rays = 64\nspacing = 4\nmargin = 2\n' >>scenes/t/scene.cfg
printf 'remodel-script 1\n# A dark floor.\npaint floor/hall 0.05 0.05 0.05\n' >scenes/t/edits/dark.txt
printf 'remodel-places 1\nplace desk at 0 8 size 2 1\n' >scenes/t/places.txt
printf 'remodel-states 1\nsite 52.5 13.4 1\nstate noon lamps off sky clear 6 21 12\n' >scenes/t/states.txt
m lux EDIT=dark
O=out/t
inputs=(--config scenes/t/scene.cfg --model "$O/model/model.txt" --plan "$O/model/plan.txt" --axes "$O/model/axes.txt" --vita "$O/vita" --outdoors "$O/outdoors/outdoors.exr")

# levels CODE WORD ARGUMENT...: runs light_levels; checks its exit status and a word on standard error
levels()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/light_levels" "${inputs[@]}" "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'light_levels: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(find made -type f)" ] || fail "$*: a product was left"
}
# cell FILE STATE KIND PLACE COLUMN: a number of a sheet
cell() { awk -F '\t' -v s="$2" -v k="$3" -v p="$4" -v c="$5" '$1 == s && $2 == k && $3 == p { print $c }' "$1"; }

make_lux_has_a_sheet_of_the_room_and_of_the_edit()
{
    local s=$O/lux/sheet.tsv e=$O/lux/dark/sheet.tsv
    for f in "$s" "$e" $O/lux/levels.txt $O/lux/levels.exr $O/lux/noon.svg $O/lux/quantities.csv $O/lux/openings.csv; do
        "$B/bin/verify" --file "$f" || fail "$f is not whole"
    done
    grep -qx 'face,kind,area,reflectance' $O/lux/quantities.csv && grep -qx 'name,kind,of,width,height,sill,area,state' $O/lux/openings.csv ||
        fail "a room without a scale has metres"
    ! grep -qE 'nan|inf' "$s" "$e" || fail "a number is none"
    for f in "$s" "$e"; do
        awk -F '\t' '/^#/ { next } !n { n = NF; next } NF != n || seen[$1 $2 $3]++ { print; bad = 1 } END { exit bad }' "$f" || fail "$f has a row twice, or of another length than its head"
    done
    [ -n "$(cell "$s" photographed place desk 5)" ] || { cat "$s"; fail "the desk has no light"; }
    [ "$(cell "$s" noon place desk 11)" = lx ] && [ "$(cell "$s" photographed place desk 11)" = relative ] || fail "units are wrong"
    # a dark floor takes light away: the last column is the mean minus that before
    awk -F '\t' '$1 == "photographed" && $2 == "work-plane" { n++; if (!($13 < 0 && $5 - $12 - $13 < 1e-3 * $12 + 1e-6)) bad = 1 } END { exit !n || bad }' "$e" ||
        { cat "$e"; fail "a dark floor takes no light away"; }
    m lux EDIT=dark
    ! grep -q light_levels log || { cat log; fail "a second make made it again"; }
}

lamps_add_up_and_bytes_do_not_depend_on_threads()
{
    printf 'remodel-lights 1\ndisk one 0 5 8 0 0 -1 1 50 50 50 90 0\ndisk two 3 8 8 0 0 -1 1 20 20 20 90 0\n' >lamps.txt
    printf 'remodel-states 1\nstate one lamp two 0\nstate two lamp one 0\nstate both\nstate rest lamp one 0 lamp two 0\nstate more lamp one 2 lamp two 0\n' >both.txt
    for n in 1 2; do levels 0 patches --lights lamps.txt --states both.txt --out two/$n --threads $n; done
    diff -r two/1 two/2
    ! grep -rqF "$PWD" two/1 || fail "a product names a folder of this machine"
    awk -F '\t' '$2 == "work-plane" { v[$1] = $5 } END { r = v["rest"]; exit !(v["one"] > 0 && v["two"] > 0 &&
        (v["one"] + v["two"] - v["both"] - r) ^ 2 < (0.002 * v["both"]) ^ 2 && (v["more"] - 2 * v["one"] + r) ^ 2 < (0.002 * v["more"]) ^ 2) }' two/1/sheet.tsv ||
        { grep work-plane two/1/sheet.tsv; fail "lamps do not add up"; }
}

a_year_of_weather_has_its_figures()
{
    {
        printf 'LOCATION,Test,-,DEU,made,0,52.47,13.40,1.0,49.0\nDESIGN CONDITIONS,0\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n'
        for h in 9 10 11 12 13 14 15; do echo "1987,6,21,$h,60,C9,5,8,90,100000,0,0,300,0,700,120,0,0,0,0,180,2"; done
    } >year.epw
    levels 0 '7 of the 3650 hours' --weather year.epw --out two/year
    for k in short supplementary autonomous exceeds; do cell two/year/sheet.tsv year-udi-$k work-plane "$(awk -F '\t' '$2 == "work-plane" { print $3; exit }' two/year/sheet.tsv)" 5; done |
        awk '{ s += $1 } END { exit !((s - 100) ^ 2 < 0.01) }' || { grep year two/year/sheet.tsv; fail "useful daylight does not sum to 100 %"; }
}

errors_name_file_and_line()
{
    printf 'remodel-places 1\nplace desk at 0\n' >bad.txt
    levels 1 'bad.txt:2' --places bad.txt --out made
    printf 'remodel-places 1\nplace desk at 0 8\nplace desk at 0 9\n' >bad.txt
    levels 1 'bad.txt:3: found "desk"' --places bad.txt --out made
    printf 'remodel-places 1\nplace far at 0 8 height -1\n' >bad.txt
    levels 1 'bad.txt:2' --places bad.txt --out made
    printf 'remodel-states 1\nstate noon sky clear 6 21 12\n' >bad.txt
    levels 1 'site LATITUDE LONGITUDE ZONE' --states bad.txt --out made
    printf 'remodel-states 1\nsite 52 13 1\nstate noon sky clear 2 30 12\n' >bad.txt
    levels 1 'a day that this month has' --states bad.txt --out made
    printf 'remodel-states 1\nstate odd lamp none-such 2\n' >bad.txt
    levels 1 'bad.txt:2: found the lamp none-such' --states bad.txt --out made
    printf 'remodel-states 1\nstate lamps\n' >bad.txt
    levels 1 'a name that no other state has' --states bad.txt --out made
    printf 'no weather\n' >bad.epw
    levels 1 'bad.epw:1' --weather bad.epw --out made
    levels 2 '--edited needs --map' --edited $O/model/model.txt --out made
}

for t in make_lux_has_a_sheet_of_the_room_and_of_the_edit lamps_add_up_and_bytes_do_not_depend_on_threads a_year_of_weather_has_its_figures errors_name_file_and_line; do run "$t"; done
