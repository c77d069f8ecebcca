#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    Piece piece = take_packed();
    give_words(packed_extent(piece, take_packed()));
}
