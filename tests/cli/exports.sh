# what export_model writes, read back by independent programs: gltf-validator and web-ifc (npm), assimp (Debian); skipped where they are absent
. tests/lib.sh
project exports
photos set >/dev/null
boxed t textures
printf 'door gate on north from -8 0 to 2 12 closed\nwindow pane on east from -5 5 to 5 12\n' >>scenes/t/model.txt
sed -i 's/^set slab 1$/set slab 1\nset glass 0.1\nset leaf 0.2/' scenes/t/model.txt
printf 'remodel-script 1\ngable hall from south 20 to north 20 ridge 30\nskylight sky on hall from 5 5 to 10 10\nhatch trap on hall from -20 -20 to -15 -15 closed\n' >scenes/t/edits/attic.txt
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t exports >log 2>&1 || { cat log; fail "make exports"; }
E=$PWD/out/t/remodel/bare/export

# has MODULE: whether node finds it
has() { command -v node >/dev/null && node -e "require.resolve('$1')" 2>/dev/null; }

the_gltf_validator_finds_no_error()
{
    has gltf-validator || skip "node does not find gltf-validator (npm install gltf-validator; NODE_PATH=.../node_modules)"
    node -e "
        require('gltf-validator').validateBytes(new Uint8Array(require('fs').readFileSync('$E/model.glb'))).then(r => {
            console.log(JSON.stringify(r.issues.messages));
            process.exit(r.issues.numErrors + r.issues.numWarnings > 0 || r.info.totalTriangleCount < 12 ? 1 : 0); })" >found || { cat found; fail "the validator has findings"; }
}

# building FILE: "TYPE COUNT VOLUME" of the building's parts, as web-ifc reads them: with openings cut out of walls and slabs
building()
{
    node -e "
        const W = require('web-ifc'), api = new W.IfcAPI();
        const volume = (m, id) => {
            const mesh = api.GetFlatMesh(m, id);
            let sum = 0;
            for (let k = 0; k < mesh.geometries.size(); k++) {
                const g = mesh.geometries.get(k), G = api.GetGeometry(m, g.geometryExpressID), t = g.flatTransformation;
                const V = api.GetVertexArray(G.GetVertexData(), G.GetVertexDataSize()), I = api.GetIndexArray(G.GetIndexData(), G.GetIndexDataSize());
                const P = i => [0, 1, 2].map(r => t[r] * V[6 * i] + t[4 + r] * V[6 * i + 1] + t[8 + r] * V[6 * i + 2] + t[12 + r]);
                for (let q = 0; q < I.length; q += 3) {
                    const [a, b, c] = [P(I[q]), P(I[q + 1]), P(I[q + 2])];
                    sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
                }
            }
            return sum;
        };
        api.Init().then(() => {
            const m = api.OpenModel(new Uint8Array(require('fs').readFileSync('$1')));
            for (const t of ['IFCWALL', 'IFCOPENINGELEMENT', 'IFCDOOR', 'IFCWINDOW', 'IFCSLAB', 'IFCSPACE', 'IFCINDEXEDTRIANGLETEXTUREMAP']) {
                const ids = api.GetLineIDsWithType(m, W[t]);
                let sum = 0;
                for (let i = 0; i < ids.size() && !t.endsWith('MAP'); i++) sum += volume(m, ids.get(i));
                console.log(t, ids.size(), sum.toFixed(3));
            }
        }).catch(e => { console.log(e); process.exit(1); })" 2>&1
}

# has_parts TYPE COUNT VOLUME ...: found has them; volumes within a thousandth
has_parts()
{
    while [ $# -gt 0 ]; do
        awk -v t="$1" -v n="$2" -v v="$3" '$1 == t { d = $3 - v; ok = $2 == n && d * d <= 1e-6 * v * v } END { exit !ok }' found || { cat found; fail "wanted $1 $2 $3"; }
        shift 3
    done
}

web_ifc_reads_the_building()
{
    has web-ifc || skip "node does not find web-ifc (npm install web-ifc; NODE_PATH=.../node_modules)"
    building "$E/model.ifc" >found || { cat found; fail "web-ifc cannot read it"; }
    # four walls of 62 x 20 x 1, corners included, less a door of 10 x 12 and a window of 10 x 7; a leaf 0.2 and a pane 0.1 thick
    has_parts IFCWALL 4 4770 IFCDOOR 1 24 IFCWINDOW 1 7 IFCSLAB 2 7200 IFCSPACE 1 72000
    grep -q '^IFCOPENINGELEMENT 2 ' found || { cat found; fail "wanted two openings"; }
    awk '$1 == "IFCINDEXEDTRIANGLETEXTUREMAP" { n = $2 } END { exit !(n > 3) }' found || { cat found; fail "wanted texture maps"; }
}

web_ifc_reads_a_gable()
{
    has web-ifc || skip "node does not find web-ifc (npm install web-ifc; NODE_PATH=.../node_modules)"
    building "$PWD/out/t/remodel/attic/export/model.ifc" >found || { cat found; fail "web-ifc cannot read it"; }
    # the ridge is 10 above the eaves: two walls of 62 x 20, and two whose profile is 1240 + 20 (31 - 31^2 / 60); a floor and two
    # sloping slabs, less a skylight and a hatch of 5 x 5, which have a pane and a leaf
    has_parts IFCWALL 4 5369.333 IFCSLAB 3 7150 IFCSPACE 1 90000 IFCWINDOW 2 9.5 IFCDOOR 2 29
    grep -q '^IFCOPENINGELEMENT 4 ' found || { cat found; fail "wanted four openings"; }
}

assimp_reads_obj_and_gltf()
{
    command -v assimp >/dev/null || skip "assimp is not installed (Debian: assimp-utils)"
    local triangles; triangles=$(grep -c '^f ' "$E/model.obj")
    # the walls and slabs are 1 thick; y is up in glTF
    for f in 'obj -31.000000 -31.000000 -1.000000  31.000000 31.000000 21.000000' 'glb -31.000000 -1.000000 -31.000000  31.000000 21.000000 31.000000'; do
        read -r format x y z X Y Z <<<"$f"
        assimp info "$E/model.$format" >found 2>&1 || { cat found; fail "assimp cannot read model.$format"; }
        { grep -qE "^Faces: +$triangles\$" found && [ "$triangles" -ge 80 ]; } || { cat found; fail "model.$format: wanted $triangles triangles"; }
        { grep -qF "Minimum point      ($x $y $z)" found && grep -qF "Maximum point      ($X $Y $Z)" found; } || { cat found; fail "model.$format: wanted the room's size"; }
    done
    grep -qE '^Textures \(embed\.\): +1$' found || { cat found; fail "model.glb: wanted its picture inside"; }
}

for t in the_gltf_validator_finds_no_error web_ifc_reads_the_building web_ifc_reads_a_gable assimp_reads_obj_and_gltf; do run "$t"; done
