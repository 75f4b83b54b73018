# light_levels: rooms, places and states of a synthetic room; an edit beside it; a year; threads; errors; make lux
. tests/lib.sh
project light_levels
photos set --size 128x96 >/dev/null
boxed t textures
printf 'window pane on east from -5 5 to 5 12\n' >>scenes/t/model.txt
sed -i 's/^set slab 1$/set slab 1\nset glass 0.1/' scenes/t/model.txt
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
printf '[bake_outdoors]\nheight = 64\nedge = 1\nmax_clutter = 1\n[light_levels]\npatches = 300\nrays = 64\npoint_rays = 64\nspacing = 0.5\nmargin = 0.25\n' >>scenes/t/scene.cfg
printf 'remodel-script 1\n# A dark floor, and a lamp.\npaint floor/hall 0.05 0.05 0.05\nlamp hung ies new.ies at 0 8 16 colour 1 0.9 0.8\n' >scenes/t/edits/dark.txt
printf 'remodel-places 1\nplace desk at 0 8 size 2 1\n' >scenes/t/places.txt
ies='IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n1000 1000\n'
printf '%b' "$ies" >scenes/t/new.ies
printf 'remodel-states 1\nsite 52.5 13.4 1\nlamp new ies new.ies at 0 8 18\nstate noon lamps off sky clear 6 21 12\nstate planned lamps off lamp new 1\n' >scenes/t/states.txt
m lux EDIT=dark LUX_PHOTOS='photo_1 photo_2'
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
    for f in "$s" "$e" $O/lux/levels.txt $O/lux/levels.exr $O/lux/relit.js $O/lux/noon.svg $O/lux/quantities.csv $O/lux/openings.csv; do
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
    # the edit's lamp shines in a state of its own, which the unedited room lacks
    [ "$(cell "$e" edit-lamps place desk 11)" = lx ] && awk -v v="$(cell "$e" edit-lamps place desk 5)" 'BEGIN { exit !(v > 10) }' || { grep desk "$e"; fail "the edit's lamp does not shine"; }
    grep -q '^group [0-9]* planned hung$' $O/lux/dark/levels.txt && ! grep -q hung $O/lux/levels.txt || fail "the edit's lamp is in the wrong room"
    m lux EDIT=dark LUX_PHOTOS='photo_1 photo_2'
    ! grep -q light_levels log || { cat log; fail "a second make made it again"; }
    # an IES file is read again when it changes
    was=$(cell "$s" planned place desk 5)
    sed -i 's/^1000 1000$/2000 2000/' scenes/t/new.ies
    m lux LUX_PHOTOS='photo_1 photo_2'
    awk -v a="$was" -v b="$(cell "$s" planned place desk 5)" 'BEGIN { exit !(a > 0 && (b - 2 * a) ^ 2 < (0.01 * a) ^ 2) }' || { grep ^planned "$s"; fail "a changed IES file was not read"; }
}

# a metre is a guess by the rooms' height: the work plane of a sheet is 0.75 of it up, and its interval is wide
a_room_without_a_scale_has_a_guessed_metre()
{
    local s=$O/lux/sheet.tsv
    grep -q '^# no scale is known: a metre is a guess, ' "$s" || { head -40 "$s"; fail "the sheet hides the guess"; }
    levels 0 'the scene has no scale, so that a metre is a guess: ' --out two/guess
    local metre; metre=$(sed -n 's/.*a metre is a guess: \([0-9.]*\) units.*/\1/p' err.txt)
    awk -v m="$metre" 'BEGIN { n = 0 } $1 == "area" { kind[$3] = $2 } $1 == "point" { if (n in kind) k = kind[n]; z[k] = $4; n++ }
        END { exit !((z["work-plane"] - z["floor"] - 0.74 * m) ^ 2 < (0.01 * m) ^ 2 && z["work-plane-high"] > z["work-plane"]) }' two/guess/levels.txt ||
        { cat err.txt; grep area two/guess/levels.txt; fail "the work plane is not 0.75 m up"; }
    levels 0 'by rooms 5 m high' --set room_height=5 --out two/guess5
}

