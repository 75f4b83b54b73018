# suggest_score.awk - the walls of a suggested script against those of a layout, as a table.
#
#   awk -f suggest_score.awk LAYOUT.json AXES.txt SUGGESTED.txt
#
# The layout's frame is that of the cameras. A wall of the layout longer than 1 m is found if faces of suggested walls
# that run along it, within 10 cm or 5 % of the distance to the nearest camera, whichever is larger, cover half of its
# length. The partition between kitchen and living room, which the layout's outline lacks, is added.
function number_list(text, into,    n, k, parts) {
    gsub(/[^-+0-9.eE]+/, " ", text)
    n = split(text, parts, " ")
    for (k = 1; k <= n; k++) into[k] = parts[k] + 0
    return n
}
function add_true(x0, y0, x1, y1) {
    if (sqrt((x1 - x0) ^ 2 + (y1 - y0) ^ 2) <= 1) return
    true_x0[trues] = x0; true_y0[trues] = y0; true_x1[trues] = x1; true_y1[trues] = y1
    trues++
}
function read_layout(text,    part, n, v, k) {
    gsub(/[ \n\t]/, "", text)
    part = substr(text, index(text, "\"walls\":[[") + 9)
    part = substr(part, 1, index(part, "]]"))
    n = number_list(part, v)
    for (k = 1; k <= n; k += 2) add_true(v[k], v[k + 1], k + 2 > n ? v[1] : v[k + 2], k + 2 > n ? v[2] : v[k + 3])
    add_true(2.02, -3.27, 4.59, -3.27)
    add_true(2.02, -3.14, 4.59, -3.14)
    while (match(text, /"centre":\[[^]]*\]/)) {
        number_list(substr(text, RSTART + 9, RLENGTH - 9), v)
        camera_x[cameras] = v[1]; camera_y[cameras] = v[2]; cameras++
        text = substr(text, RSTART + RLENGTH)
    }
}
# p_world = R' (p_model - t) / S at the floor's height
function to_world(x, y, out,    a, b, c) {
    a = x - t[1]; b = y - t[2]; c = -t[3]
    out[1] = (r[1, 1] * a + r[2, 1] * b + r[3, 1] * c) / scale
    out[2] = (r[1, 2] * a + r[2, 2] * b + r[3, 2] * c) / scale
}
function add_face(x0, y0, x1, y1, name,    p, q) {
    to_world(x0, y0, p)
    to_world(x1, y1, q)
    face_x0[faces] = p[1]; face_y0[faces] = p[2]; face_x1[faces] = q[1]; face_y1[faces] = q[2]
    face_name[faces++] = name
}
function distance_to(px, py, x0, y0, x1, y1,    dx, dy, s) {
    dx = x1 - x0; dy = y1 - y0
    s = ((px - x0) * dx + (py - y0) * dy) / (dx * dx + dy * dy)
    s = s < 0 ? 0 : s > 1 ? 1 : s
    return sqrt((px - x0 - s * dx) ^ 2 + (py - y0 - s * dy) ^ 2)
}
# The distance across from a place of wall i to the nearest face that passes it; *best_face.
function nearest(i, px, py,    k, dx, dy, l, ex, ey, m, s, d, best) {
    best = 1e9
    dx = true_x1[i] - true_x0[i]; dy = true_y1[i] - true_y0[i]; l = sqrt(dx * dx + dy * dy)
    for (k = 0; k < faces; k++) {
        ex = face_x1[k] - face_x0[k]; ey = face_y1[k] - face_y0[k]; m = sqrt(ex * ex + ey * ey)
        if (m == 0 || (dx * ex + dy * ey) ^ 2 < 0.97 * 0.97 * l * l * m * m) continue
        s = ((px - face_x0[k]) * ex + (py - face_y0[k]) * ey) / m
        if (s < -0.1 || s > m + 0.1) continue
        d = ((px - face_x0[k]) * ey - (py - face_y0[k]) * ex) / m
        d = d < 0 ? -d : d
        if (d < best) { best = d; best_face = k }
    }
    return best
}
BEGIN { trues = cameras = faces = 0 }
FILENAME == ARGV[1] { text = text $0; next }
$1 == "rotation" && FILENAME == ARGV[2] {
    w = $2; x = $3; y = $4; z = $5
    r[1, 1] = 1 - 2 * (y * y + z * z); r[1, 2] = 2 * (x * y - w * z); r[1, 3] = 2 * (x * z + w * y)
    r[2, 1] = 2 * (x * y + w * z); r[2, 2] = 1 - 2 * (x * x + z * z); r[2, 3] = 2 * (y * z - w * x)
    r[3, 1] = 2 * (x * z - w * y); r[3, 2] = 2 * (y * z + w * x); r[3, 3] = 1 - 2 * (x * x + y * y)
}
$1 == "translation" && FILENAME == ARGV[2] { for (k = 1; k <= 3; k++) t[k] = $(k + 1) }
$1 == "scale" && FILENAME == ARGV[2] { scale = $2 }
$1 == "wall" && $3 == "from" && FILENAME == ARGV[3] {
    add_face($4, $5, $7, $8, $2)
    for (k = 9; k < NF; k++)
        if ($k == "thickness") {
            l = sqrt(($7 - $4) ^ 2 + ($8 - $5) ^ 2)
            if (l > 0) { ox = -($8 - $5) / l * $(k + 1); oy = ($7 - $4) / l * $(k + 1); add_face($4 + ox, $5 + oy, $7 + ox, $8 + oy, $2 "/out") }
        }
}
END {
    read_layout(text)
    printf "from\tto\tlength\ttolerance\tseen_as\tcovered\terror\tfound\n"
    for (i = 0; i < trues; i++) {
        dx = true_x1[i] - true_x0[i]; dy = true_y1[i] - true_y0[i]; l = sqrt(dx * dx + dy * dy)
        near = 1e9
        for (k = 0; k < cameras; k++) {
            d = distance_to(camera_x[k], camera_y[k], true_x0[i], true_y0[i], true_x1[i], true_y1[i])
            if (d < near) near = d
        }
        tolerance = 0.05 * near > 0.1 ? 0.05 * near : 0.1
        n = int(l / 0.02); covered = 0; error = 0; name = "-"
        for (k = 0; k < n; k++) {
            d = nearest(i, true_x0[i] + (k + 0.5) / n * dx, true_y0[i] + (k + 0.5) / n * dy)
            if (d > tolerance) continue
            covered++; error += d; name = face_name[best_face]
        }
        found = covered >= n / 2; all += found
        printf "%.2f,%.2f\t%.2f,%.2f\t%.2f\t%.3f\t%s\t%.2f\t%s\t%s\n", true_x0[i], true_y0[i], true_x1[i], true_y1[i], l, tolerance, name, covered / n, covered ? sprintf("%.3f", error / covered) : "-", found ? "yes" : "no"
    }
    printf "# found %d of %d, %.0f %%\n", all, trues, 100 * all / trues
}
