#!/usr/bin/env bash
# man.sh BIN STAGE - a stage's manual page on standard output, from the head of its main and from its --help.
set -euo pipefail
bin=$1 stage=$2
source=stages/$stage/$stage.c
roff() { sed -e 's/\\/\\e/g' -e "s/^[.']/\\\\\&&/" -e 's/-/\\-/g'; }
head=$(awk '/^\/\*/ { on = 1 } on { print } /\*\// { exit }' "$source" | sed -E 's|^/\* ?||; s|^ \* ?||; s| ?\*/$||')
echo ".TH ${stage^^} 1 \"\" \"remodel $(sed -nE 's/.*REMODEL_VERSION "(.*)"/\1/p' common/base/version.h)\" \"remodel\""
echo ".SH NAME"
head -n 1 <<<"$head" | sed -E "s/^$stage\.c - /$stage \\\\- /; s/\.\$//"
echo ".SH SYNOPSIS"
echo ".B $stage"
printf "%s\n" "[\\fIOPTION\\fR]..."
echo ".SH DESCRIPTION"
echo ".nf"
tail -n +2 <<<"$head" | sed '/./,$!d' | roff
echo ".fi"
echo ".SH OPTIONS"
echo ".nf"
"$bin/$stage" --help | sed '1,2d' | sed '/./,$!d' | roff
echo ".fi"
echo ".SH EXIT STATUS"
echo "0 made, 1 failed (a sentence on standard error says why; an older product is untouched), 2 wrong usage."
echo ".SH SEE ALSO"
echo "docs/formats.md for every file, docs/conventions.md for axes, units and colour."
