# what export_model writes, read back by independent programs: gltf-validator and web-ifc (npm), assimp (Debian); skipped where they are absent
. tests/lib.sh
project exports
photos set >/dev/null
boxed t textures
printf 'door gate on north from -8 0 to 2 12 closed\nwindow pane on east from -5 5 to 5 12\n' >>scenes/t/model.txt
sed -i 's/^set slab 1$/set slab 1\nset glass 0.1\nset leaf 0.2/' scenes/t/model.txt
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

web_ifc_reads_the_building()
{
    has web-ifc || skip "node does not find web-ifc (npm install web-ifc; NODE_PATH=.../node_modules)"
    node -e "
        const W = require('web-ifc'), api = new W.IfcAPI();
        api.Init().then(() => {
            const m = api.OpenModel(new Uint8Array(require('fs').readFileSync('$E/model.ifc')));
            for (const t of ['IFCWALL', 'IFCOPENINGELEMENT', 'IFCDOOR', 'IFCWINDOW', 'IFCSLAB', 'IFCSPACE', 'IFCINDEXEDTRIANGLETEXTUREMAP'])
                console.log(t, api.GetLineIDsWithType(m, W[t]).size());
            let volume = 0;
            api.StreamAllMeshes(m, mesh => {
                if (api.GetLine(m, mesh.expressID).constructor.name !== 'IfcWall') return;
                for (let k = 0; k < mesh.geometries.size(); k++) {
                    const g = mesh.geometries.get(k), G = api.GetGeometry(m, g.geometryExpressID), t = g.flatTransformation;
                    const V = api.GetVertexArray(G.GetVertexData(), G.GetVertexDataSize()), I = api.GetIndexArray(G.GetIndexData(), G.GetIndexDataSize());
                    const P = i => [0, 1, 2].map(r => t[r] * V[6 * i] + t[4 + r] * V[6 * i + 1] + t[8 + r] * V[6 * i + 2] + t[12 + r]);
                    for (let q = 0; q < I.length; q += 3) {
                        const [a, b, c] = [P(I[q]), P(I[q + 1]), P(I[q + 2])];
                        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
                    }
                }
            });
            console.log('volume', volume);
        }).catch(e => { console.log(e); process.exit(1); })" >found 2>&1 || { cat found; fail "web-ifc cannot read it"; }
    for w in 'IFCWALL 4' 'IFCOPENINGELEMENT 2' 'IFCDOOR 1' 'IFCWINDOW 1' 'IFCSLAB 2' 'IFCSPACE 1'; do grep -qx "$w" found || { cat found; fail "wanted $w"; }; done
    # four walls of 20 x 1 round a room of 60 x 60, whose corners two walls share, less the door and the window
    awk '$1 == "volume" { v = $2 } $1 == "IFCINDEXEDTRIANGLETEXTUREMAP" { n = $2 } END { exit !(n > 3 && v > 4800 - 200 && v < 4800 + 200) }' found || { cat found; fail "wanted the volume of the walls, and texture maps"; }
}

assimp_reads_obj_and_gltf()
{
    command -v assimp >/dev/null || skip "assimp is not installed (Debian: assimp-utils)"
    for f in obj glb; do
        assimp info "$E/model.$f" >found 2>&1 || { cat found; fail "assimp cannot read model.$f"; }
        grep -qE '^(Faces|Meshes): +[1-9]' found || { cat found; fail "model.$f: no faces"; }
    done
}

for t in the_gltf_validator_finds_no_error web_ifc_reads_the_building assimp_reads_obj_and_gltf; do run "$t"; done
