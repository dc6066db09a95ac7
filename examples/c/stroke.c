/* An offline stroke: touches a model along a circle and prints the largest force.
 *   cc stroke.c $(pkg-config --cflags --libs touchstone) -lm -o stroke && ./stroke model.glb */
#include <touchstone/touchstone.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(ts_status status) {
    if (status == TS_OK)
        return;
    fprintf(stderr, "%s: %s\n", ts_status_name(status), ts_last_error());
    exit(1);
}

int main(int count, char** arguments) {
    if (count < 2) {
        fprintf(stderr, "usage: stroke MODEL\n");
        return 2;
    }
    ts_scene scene = NULL;
    check(ts_scene_load(arguments[1], NULL, &scene));
    size_t rows = 0;
    check(ts_stroke(scene, "circle", 0, 0, 1000, NULL, 0, &rows));
    double* positions = malloc(3 * rows * sizeof *positions);
    double* force = malloc(3 * rows * sizeof *force);
    if (positions == NULL || force == NULL)
        return 1;
    check(ts_stroke(scene, "circle", 0, 0, 1000, positions, rows, &rows));
    ts_path path = TS_STRUCT(ts_path);
    path.positions = positions;
    path.count = rows;
    ts_ticks ticks = TS_STRUCT(ts_ticks);
    ticks.capacity = rows;
    ticks.force = force;
    check(ts_touch(scene, NULL, &path, &ticks));
    double largest = 0;
    for (size_t i = 0; i < rows; ++i)
        largest = fmax(largest, hypot(hypot(force[3 * i], force[3 * i + 1]), force[3 * i + 2]));
    printf("%zu ticks, at most %.17g N\n", rows, largest);
    free(positions);
    free(force);
    check(ts_scene_close(scene));
    return 0;
}