# in walls alone, as `make suggest` may leave them, the sky would shine in unnoticed
a_model_without_rooms_is_warned_of()
{
    grep -v '^room ' "$O/model/plan.txt" >bare.txt
    local inputs=("${inputs[@]/$O\/model\/plan.txt/bare.txt}")
    levels 0 'the model has no room, ' --out two/bare
    ! grep -q '^daylight-factor' two/bare/sheet.tsv && [ ! -e two/bare/daylight-factor.svg ] || fail "daylight factors of nothing"
}

# E = I / r^2 below a planned lamp in a black room would be 444 lx; reflected light adds to it; a factor multiplies it
planned_lamps_shine_in_the_states_that_name_them()
{
    local metre=8 # of 20 units a room
    printf '%b' "$ies" >lamp.ies
    awk -v m="$metre" 'BEGIN { printf "remodel-places 1\nplace below at 0 8 height %.9g\n", 0.75 * m }' >below.txt
    awk -v m="$metre" 'BEGIN { printf "remodel-states 1\nlamp new ies lamp.ies at 0 8 %.9g\nstate new lamps off lamp new 1\nstate half lamps off lamp new 0.5\nstate without lamps off\nstate mixed lamp new 1\n", 2.25 * m > "planned.txt" }'
    levels 0 'the state mixed has lamps of the photographs' --states planned.txt --places below.txt --out two/planned
    local s=two/planned/sheet.tsv
    [ "$(cell $s new place below 11)" = lx ] && grep -q '^group [0-9]* planned new$' two/planned/levels.txt || { cat $s; fail "no lx"; }
    awk -v a="$(cell $s new place below 5)" -v b="$(cell $s half place below 5)" 'BEGIN { exit !(a > 440 && a < 1500 && (a - 2 * b) ^ 2 < (0.01 * a) ^ 2) }' ||
        { grep below $s; fail "a planned lamp of 1000 cd does not give 444 lx and more, 1.5 m below"; }
    [ -z "$(cell $s mixed place below 5)" ] && [ "$(cell $s without place below 5)" = 0 ] || { grep below $s; fail "other states"; }
    # the light of given points is that of the sheet's points
    printf '0 0 0 0 0 1\n1 2 3 0 1 0\n' >given.txt
    levels 0 'used' --states planned.txt --points given.txt --table --out made
    awk 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i - 1; next } { n++; if ($c["mixed"] != "-" || NF != 14 || ($c["new"] - 2 * $c["half"]) ^ 2 > 1e-6 * $c["new"] ^ 2) bad = 1 } END { exit !(n == 2 && !bad) }' out.txt ||
        { cat out.txt; fail "the table is wrong"; }
    printf 'remodel-states 1\nlamp far ies lamp.ies at 0 0 500\n' >bad.txt
    levels 1 'bad.txt:2: the lamp far at 0 0 500 lies inside of a wall or outdoors' --states bad.txt --out made
    printf 'remodel-states 1\nlamp new ies none.ies at 0 0 1\n' >bad.txt
    levels 1 'none.ies' --states bad.txt --out made
    printf 'remodel-lights 1\ndisk new 0 5 8 0 0 -1 1 50 50 50 90 0\n' >same.txt
    levels 1 'has a lamp of that name' --lights same.txt --states planned.txt --out made
}

photographs_show_light_levels_with_a_key()
{
    local id=photo_1 f
    for f in $O/lux/{photographed,overcast,daylight-factor,noon}."$id".svg $O/lux/dark/photographed."$id".svg; do
        "$B/bin/verify" --file "$f" || fail "$f is not whole"
        grep -q 'class="key"' "$f" && grep -q 'data:image/jpeg;base64,' "$f" || fail "$f has no key or photograph"
    done
    # one palette: the keys of the plan and of a photograph have the same colours
    for f in photographed photographed."$id"; do grep -o 'fill="#[0-9a-f]*"/>$' "$O/lux/$f.svg" | tail -60 >"$f.key"; done
    cmp photographed.key photographed."$id".key || fail "plan and photograph have different keys"
    levels 1 'none-such' --views $O/views --photo none-such --out made
}

