#!/usr/bin/env bash
# explain.sh - what the Makefile says to people.
set -euo pipefail
what=$1; shift
case $what in
no-scene)
    cat <<'TEXT'
To make a 3D pan & scan video of your own, give a folder of photos of one scene, taken from places a step apart:

    make PHOTOS=DIR SCENE=NAME      8 to 15 photos; the video and a page come under out/NAME
    make SCENE=NAME                 goes on, or redoes just what is stale
    make help                       all targets and variables
    make check                      the tests
TEXT
    ;;
why) # standard input: make -n --debug=b; Make 4.4 says more than 4.3 does of targets that are made together and do not exist
    said=$(awk -v S="$1" '
        function because(t, p, how) { if (index(reason[t], p) == 0) reason[t] = reason[t] (reason[t] ? ", " : "") p how }
        /^ *File .* does not exist\.$/ { gsub(/^ *File .|. does not exist\.$/, ""); reason[$0] = "it does not exist" }
        /^ *Grouped target peer .* does not exist\.$/ { split($0, q, /\047/); order[++n] = q[2]; reason[q[2]] = "it does not exist" }
        /^ *Prerequisite .* of target .* does not exist\.$/ { split($0, q, /\047/); because(q[4], q[2], " will be new") }
        /^ *Prerequisite .* is newer than target / { split($0, q, /\047/); because(q[4], q[2], q[2] in must ? " will be new" : " is newer") }
        /^ *Must remake target / { split($0, q, /\047/); t = q[2]; must[t] = 1; order[++n] = t }
        END {
            for (i = 1; i <= n; i++) {
                t = order[i]
                if (index(t, S) != 1 || t in said) continue
                said[t] = 1
                print t ": " (reason[t] ? reason[t] : "it is made together with one that is stale")
            }
        }')
    echo "${said:-Nothing is stale.}"
    for s in $(grep -oE '[^ ]*/slice/[a-z_]*\.cfg is newer' <<<"$said" | cut -d' ' -f1 | sort -u); do
        [ ! -e "$s.old" ] || diff "$s.old" "$s" | sed -nE "s|^< (.*)|$s: was \1|p; s|^> (.*)|$s: is \1|p" || true
    done
    ;;
esac
