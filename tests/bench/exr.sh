# exr.sh - throughput of common/image/exr.c by codec and threads, against the OpenEXR library itself.
#
# Pictures: a synthetic one, 1920 x 1280, RGBA half, with a camera's noise; and a rectified view if a scene has been run
# (VIEW=FILE names another, VIEW= none). BENCH_CODECS and BENCH_THREADS choose fewer settings.
#
# The baseline is the OpenEXR library's C++ interface, which ImageMagick, OpenCV and other writers of EXR files call:
# same codec, compression level and number of threads. It gets the same input as exr.c (planes of float in memory, with
# the conversion timed) but does not check samples for NaN, and writes in place; exr.c writes a temporary file and
# renames it. Files are in memory if the machine has /dev/shm.
#
# seconds: one write or read; mb: the samples' bytes before compression; peak_mib: of the process, including the
# picture.
title="EXR files: time against size"
note="Lower left is better. Points: codecs."
baseline=OpenEXR
match="picture direction codec threads"
line="series threads" label=codec panel="picture direction"
x_label="Time of one picture (s)" y=size_mb y_label="File size (MB)"
rate=mb

prepare()
{
    "$B/tests/bench/exr" --paint --picture "$fast/synthetic.exr" 2>/dev/null
    view=${VIEW-$(find out -path out/build -prune -o -path '*/views/*.exr' -print 2>/dev/null | sort | sed -n 1p)}
    [ -n "$view" ] || echo "exr: no scene has rectified views under out/; only the synthetic picture is measured." >&2
}

settings()
{
    printf 'series\tpicture\tdirection\tcodec\tthreads\n'
    for picture in synthetic ${view:+view}; do for direction in write read; do
        for threads in ${BENCH_THREADS:-1 $([ "$(nproc)" = 1 ] || nproc)}; do for codec in ${BENCH_CODECS:-none RLE ZIPS ZIP}; do for series in remodel OpenEXR; do
            printf '%s\t%s\t%s\t%s\t%s\n' "$series" "$picture" "$direction" "$codec" "$threads"
        done; done; done
    done; done
}

sample()
{
    local file=$fast/synthetic.exr
    [ "$2" = synthetic ] || file=$view
    measured "$B/tests/bench/exr" --by "$1" --picture "$file" --direction "$3" --codec "$4" --threads "$5" --folder "$fast" || return
    awk '$1 == "bytes" { printf "size_mb %.6g\n", $2 * 1e-6 }' "$work/output"
}