# a photo in its own light, a lamp that is off, an hour of the page, and states that nothing is known of
a_command_line_draws_photographs_in_any_state()
{
    levels 0 'exposed 1 times as the photograph' --from $O/lux --photo photo_1 --state photographed --exposure 1 --out two/own.png
    levels 0 'exposed' --from $O/lux --photo photo_1 --state noon --states scenes/t/states.txt --out two/noon.png
    levels 0 'exposed' --from $O/lux --photo photo_1 --state 'lamps off sky clear 6 21 12' --out two/same.png
    cmp two/noon.png two/same.png || fail "a name and its words differ"
    levels 0 'exposed' --from $O/lux/dark --photo photo_2 --state 'lamps off lamp new 1 blind pane 0.5' --out two/new.png
    levels 1 'no sky of 6 21, 12.25' --from $O/lux --photo photo_1 --state 'lamps off sky clear 6 21 12.25' --out made/x.png
    levels 1 'the lamp none-such' --from $O/lux --photo photo_1 --state 'lamp none-such 1' --out made/x.png
    levels 1 'the window none-such' --from $O/lux --photo photo_1 --state 'blind none-such 1' --out made/x.png
    levels 1 '--state:1: found "brightly"' --from $O/lux --photo photo_1 --state 'lamps brightly' --out made/x.png
    levels 1 'their sum needs lux/scale.txt' --from $O/lux --photo photo_1 --state 'sky overcast 10000' --out made/x.png
    levels 1 'found none of that name among the light levels; they have photo_1, photo_2' --from $O/lux --photo none-such --state lamps --out made/x.png
    levels 2 'needs --state and one --photo' --from $O/lux --state lamps --out made/x.png
    levels 2 'go with --from' --state lamps --out made/x.png
    levels 2 '--exposure -1' --from $O/lux --photo photo_1 --state lamps --exposure -1 --out made/x.png
}

# blinds take light of the window alone; another window's name is refused
blinds_take_their_part_of_daylight()
{
    printf 'remodel-states 1\nsite 52.5 13.4 1\nstate open lamps off sky overcast 10000\nstate half lamps off sky overcast 10000 blind pane 0.5\nstate shut lamps off sky overcast 10000 blind pane 0\n' >blinds.txt
    levels 0 patches --states blinds.txt --out two/blinds
    awk -F '\t' '$2 == "place" || $2 == "work-plane" { v[$1] = $5 } END { exit !(v["open"] > 0 && v["shut"] < v["half"] &&
        (v["open"] + v["shut"] - 2 * v["half"]) ^ 2 < (1e-3 * v["open"]) ^ 2) }' two/blinds/sheet.tsv || { grep work-plane two/blinds/sheet.tsv; fail "blinds are wrong"; }
    printf 'remodel-states 1\nstate odd blind none-such 0.5\n' >bad.txt
    levels 1 'bad.txt:2: found a blind of the window none-such' --states bad.txt --out made
    printf 'remodel-states 1\nstate odd blind pane 1.5\n' >bad.txt
    levels 1 'bad.txt:2' --states bad.txt --out made
}

