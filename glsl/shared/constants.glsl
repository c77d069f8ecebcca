// Numbers that shaders and the host must agree on; src/gpu_types.rs reads this file's values in a test.
#ifndef WORSTED_CONSTANTS
#define WORSTED_CONSTANTS

const float PI = 3.14159265358979;
const float TWO_PI = 6.28318530717959;

// Isolines one patch may carry: the smallest maximum tessellation level Vulkan guarantees.
// A yarn with more fibers is drawn as several instances of its patches.
const uint FIBERS_PER_PATCH = 64;

// Levels of detail for which a core fiber's texture is baked.
const uint CORE_LEVELS = 8;

// Radius of point and spot lights in mm: nearer they are as bright as at it.
const float LIGHT_RADIUS = 1.0;

// Largest finite half float, above which a frame's format would hold infinity.
const float RADIANCE_MAX = 65504.0;

// Rest length in mm after which the colours of the length view repeat.
const float LENGTH_STRIPE = 10.0;

// Straight pieces that a piece of yarn is drawn with in the shadow map; two corners at each of their ends, and at
// one more beyond either end of the piece.
const uint TUBE_STEPS = 3;
const uint TUBE_CORNERS = 12;

#endif
