#!/usr/bin/env bash
# doctor.sh - whether this machine is able to run scenes: a line for each thing looked at, which begins with ok, note (it works, but
# read on) or bad. Exit 1 if something is bad.
set -uo pipefail
bad=0
ok() { echo "ok    $*"; }
note() { echo "note  $*"; }
bad() { echo "bad   $*"; bad=1; }

if [ -e common/make/installed ]; then for p in make colmap ffmpeg; do command -v $p >/dev/null || bad "$p is not installed"; done
elif missing=$(common/run/deps.sh manual run 2>&1); then ok "all packages are installed"
else bad "packages are missing; plain make installs them, or: $(tail -n 1 <<<"$missing" | sed 's/^ *//')"
fi

if command -v colmap >/dev/null; then
    words=$(QT_QPA_PLATFORM=offscreen colmap help 2>&1 | tr '\n' ' ')
    version=$(sed -nE 's/^COLMAP ([0-9][^ ]*).*/\1/p' <<<"$words")
    case $version in
    3.[89]* | 3.1[0-9]* | 4.*) ok "COLMAP $version" ;;
    '') bad "colmap does not run: ${words:0:200}" ;;
    *) note "COLMAP $version was never tried; 3.8 to 4.x are known to work" ;;
    esac
fi
if command -v ffmpeg >/dev/null; then
    encoders=$(ffmpeg -hide_banner -encoders 2>/dev/null) lacks=
    case $encoders in
    *" libx264 "*) ok "ffmpeg with libx264" ;;
    *) bad "ffmpeg has no encoder libx264, so it writes no films; install the package of Debian" ;;
    esac
    for e in libx265:hlg,pq libsvtav1:av1 prores_ks:prores; do
        case $encoders in *" ${e%:*} "*) ;; *) lacks+=" ${e#*:} (${e%:*})" ;; esac
    done
    [ -z "$lacks" ] || note "ffmpeg has no encoder for FILM=$lacks; the package of Debian has"
fi

if [ "$(uname -m)" = x86_64 ] && ! grep -qw avx2 /proc/cpuinfo; then
    bad "the processor has no AVX2: the programs end with an illegal instruction (FLAVOR=portable is slower, and Embree and Ceres still need it)"
else ok "the processor is fast enough ($(uname -m))"; fi
cores=$(nproc)
memory=$(awk '/^MemAvailable:/ { printf "%.1f", $2 / 2^20 }' /proc/meminfo)
if awk -v m="$memory" -v c="$cores" 'BEGIN { exit !(m >= c) }'; then ok "$cores cores, $memory GiB of free memory"
else note "$cores cores, but $memory GiB of free memory: a core wants about 1 GiB. Give CORES=$(awk -v m="$memory" 'BEGIN { print m < 1 ? 1 : int(m) }')"; fi
free=$(df -Pk . | awk 'NR == 2 { printf "%.0f", $4 / 2^20 }')
if [ "$free" -ge 20 ]; then ok "$free GiB of free disk"; else note "$free GiB of free disk: a room of a hundred views takes about 10 GiB"; fi
if command -v sbatch >/dev/null && sinfo -h >/dev/null 2>&1; then ok "Slurm answers: JOBS=slurm works"; else ok "no Slurm cluster, which only JOBS=slurm needs"; fi
exit $bad
