// Reads what shading/chord_shadow.glsl knows of a yarn from a row of arguments.
#ifndef WORSTED_TEST_PLIES
#define WORSTED_TEST_PLIES

Plies take_plies() {
    Plies plies;
    plies.count = take_uint();
    plies.offset = take_float();
    plies.axes.x = take_float();
    plies.axes.y = take_float();
    plies.turn.x = take_float();
    plies.turn.y = take_float();
    return plies;
}

#endif
