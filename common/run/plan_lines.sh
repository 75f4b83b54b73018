#!/usr/bin/env bash
# plan_lines.sh GRAPH - the plan of per-view work: of the commands that `make -n` prints, on standard input, those that make
# pieces of work, as lines "PRODUCTS<tab>COMMAND[<tab>OWN]" for common/run/run_lines.sh.
#
# GRAPH/STAGE.pieces lists the products of each piece, by stage, item and the last word of its command, and the options OWN at the end of its command that a process may be
# given several times (common/graph/graph_print.h).
set -euo pipefail
shopt -s nullglob
pieces=("$1"/*.pieces)
awk '
    FILENAME == "-" {
        if (!match($0, /run_stage\.sh quiet [^ ]+ [^ ]+/)) next
        split(substr($0, RSTART, RLENGTH), word, " ")
        key[++count] = word[3] " " word[4] " " $NF; command[count] = $0; wanted[key[count]] = 1
        next
    }
    { split($0, part, "\t") }
    part[1] in wanted { products[part[1]] = part[2]; own[part[1]] = part[3] }
    END {
        for (i = 1; i <= count; i++) {
            k = key[i]; c = command[i]
            if (own[k] != "") print products[k] "\t" substr(c, 1, length(c) - length(own[k]) - 1) "\t" own[k]
            else print products[k] "\t" c
        }
    }' - "${pieces[@]}"
