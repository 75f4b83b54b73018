#!/usr/bin/env bash
# job_size.sh CPUS LINES [ITEMS SECONDS MIB BYTES LONGEST] - how a job array is cut: prints "LINES MIB MINUTES".
#
# The last five are a stage's estimate of its work (common/base/work_estimate.h). Without them nothing is known: LINES, or 4,
# pieces make a task, and MIB and MINUTES are 0, which leaves both to the cluster's own rules. With them
#   LINES    what the user gave; otherwise as many pieces as take ten minutes on CPUS cores, but at most four, or a
#            sixteenth of all, so that a small job is not done by one node
#   MIB      a quarter more than the largest piece, and 64 MiB for the shell around it; at least 256
#   MINUTES  three times what LINES of the longest pieces take (the estimate is good to a third on the machine that it was
#            measured on, and nodes are slower than others), and one more to start; at least 10
set -euo pipefail
cpus=$1 lines=$2; shift 2
awk -v cpus="$cpus" -v lines="$lines" -v items="${1:-0}" -v seconds="${2:-0}" -v mib="${3:-0}" -v longest="${5:-0}" '
    function up(x) { return x == int(x) ? x : int(x) + 1 }
    function most(a, b) { return a > b ? a : b }
    BEGIN {
        if (!(items > 0)) { print (lines ? lines : 4), 0, 0; exit }
        if (!lines) {
            each = most(seconds / items / cpus, 1e-3)
            lines = most(1, int(600 / each))
            few = most(4, up(items / 16))
            if (lines > few) lines = few
        }
        print lines, most(256, up(1.25 * mib + 64)), most(10, up(1 + 3 * lines * longest / cpus / 60))
    }'
