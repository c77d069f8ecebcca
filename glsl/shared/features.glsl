// Specialization constants: what this pipeline holds. Twin: src/scene/features.rs, `SpecializationId`.
#ifndef WORSTED_FEATURES
#define WORSTED_FEATURES

layout(constant_id = 0) const uint BASIS = 0;            // src/math/curve.rs, `Basis`
layout(constant_id = 1) const bool CULLING = true;
layout(constant_id = 2) const bool DISTANCE_OCCLUSION = true;
layout(constant_id = 3) const bool STATISTICS = false;
layout(constant_id = 4) const bool SPECULAR = true;
layout(constant_id = 5) const bool AMBIENT = true;
layout(constant_id = 6) const uint LIGHT_COUNT = 1;     // of which anything arrives
layout(constant_id = 7) const uint DEBUG_VIEW = 0;       // src/scene/file.rs, `DebugView`
layout(constant_id = 8) const bool FLYAWAYS = true;      // loops or hairs exist
layout(constant_id = 9) const bool CORE_FIBERS = true;  // core fibers stand for some of the fibers
layout(constant_id = 10) const bool LEVEL_OF_DETAIL = true;
layout(constant_id = 11) const uint SAMPLES = 4;        // of a pixel in one frame
layout(constant_id = 12) const bool REGULAR_FIBERS = true; // fibers are drawn one by one
layout(constant_id = 13) const bool LOCAL_LIGHTS = true; // point or spot lights are among them
layout(constant_id = 14) const bool ENVIRONMENT = true; // ambient light differs by direction
layout(constant_id = 15) const bool DIFFUSE = true;
layout(constant_id = 16) const bool PHYSICAL = true;    // Khungurn's lobes, not Wu & Yuksel's simple one
layout(constant_id = 17) const bool SHADOW_MAP = true;  // yarns shadow one another
layout(constant_id = 18) const bool SOFT_SHADOWS = true; // some light spans an angle
layout(constant_id = 19) const bool SELF_SHADOW = true; // light is dimmed inside the yarn
layout(constant_id = 20) const bool TEXTURE_OCCLUSION = false; // ambient light by place, not by distance
layout(constant_id = 21) const bool YARN_OCCLUSION = true; // other yarns hide parts of the sky
layout(constant_id = 22) const bool VERTEX_SHADING = true; // fibers that are thin in the picture are shaded at their vertices
layout(constant_id = 23) const bool AT_VERTICES = false; // this pipeline draws those, and no others
layout(constant_id = 24) const bool CHORD_SHADOW = false; // light is dimmed in the yarn ply by ply, not by place
layout(constant_id = 25) const bool SWIFT_TURNS = true; // pieces of yarn may turn so fast that cuts must follow
layout(constant_id = 26) const bool MOTION_LAYER = false; // in place of light: how what is seen moves
layout(constant_id = 27) const bool ID_LAYER = false;    // and, or, which yarn it is
layout(constant_id = 28) const bool NEIGHBOURS = false;  // the fabric lies elsewhere in the frames before and after

#endif
