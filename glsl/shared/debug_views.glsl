// What fibers may be coloured by; twin: src/scene/file.rs, `DebugView`.
#ifndef WORSTED_DEBUG_VIEWS
#define WORSTED_DEBUG_VIEWS

const uint VIEW_SHADED = 0;
const uint VIEW_NORMAL = 1;
const uint VIEW_TANGENT = 2;
const uint VIEW_OCCLUSION = 3;
const uint VIEW_PLY = 4;
const uint VIEW_KIND = 5;
const uint VIEW_FRAME = 6;
const uint VIEW_LENGTH = 7;
const uint VIEW_LEVEL_OF_DETAIL = 8;

#endif
