# true_cameras.awk -v size=WIDTH,HEIGHT -v to=DIR NAME.camera... - writes true cameras as a COLMAP model without points:
# DIR/cameras.txt, images.txt, points3D.txt.
#
# A file NAME.camera holds K (three rows), a line of distortion, R (three rows), the centre, and the size of the photos that K
# is of. The columns of R are the axes of the camera in the world. In K the centre of the first pixel is (0, 0); in the model
# it is (0.5, 0.5). The photos may have another size, the same for all.
FNR == 1 { line = 0; n++; name[n] = FILENAME; sub(/.*\//, "", name[n]); sub(/\.camera$/, "", name[n]) }
!NF { next }
{ line++ }
line <= 3 { for (i = 1; i <= 3; i++) k[n, line, i] = $i }
line == 4 { for (i = 1; i <= NF; i++) if ($i != 0) fault(FILENAME ":" FNR ": found the distortion " $0 ", wanted zeros") }
line >= 5 && line <= 7 { for (i = 1; i <= 3; i++) r[n, i, line - 4] = $i } # transposed: camera from world
line == 8 { for (i = 1; i <= 3; i++) c[n, i] = $i }
line == 9 { width[n] = $1; height[n] = $2 }
function fault(message) { print message >"/dev/stderr"; failed = 1; exit 1 }
# q[1..4], w first, of the rotation of camera n: s holds 4 q[i] q[j]
function quaternion(n,    i, j, m)
{
    s[1, 1] = 1 + r[n, 1, 1] + r[n, 2, 2] + r[n, 3, 3]
    for (i = 1; i <= 3; i++) s[i + 1, i + 1] = 2 + 2 * r[n, i, i] - s[1, 1]
    s[1, 2] = r[n, 3, 2] - r[n, 2, 3]; s[1, 3] = r[n, 1, 3] - r[n, 3, 1]; s[1, 4] = r[n, 2, 1] - r[n, 1, 2]
    s[2, 3] = r[n, 1, 2] + r[n, 2, 1]; s[2, 4] = r[n, 1, 3] + r[n, 3, 1]; s[3, 4] = r[n, 2, 3] + r[n, 3, 2]
    m = 1
    for (i = 2; i <= 4; i++) if (s[i, i] > s[m, m]) m = i
    for (j = 1; j <= 4; j++) q[j] = (j < m ? s[j, m] : s[m, j]) / (2 * sqrt(s[m, m]))
}
END {
    if (failed) exit 1
    split(size, photo, ",")
    for (i = 1; i <= n; i++) {
        if (!(width[i] > 0)) fault(name[i] ".camera: found no size in line 9, wanted K, distortion, R, centre, size")
        sx = photo[1] / width[i]; sy = photo[2] / height[i]
        printf "%d PINHOLE %d %d %.9g %.9g %.9g %.9g\n", i, photo[1], photo[2], k[i, 1, 1] * sx, k[i, 2, 2] * sy,
            (k[i, 1, 3] + 0.5) * sx, (k[i, 2, 3] + 0.5) * sy >(to "/cameras.txt")
        quaternion(i)
        for (j = 1; j <= 3; j++) t[j] = -(r[i, j, 1] * c[i, 1] + r[i, j, 2] * c[i, 2] + r[i, j, 3] * c[i, 3])
        printf "%d %.12g %.12g %.12g %.12g %.12g %.12g %.12g %d %s\n\n", i, q[1], q[2], q[3], q[4], t[1], t[2], t[3], i, name[i] >(to "/images.txt")
    }
    printf "" >(to "/points3D.txt")
}
