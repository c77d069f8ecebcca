// How much of the sky other yarns leave open; twin: src/precompute/sky.rs.
#ifndef WORSTED_SKY
#define WORSTED_SKY

// Share of the sky that is open toward a unit direction or, of a mean of directions, around it. `sky` is a constant
// and a slope by direction.
float sky_toward(vec4 sky, vec3 direction) {
    return clamp(sky.x + dot(sky.yzw, direction), 0.0, 1.0);
}

// Mean of the directions from which a fiber gathers light that it reflects: R's azimuthal lobe, cos(phi / 2) about the
// unit vector `toward` the viewer across the fiber, has a third of it; its yarn leaves a fiber at the rim, at
// `outward` = 1, the half toward there, and with that two thirds. `outward` is the place in the cross-section, from
// the yarn's centre, as a share of the outer radius.
vec3 sky_gathered(vec3 toward, vec3 outward) {
    return (toward + outward) / 3.0;
}

#endif