# a lux-meter showed half of what one lamp and twice of what the other gives by the scale, at places that each lights
measurements_in_states_say_how_bright_lamps_are()
{
    printf 'remodel-lights 1\ndisk one -5 5 8 0 0 -1 1 50 50 50 90 0\ndisk two 5 12 8 0 0 -1 1 50 50 50 90 0\n' >lamps.txt
    printf 'remodel-places 1\nplace west at -5 5 height 4\nplace east at 5 12 height 4\n' >two.txt
    printf 'remodel-lux-scale 1\nscale 10\ninterval 9 11\nfrom exposure\nexposure 1 10 9 11\n' >scale.txt
    printf 'remodel-states 1\nstate one lamps off lamp one 1\nstate two lamps off lamp two 1\n' >before.txt
    levels 0 patches --lights lamps.txt --places two.txt --scale scale.txt --states before.txt --set error=0.02 --out two/fit0
    local s=two/fit0/sheet.tsv; grep -qx 'scale 0 0 0' two/fit0/factors.txt || { cat two/fit0/factors.txt; fail "factors of nothing"; }
    { cat before.txt; awk -v a="$(cell $s one place west 5)" -v b="$(cell $s two place east 5)" 'BEGIN { printf "measured %.9g at west in one within 1\nmeasured %.9g at east in two within 1\n", a / 2, 2 * b }'; } >after.txt
    levels 0 'lamp one: 0.5' --lights lamps.txt --places two.txt --scale scale.txt --states after.txt --set error=0.02 --out two/fit1
    awk -v a="$(cell $s one place west 5)" -v b="$(cell $s two place east 5)" -v c="$(cell two/fit1/sheet.tsv one place west 5)" -v d="$(cell two/fit1/sheet.tsv two place east 5)" \
        'BEGIN { exit !((c / a - 0.5) ^ 2 < 1e-4 && (d / b - 2) ^ 2 < 1e-3) }' || { cat two/fit1/factors.txt; fail "measured lamps are not as bright as measured"; }
    # without a scale the measurements are the scale
    levels 0 'times as photographed' --lights lamps.txt --places two.txt --states after.txt --out two/fit2
    [ "$(cell two/fit2/sheet.tsv one place west 11)" = lx ] || fail "measurements give no scale"
    printf 'remodel-states 1\nmeasured 100 at none-such in lamps\n' >bad.txt
    levels 1 'bad.txt:2: found a measurement at none-such' --states bad.txt --out made
    printf 'remodel-states 1\nmeasured 100 at desk in evening\n' >bad.txt
    levels 1 'bad.txt:2: found "evening"' --states bad.txt --out made
    printf 'remodel-states 1\nmeasured 100 at west in overcast\n' >bad.txt
    levels 1 'no lamp and no window of the photographs brings light to west' --places two.txt --states bad.txt --out made
}

# the photos of the textures taken for others: in their own state they go with it, in another one a warning says that they do not
photographs_in_states_say_how_bright_lamps_are()
{
    printf 'remodel-states 1\nstate same sky photographed\nphoto photo_1 in same\nphoto photo_2 in same exposed 1\n' >same.txt
    levels 0 'photo photo_1 in same: ' --states same.txt --held-views $O/views --out two/same
    awk '/photo photo_[12] in same: / { n++; for (i = 1; i <= NF; i++) { if ($i == "exposed") e = $(i + 1); if ($i == "by") m = $(i + 1) }
        if (!(e > 0.95 && e < 1.05 && m < 10)) bad = 1 } END { exit !(n == 2 && !bad) }' err.txt || { cat err.txt; fail "photos do not go with the textures that they made"; }
    ! grep -q 'does not show' err.txt && awk '$1 == "window" || $1 == "rest" { n++; x = NF == 6 ? $3 : $2; if (!(x > 0.9 && x < 1.1)) bad = 1 } END { exit !n || bad }' two/same/factors.txt ||
        { cat err.txt two/same/factors.txt; fail "the same light changes factors"; }
    printf 'remodel-states 1\nstate noon lamps off sky overcast 1000\nphoto photo_1 in noon\n' >bad.txt
    levels 1 'bad.txt:3: the state noon has a computed sky or a planned lamp' --states bad.txt --held-views $O/views --out made
    printf 'remodel-states 1\nphoto none-such in lamps\n' >bad.txt
    levels 1 'bad.txt:2: found the photo none-such' --states bad.txt --held-views $O/views --out made
    printf 'remodel-states 1\nstate dark lamps off\nphoto photo_1 in dark\n' >bad.txt
    levels 1 'bad.txt:3: in the state dark no lamp and no window of the photographs shines' --states bad.txt --held-views $O/views --out made
    levels 2 'need --held-views' --states bad.txt --out made
    printf 'remodel-states 1\nphoto photo_1 in evening\n' >bad.txt
    levels 1 'bad.txt:2: found "evening"' --states bad.txt --out made
}

