# metric_tables.awk - awk -f metric_tables.awk metric_kinds.def docs/evaluation.md: the document with its tables of
# metrics made anew. Metrics without a definition of their own share the row of those above that have the same unit and
# direction.
function flush_row()
{
    if (names != "") table[group] = table[group] "| " names " | " unit " | " better " | " definition " |\n"
    names = ""
}
FNR == 1 { is_document = NR > 1 }
!is_document {
    if (/^METRIC\(/) text = ""
    else if (!/^ /) next
    text = text $0
    if (!/"\)$/) { text = text "\n"; next }
    gsub(/"\n *"/, "", text) # a definition goes on in the next line
    gsub(/\n */, " ", text)
    sub(/^METRIC\(/, "", text)
    sub(/"\)$/, "", text)
    split(text, field, /, "|", "/)
    if (field[6] != "" || field[1] != group) { flush_row(); definition = field[6]; unit = better = "" }
    else if (field[3] != unit || field[4] != better) { flush_row() }
    name = field[2]
    gsub(/\*/, "...", name)
    names = (names == "" ? "" : names ", ") "`" name "`"
    group = field[1]; unit = field[3]; better = field[4]
    next
}
/^<!-- metrics of / {
    flush_row()
    print
    printf "| metric | unit | better | definition |\n|---|---|---|---|\n%s", table[substr($4, 1, length($4) - 1)]
    is_old = 1
    next
}
/^<!-- end of metrics -->/ { is_old = 0 }
!is_old
