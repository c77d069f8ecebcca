// Arguments that the kernels of a piece's turning share.
#ifndef WORSTED_TURNING_KERNEL
#define WORSTED_TURNING_KERNEL

#include "kernel.glsl"
#include "../yarn/turning.glsl"

Turning take_turning() {
    Turning turning;
    turning.places.x = take_float();
    turning.places.y = take_float();
    turning.widths.x = take_float();
    turning.widths.y = take_float();
    turning.swift = take_float();
    return turning;
}

#endif