the_page_adds_groups_of_light_up()
{
    [ -s $O/lux/index.html ] || fail "make lux wrote no page"
    command -v node >/dev/null && node -e "process.exit(require('$root/tests/browser/chromium.js').Chromium.find() ? 0 : 1)" || skip "chromium or node is not installed"
    node "$root/tests/browser/levels_page.js" $O/lux dark >said.txt 2>&1 || { grep -v '^ok' said.txt; fail "the page fails"; }
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
    awk -F '\t' '$1 ~ /^year-/ { n++; if ($1 == "year-sun" ? $6 != "-" : !($6 <= $5 && $5 <= $7)) bad = 1 } END { exit !n || bad }' two/year/sheet.tsv ||
        { grep year two/year/sheet.tsv; fail "figures of a year have no intervals"; }
    printf 'remodel-states 1\nstate june lamps off sky weather 6 21 12.5\nstate night lamps off sky weather 6 21 3\n' >hours.txt
    levels 1 'hours.txt:3: the state night wants the weather of 6 21, 3 o'"'"'clock; the weather file has no such hour' --states hours.txt --weather year.epw --out made
    sed -i 3d hours.txt
    levels 1 'give a weather file' --states hours.txt --out made
    levels 0 used --states hours.txt --weather year.epw --out two/june
    [ "$(cell two/june/sheet.tsv june work-plane "$(awk -F '\t' '$2 == "work-plane" { print $3; exit }' two/june/sheet.tsv)" 11)" = lx ] || fail "an hour of the weather has no lx"
}

a_day_is_a_film()
{
    levels 0 patches --states scenes/t/states.txt --views $O/views --photo photo_1 --day 2026-12-21 --out two/day
    "$B/bin/verify" --file two/day/2026-12-21.mp4 || fail "the film is not whole"
    # without refraction the sun is up from 8:22 to 15:47, so at 30 quarters of an hour
    command -v ffprobe >/dev/null && ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 two/day/2026-12-21.mp4 >frames.txt && [ "$(tr -d ',' <frames.txt)" = 30 ] ||
        { cat frames.txt; fail "wanted 30 frames"; }
    levels 2 'wanted a date' --states scenes/t/states.txt --day 2026-02-30 --out made
    levels 1 'site LATITUDE LONGITUDE ZONE' --day 2026-12-21 --out made
    printf 'remodel-states 1\nsite 80 20 1\n' >polar.txt
    levels 1 'the sun does not rise on 12-21' --states polar.txt --day 2026-12-21 --out made
}

places_are_marked_in_photographs()
{
    printf 'remodel-places 1\nplace spot in photo_1 64 92 height 0.01\n' >marks.txt
    levels 0 patches --views $O/views --places marks.txt --out two/marks
    [ -n "$(cell two/marks/sheet.tsv photographed place spot 5)" ] || { cat two/marks/sheet.tsv; fail "the mark has no light"; }
    printf 'remodel-places 1\nplace spot in none-such 80 100\n' >marks.txt
    levels 1 'marks.txt:2' --views $O/views --places marks.txt --out made
    printf 'remodel-places 1\nplace spot in photo_1 80 10000\n' >marks.txt
    levels 1 'marks.txt:2: pixel 80 10000 is not inside the photo photo_1' --views $O/views --places marks.txt --out made
    printf 'remodel-places 1\nplace spot in photo_1 64 92 height 90\n' >marks.txt
    levels 1 'marks.txt:2: pixel 64 92 of photo_1 shows no place' --views $O/views --places marks.txt --out made
    levels 2 'need --views' --places marks.txt --out made
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

for t in make_lux_has_a_sheet_of_the_room_and_of_the_edit photographs_show_light_levels_with_a_key a_command_line_draws_photographs_in_any_state blinds_take_their_part_of_daylight measurements_in_states_say_how_bright_lamps_are photographs_in_states_say_how_bright_lamps_are the_page_adds_groups_of_light_up lamps_add_up_and_bytes_do_not_depend_on_threads a_year_of_weather_has_its_figures a_day_is_a_film places_are_marked_in_photographs a_room_without_a_scale_has_a_guessed_metre a_model_without_rooms_is_warned_of planned_lamps_shine_in_the_states_that_name_them errors_name_file_and_line; do run "$t"; done
