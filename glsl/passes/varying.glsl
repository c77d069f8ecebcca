// What the fragment stage of single fibers reads of each vertex. The stages before it write no more: what these decide is
// taken out of all of them (src/vulkan/trim.rs).
#ifndef WORSTED_VARYING
#define WORSTED_VARYING

#include "../shared/features.glsl"
#include "../shared/debug_views.glsl"

// The place in the yarn's cross-section.
const bool READS_PLACE = !AT_VERTICES
    && (SELF_SHADOW || SHADOW_MAP || DISTANCE_OCCLUSION || TEXTURE_OCCLUSION || YARN_OCCLUSION);
// The ply's normal and binormal.
const bool READS_PLY_FRAME = !AT_VERTICES
    && (SELF_SHADOW || DISTANCE_OCCLUSION || TEXTURE_OCCLUSION || YARN_OCCLUSION);
// The fiber, what a debug view shows of it, and its piece of yarn.
const bool READS_FIBER = !AT_VERTICES && (SHADOW_MAP || YARN_OCCLUSION || DEBUG_VIEW != VIEW_SHADED);

#endif
