# the walk in Chromium against render_model: in viewpoints after an edit, and beside them; how quick it is
. tests/lib.sh
command -v node >/dev/null || { echo "skip walk: node is not installed (Debian: nodejs)"; exit 0; }
node -e "process.exit(require('$root/tests/browser/chromium.js').Chromium.find() ? 0 : 1)" || { echo "skip walk: chromium is not installed"; exit 0; }
project walk
photos set --views 6 --size 320x240 >/dev/null
boxed t "model textures remodel"
printf 'remodel-script 1\nbox chest from -4 6 to 4 12 top 3\ncolour box/chest 0.1 0.2 0.8\n' >scenes/t/edits/chest.txt
printf '[bake_outdoors]\nheight = 64\n[plan_tour]\nwidth = 64\nheight = 48\nfps = 4\nspeed = 8\nclearance = 0.5\nhold = 0.25\n' >>scenes/t/scene.cfg
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
O=out/t

the_scene_has_its_walk()
{
    m
    [ -s $O/walk/index.html ] || fail "PRODUCTS=remodel makes no walk"
    grep -qF 'walk/index.html' $O/index.html || fail "the page of the scene does not link to the walk"
}

viewpoints_show_what_render_model_draws() { node "$root/tests/browser/walk_page.js" $O/walk --at chest $O/remodel/chest/pictures 35; }

# 0.4 is a twentieth of the distance between two photos.
between_them_too()
{
    mkdir cameras
    cp $O/views/cameras.txt cameras/; : >cameras/points3D.txt
    awk '/^#/ { next } NF == 10 { $6 += 0.4; print; print "" }' $O/views/images.txt >cameras/images.txt
    m remodel CAMERAS=cameras
    node "$root/tests/browser/walk_page.js" $O/walk --moved "" 0.4 $O/model/cameras 30
}

its_speed_is_measured() { WALK_SPEED=1 node "$root/tests/browser/walk_page.js" $O/walk; }

for t in the_scene_has_its_walk viewpoints_show_what_render_model_draws between_them_too its_speed_is_measured; do run "$t"; done
