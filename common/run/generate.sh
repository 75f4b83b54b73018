#!/usr/bin/env bash
# generate.sh BIN 'STAGE...' FOLDER - the files that come from the stages and the table of products: FOLDER/docs/man/STAGE.1,
# FOLDER/configs/default.cfg, the table of stages in FOLDER/docs/architecture.md, the table of products in FOLDER/docs/formats.md,
# the tables of metrics in FOLDER/docs/evaluation.md. A test compares the committed files with them (tests/lint/tree.sh).
set -euo pipefail
bin=$1 stages=$2 folder=$3

# put FILE: standard input becomes FILE at once
put() { mkdir -p "$(dirname "$1")"; cat >"$1.tmp"; mv "$1.tmp" "$1"; }

for s in $stages; do common/run/man.sh "$bin" "$s" | put "$folder/docs/man/$s.1"; done

{
    echo "# Every parameter with its default, one section for each stage; made by \`make generated\`. A scene's own values go to"
    echo "# scenes/NAME/scene.cfg, which holds only what differs; draft.cfg and final.cfg hold what those qualities change. A comment"
    echo "# after a value begins with \" ;\"."
    for s in $stages; do
        text=$("$bin/$s" --explain-config)
        [ "$text" = "[$s]" ] || printf '\n%s\n' "$text"
    done
} | sed 's/[[:space:]]*$//' | put "$folder/configs/default.cfg"

# fill TABLE FILE: FILE of this tree, with the lines of standard input between the marks "TABLE: made by" and "end of TABLE"
fill()
{
    cat >"$folder/.table.tmp"
    awk -v table="$folder/.table.tmp" -v name="$1" '
        index($0, "<!-- " name ": made by") { print; while ((getline line <table) > 0) print line; skip = 1; next }
        index($0, "<!-- end of " name " -->") { skip = 0 }
        !skip' "$2" | put "$folder/$2"
    rm "$folder/.table.tmp"
}

products=$("$bin/verify" --list)
# field STAGE NAME: what stages/STAGE/stage.mk sets NAME.STAGE to
field() { sed -nE "s/^$2\.$1 *:?= *//p" "stages/$1/stage.mk"; }
# written STAGE: the products of a stage; a folder is named once for those that follow each other
written()
{
    awk -F'\t' -v stage="$1" '
        $1 == "product" && index(" " $5 " ", " " stage " ") {
            folder = file = substr($2, 1); sub(/[^/]*$/, "", folder); file = substr($2, length(folder) + 1)
            printf "%s%s", n++ ? ", " : "", folder == last ? file : folder file; last = folder
        }
        END { if (!n) printf "nothing that is kept" }' <<<"$products"
}
{
    echo "| stage | reads | writes |"
    echo "|---|---|---|"
    for s in $stages; do echo "| \`$s\` | $(field "$s" READS) | $(written "$s") |"; done
} | fill stages docs/architecture.md
awk -F'\t' '
    BEGIN { print "| product | format | made by | what it is |\n|---|---|---|---|" }
    $1 == "product" { gsub(/ /, ", ", $5); printf "| `%s` | %s | %s | %s |\n", $2, $4 != "" ? "`" $4 "`" : $3, $5, $6 }
    $1 == "key" && !n++ { print "\n| in paths | stands for | |\n|---|---|---|" }
    $1 == "key" {
        gsub(/\|/, "`, `", $3); gsub(/\*/, "...", $3)
        printf "| %s | %s | %s |\n", $2, $3 == "#" ? "a number" : $3 == "..." ? "a name" : "`" $3 "`", $4
    }' <<<"$products" | fill products docs/formats.md
awk -f common/run/metric_tables.awk common/base/metric_kinds.def docs/evaluation.md | put "$folder/docs/evaluation.md"
