/* edits.c - random sequences of legal edits: every model is a closed, 2-manifold solid, and faces keep their ids.
 *
 * Statements are drawn at random over a flat of two rooms; those that the plan refuses are no edits and are left
 * out. */
#include "tests/unit/build_model/scripted.h"

#include "common/rng.h"
#include "stages/build_model/unite.h"

enum { LEGAL = 10000, STEPS = 25 }; /* edits in all; statements of a sequence */

#define FLAT                                                                                                           \
    ROOM "remove hall\nwall middle from 2 1 to 2 2 thickness 0.1\nextend middle start to south\nextend middle end to " \
         "north\nroom left south west north middle\nroom right middle north east south\n"                              \
         "door d on middle from 1 0 to 2 2\nwindow w on south from 0.5 1 to 1.5 2\nwindow v on east from 1 1 to 2 2\n" \
         "box b from 2.5 1 to 3 1.5 top 1\n"

static struct rng random_numbers;
static uint64_t drawn;

static double uniform(double low, double high)
{
    return low + (high - low) * floor(rng_uniform(&random_numbers, 0, drawn++) * 20) / 20; /* coincidences wanted */
}

static int one_of(int count) { return (int)(rng_uniform(&random_numbers, 1, drawn++) * count); }

static void random_statement(char *line, size_t size, int step)
{
    static const char *const walls[] = {"south", "west", "north", "east", "middle"};
    static const char *const holes[] = {"d", "w", "v", "n1", "n2", "n3"};
    const char *wall = walls[one_of(5)], *hole = holes[one_of(6)];
    const double s = uniform(-1, 4), z = uniform(0, 2);
    switch (one_of(11)) {
    case 0:
    case 1:
        snprintf(line, size, "move %s by %.3f\n", wall, uniform(-0.5, 0.5));
        break;
    case 2:
        snprintf(line, size, "move %s by %.3f\n", hole, uniform(-0.5, 0.5));
        break;
    case 3:
        snprintf(line, size, "adjust %s from %.3f %.3f to %.3f %.3f\n", hole, s, z, s + uniform(0.2, 1.2),
                 z + uniform(0.2, 1.5));
        break;
    case 4:
        snprintf(line, size, "%s %s\n", one_of(2) ? "open" : "close", hole);
        break;
    case 5:
        snprintf(line, size, "%s n%d on %s from %.3f %.3f to %.3f %.3f\n", one_of(2) ? "window" : "passage", step, wall,
                 s, z, s + uniform(0.2, 1), z + uniform(0.2, 1));
        break;
    case 6:
        snprintf(line, size, "door n%d on %s from %.3f 0 to %.3f %.3f closed\n", step, wall, s, s + uniform(0.5, 1),
                 uniform(1.5, 2.5));
        break;
    case 7:
        snprintf(line, size, "box n%d from %.3f %.3f to %.3f %.3f top %.3f turn %d\n", step, s, z, s + uniform(0.1, 1),
                 z + uniform(0.1, 1), uniform(0.1, 2.5), one_of(3) * 30);
        break;
    case 8:
        snprintf(line, size, "move b by %.3f %.3f\n", uniform(-0.5, 0.5), uniform(-0.5, 0.5));
        break;
    case 9:
        snprintf(line, size, "slope right from middle %.3f to east %.3f\n", uniform(2, 3), uniform(2, 3));
        break;
    default:
        if (one_of(4))
            snprintf(line, size, "split %s from %.3f to %.3f into n%d\n", wall, s, s + uniform(0.2, 1), step);
        else
            snprintf(line, size, "remove %s\n", one_of(3) ? hole : wall);
    }
}

/* The mesh of the plan; its faces' names that `base` knows have base's ids. */
static void check_solid(const struct plan *plan, const struct solid_mesh *base, const char *said)
{
    struct solid_list list;
    struct solid_mesh mesh = {0};
    struct solid_report report = {0};
    struct err err = ERR_INIT;
    if (layout_solids(&list, plan, &err) || solids_unite(&mesh, &list, NULL, &err) ||
        solid_mesh_check(&mesh, 0, &report, &err) || solid_mesh_carry_ids(&mesh, base, &err))
        fail_msg("%s\nafter:\n%s", err.text, said);
    assert_true(report.volume > 0);
    for (int i = 0; i < mesh.name_count; i++)
        for (int k = 0; k < base->name_count; k++)
            assert_int_equal(!strcmp(mesh.names[i].name, base->names[k].name), mesh.names[i].id == base->names[k].id);
    solid_report_release(&report);
    solid_mesh_release(&mesh);
    solid_list_release(&list);
}

/* Applies one more statement; a refused one must leave a sentence, and the sequence goes on without it. */
static bool try_edit(struct plan *plan, const char *said, const char *line)
{
    char text[STEPS * 128 + 64];
    struct err err = ERR_INIT;
    snprintf(text, sizeof text, "remodel-script 1\n%s%s", said, line);
    if (!scripted(plan, FLAT, text, &err)) return true;
    assert_true(err.status == ST_DATA && strstr(err.text, "edit.txt:"));
    plan_release(plan);
    return false;
}

static void random_edits_leave_solids(void **state)
{
    struct plan plan;
    struct solid_list list;
    struct solid_mesh base = {0};
    struct err err = ERR_INIT;
    int legal = 0, sequences = 0;
    (void)state;
    random_numbers = rng_make(7, "build_model", "edits");
    build(&plan, &list, FLAT, NULL);
    assert_ok(solids_unite(&base, &list, NULL, &err), err);
    drop(&plan, &list);
    for (; legal < LEGAL; sequences++) {
        char said[STEPS * 128] = "";
        for (int step = 1; step <= STEPS; step++) {
            char line[128];
            random_statement(line, sizeof line, step);
            if (!try_edit(&plan, said, line)) continue;
            strcat(said, line);
            legal++;
            check_solid(&plan, &base, said);
            plan_release(&plan);
        }
    }
    solid_mesh_release(&base);
    print_message("%d edits of %d were legal, in %d sequences\n", legal, sequences * STEPS, sequences);
    assert_true(legal > sequences * STEPS / 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_edits_leave_solids)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
