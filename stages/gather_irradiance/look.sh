#!/usr/bin/env bash
# look.sh BIN S O - the points to gather at, in O/stamp/irradiance_points.txt: GATHER_POINTS, or those of the truth, without
# the provenance of what wrote them.
set -euo pipefail
. common/run/keep.sh
points=${REMODEL_GATHER_POINTS:-$3/evaluate/irradiance_points.txt}
if [ -f "$points" ]; then sed '/^#/d' "$points" | keep "$3/stamp/irradiance_points.txt"; else rm -f "$3/stamp/irradiance_points.txt"; fi
