#!/usr/bin/env bash
# generate.sh BIN 'STAGE...' FOLDER - the files that come from the stages: FOLDER/docs/man/STAGE.1, FOLDER/configs/default.cfg,
# the table of stages in FOLDER/docs/architecture.md and the tables of metrics in FOLDER/docs/evaluation.md. A test compares the
# committed files with them (tests/lint/tree.sh).
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

# field STAGE NAME: what stages/STAGE/stage.mk sets NAME.STAGE to
field() { sed -nE "s/^$2\.$1 *:?= *//p" "stages/$1/stage.mk"; }
{
    echo "| stage | reads | writes under out/SCENE |"
    echo "|---|---|---|"
    for s in $stages; do echo "| \`$s\` | $(field "$s" READS) | $(field "$s" WRITES) |"; done
} >"$folder/.stages.tmp"
awk -v table="$folder/.stages.tmp" '
    /^<!-- stages: made by/ { print; while ((getline line <table) > 0) print line; skip = 1; next }
    /^<!-- end of stages -->/ { skip = 0 }
    !skip' docs/architecture.md | put "$folder/docs/architecture.md"
rm "$folder/.stages.tmp"

awk -f common/run/metric_tables.awk common/base/metric_kinds.def docs/evaluation.md | put "$folder/docs/evaluation.md"
