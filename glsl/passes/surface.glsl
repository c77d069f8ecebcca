// What is seen of fibers at one place of the core texture, and how it is shaded: one path for core fibers
// and single ones (Wu & Yuksel 2019, Sec. 5), whose normals are those of a circle: a layer of the texture that holds
// them, as published, costs two texture reads a pixel.
#ifndef WORSTED_SURFACE
#define WORSTED_SURFACE

#include "bindings.glsl"
#include "../bsdf/khungurn.glsl"
#include "../bsdf/simple.glsl"
#include "../lib/strip.glsl"
#include "../shading/chord_shadow.glsl"
#include "../shading/environment.glsl"
#include "../shading/light.glsl"
#include "../shading/occlusion.glsl"
#include "../shading/self_shadow.glsl"
#include "../shading/sky.glsl"
#include "shadowed.glsl"
#include "../shared/debug_views.glsl"
#include "../yarn/period.glsl"

// Means over what is covered.
struct Surface {
    float coverage;
    float height;  // above the ply's centre, as a share of the round's at the same place across
    float rough;   // deviation of the height
    vec2 slope;    // what migration adds along side and toward, per radian of the texture's turn, as shares of width
                   // and depth
    vec3 spread;   // variances of the slopes, and their covariance
    vec4 normals;  // means of sin phi, cos phi, sin 2 phi, cos 2 phi
};

// The stored means are over all of a texel, covered or not, so that filtering them is right.
Surface surface_of(vec4 normals, vec4 shape, vec4 spread) {
    Surface surface;
    surface.coverage = shape.x;
    float scale = 1.0 / max(shape.x, 1e-4);
    surface.height = shape.y * scale;
    surface.slope = shape.zw * scale;
    vec2 s = surface.slope;
    surface.spread = spread.xyz * scale - vec3(s.x * s.x, s.y * s.y, s.x * s.y);
    surface.spread.xy = max(surface.spread.xy, 0.0);
    surface.rough = sqrt(max(0.0, spread.w * scale - surface.height * surface.height));
    surface.normals = normals * scale;
    return surface;
}

// Means over the places across the strip that a pixel's samples see, by their mean and deviation: two places stand
// for all. Never over more of the strip, however thin it is: other fibers may hide the rest.
vec4 fiber_normals(vec2 across) {
    vec4 below = strip_normals(clamp(across.x - across.y, -1.0, 1.0));
    vec4 above = strip_normals(clamp(across.x + across.y, -1.0, 1.0));
    return 0.5 * (below + above);
}

struct Strand {
    vec3 position;
    vec3 tangent;
    vec3 side;       // unit, perpendicular to the tangent
    vec3 toward;     // unit, perpendicular to both, toward the viewer
    // In the yarn's cross-section along its ply's normal and binormal, as a share of outer_radius: what is seen lies
    // at many depths, and two places stand for them.
    vec2 near_place;
    vec2 far_place;
    float far_share; // of the light that the second stands for
    vec3 ply_normal;
    vec3 ply_binormal;
    uint piece;      // of yarn
    vec3 spread;     // of the tangent
    vec4 normals;
    uint ply;
    uint shown;      // what a debug view shows
};

// Wu & Yuksel 2019, Fig. 4: migration dark, loops green, hairs red; core fibers blue.
const vec3 KIND_COLORS[4] = vec3[4](vec3(0.08), vec3(0.1, 0.75, 0.15), vec3(0.85, 0.08, 0.05), vec3(0.1, 0.2, 0.6));

// Radiance per irradiance below which a fiber is black: a thousandth of what a grey one sends back.
const float LEAST_SCATTERED = 1e-4;
// Below this share of a light nobody looks whether another yarn takes it as well: a five-hundredth of a stop.
const float LEAST_SHARE = 1e-3;

vec4 scattering_entry(uint lobe, uint index) {
    return scattering_table[lobe * yarn.scattering_entries + index];
}

Scattering yarn_scattering() {
    return Scattering(yarn.reflection.rgb, yarn.transmission.rgb, yarn.reflection.a, yarn.transmission.a,
                      yarn.k_tt, yarn.n_tt, yarn.scattering_entries);
}

// Share of light from a direction in the yarn's cross-section that comes through to a place there.
float through_yarn_to(vec2 place, vec2 light) {
    // Every ply sees the others alike: this one stands for ply 0.
    float depth;
    if (CHORD_SHADOW) {
        float scale = 1.0 / yarn.outer_radius;
        Plies plies = Plies(yarn.ply_count, scale * yarn.ply_offset, scale * vec2(yarn.ellipse_short, yarn.ellipse_long),
                            vec2(yarn.ply_cos, yarn.ply_sin));
        depth = chord_depth(self_shadow_table, place, light, plies);
    } else {
        uvec2 size = uvec2(textureSize(self_shadow_table, 0).xz);
        depth = self_shadow_depth(self_shadow_table, self_shadow_place(place, light, yarn.ply_count, size));
    }
    return self_shadow_light(depth, yarn.diffuse.a, min(1.0, length(light)));
}

// Share of the light from `direction` that its own yarn lets through to a fiber.
float through_yarn(Strand strand, vec3 direction) {
    vec2 light = vec2(dot(strand.ply_normal, direction), dot(strand.ply_binormal, direction));
    float near_share = through_yarn_to(strand.near_place, light);
    if (strand.far_share == 0.0) {
        return near_share;
    }
    return mix(near_share, through_yarn_to(strand.far_place, light), strand.far_share);
}

// Share of ambient light that comes through to a place in the yarn's cross-section.
float visible_from(vec2 place) {
    if (TEXTURE_OCCLUSION) {
        return texture_occlusion(occlusion_table, occlusion_place(place, uint(textureSize(occlusion_table, 0).x)));
    }
    return distance_occlusion(yarn.occlusion, length(place));
}

// Share of ambient light that comes through to a fiber.
float visible(Strand strand) {
    if (!DISTANCE_OCCLUSION && !TEXTURE_OCCLUSION) {
        return 1.0;
    }
    return mix(visible_from(strand.near_place), visible_from(strand.far_place), strand.far_share);
}

// A place in the cross-section as a direction out of the yarn.
vec3 outward_at(Strand strand, vec2 place) {
    return place.x * strand.ply_normal + place.y * strand.ply_binormal;
}

// Share of ambient light that comes through to a place in the cross-section and is reflected from there.
float reflected_from(Strand strand, vec2 place) {
    float distance = length(place);
    float facing = dot(strand.toward, outward_at(strand, place)) / max(distance, 1e-6);
    return reflected_occlusion(visible_from(place), yarn.occlusion_lean, distance, facing);
}

// Share of ambient light that comes through to a fiber and is reflected.
float reflected_share(Strand strand) {
    if (!DISTANCE_OCCLUSION && !TEXTURE_OCCLUSION) {
        return 1.0;
    }
    return mix(reflected_from(strand, strand.near_place), reflected_from(strand, strand.far_place), strand.far_share);
}

// What other yarns leave open of the sky, between the piece's two inner control points.
vec4 open_sky(Strand strand) {
    uint first = first_point_of(strand.piece) + 1u;
    vec3 start = control_points[first].position;
    vec3 along = control_points[first + 1u].position - start;
    float share = clamp(dot(strand.position - start, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    vec4 from = vec4(unpackHalf2x16(skies[first].x), unpackHalf2x16(skies[first].y));
    vec4 to = vec4(unpackHalf2x16(skies[first + 1u].x), unpackHalf2x16(skies[first + 1u].y));
    return mix(from, to, share);
}

// Share of a light that neither its own yarn nor another takes from a fiber.
float unshadowed(Strand strand, Light light, vec3 to_light) {
    float share = SELF_SHADOW ? through_yarn(strand, to_light) : 1.0;
    if (SHADOW_MAP && share > LEAST_SHARE && light.shadow_view_count > 0u) {
        float from_center = length(strand.near_place) * yarn.outer_radius;
        share *= shadow_map_light(light, strand.position, from_center, to_light, strand.piece);
    }
    return share;
}

// Radiance toward the eye per irradiance from one direction, its cosine included.
vec3 scatter(Strand strand, vec3 to_light, vec3 to_eye) {
    vec3 sum = vec3(0.0);
    if (DIFFUSE) {
        sum += simple_diffuse(yarn.diffuse.rgb, strand.normals, strand.side, strand.toward, to_light);
    }
    if (SPECULAR) {
        float variance = half_angle_variance(strand.spread, strand.side, strand.toward, to_light, to_eye);
        if (PHYSICAL) {
            vec3 reflected, transmitted;
            // Its Gaussians are of twice the half angle.
            bcsdf_cos(strand.tangent, to_light, to_eye, 4.0 * variance, yarn_scattering(), reflected, transmitted);
            sum += reflected + transmitted;
        } else {
            sum += yarn.specular.rgb
                 * simple_specular_cos(strand.tangent, to_light, to_eye, yarn.specular.a, variance);
        }
    }
    return sum;
}

// Radiance toward the eye of light from everywhere (Wu & Yuksel 2019, Eq. 7 and 8). Where it differs by direction
// each lobe gathers it blurred by the lobe's own width: R from the cone that mirrors the view, TT from behind. What
// comes from behind came through the yarn.
vec3 ambient(Strand strand, vec3 to_eye) {
    vec3 sum = vec3(0.0);
    vec3 reflected_light = frame.ambient_radiance.rgb;
    vec3 transmitted_light = reflected_light;
    vec3 diffuse_light = reflected_light;
    float visibility = reflected_share(strand);
    vec4 sky = vec4(1.0, 0.0, 0.0, 0.0);
    if (YARN_OCCLUSION) {
        sky = open_sky(strand);
        vec2 place = mix(strand.near_place, strand.far_place, strand.far_share);
        visibility *= sky_toward(sky, sky_gathered(strand.toward, outward_at(strand, place)));
    }
    if (ENVIRONMENT) {
        diffuse_light = environment_diffuse(frame.environment, strand.normals, strand.side, strand.toward);
    }
    if (DIFFUSE) {
        // Of constant light from everywhere, the diffuse lobe's integral is its strength.
        sum += yarn.diffuse.rgb * diffuse_light * visibility;
    }
    if (PHYSICAL && SPECULAR) {
        Scattering scattering = yarn_scattering();
        if (ENVIRONMENT) {
            float sine = -dot(strand.tangent, to_eye);
            float width = scattering.beta_r;
            reflected_light = environment_cone(frame.environment, strand.tangent, sine, width * width);
            float width_tt = scattering.beta_tt;
            float variance = 0.5 * (width_tt * width_tt + 1.0 / scattering.k_tt);
            transmitted_light = environment_toward(frame.environment, -to_eye, variance);
        }
        vec3 reflected, transmitted;
        ambient_scattering(strand.tangent, to_eye, scattering, reflected, transmitted);
        float behind = SELF_SHADOW ? through_yarn(strand, -to_eye) : visible(strand);
        if (YARN_OCCLUSION) {
            behind *= sky_toward(sky, -to_eye);
        }
        sum += reflected * reflected_light * visibility + transmitted * transmitted_light * behind;
    }
    return sum;
}

// Radiance toward the eye of one light.
vec3 lit(Strand strand, uint index, vec3 to_eye) {
    Arriving arriving = LOCAL_LIGHTS ? light_at(lights[index], strand.position)
                                     : Arriving(lights[index].toward, lights[index].strength);
    vec3 scattered = scatter(strand, arriving.to_light, to_eye);
    // Most of a yarn faces away from a light: nobody looks there what shadows it.
    bool may_be_shadowed = SELF_SHADOW || SHADOW_MAP;
    if (!may_be_shadowed || max(scattered.r, max(scattered.g, scattered.b)) > LEAST_SCATTERED) {
        return scattered * arriving.irradiance * unshadowed(strand, lights[index], arriving.to_light);
    }
    return vec3(0.0);
}

vec3 shade(Strand strand, vec3 to_eye) {
    vec3 sum = vec3(0.0);
    // Without lights their buffer is not there: src/vulkan/trim.rs takes out what this constant decides. One light
    // needs no loop, which some devices run slowly.
    if (LIGHT_COUNT == 1u) {
        if (frame.light_count > 0u) {
            sum = lit(strand, 0u, to_eye);
        }
    } else if (LIGHT_COUNT > 1u) {
        for (uint i = 0u; i < min(LIGHT_COUNT, frame.light_count); ++i) {
            sum += lit(strand, i, to_eye);
        }
    }
    if (AMBIENT) {
        sum += ambient(strand, to_eye);
    }
    // Close to a light there is no limit. `min` might hide what is no number.
    return mix(sum, vec3(RADIANCE_MAX), greaterThan(sum, vec3(RADIANCE_MAX)));
}

vec3 ply_color(uint ply) {
    return 0.5 + 0.45 * cos(TWO_PI * (float(ply) / float(yarn.ply_count) + vec3(0.0, 1.0, 2.0) / 3.0));
}

// Lets a flat colour show a round fiber.
float rounding(vec3 normal, vec3 to_eye) {
    return 0.35 + 0.65 * max(0.0, dot(normal, to_eye));
}

vec4 strand_color(Strand strand) {
    vec3 to_eye = direction_or(frame.eye_world.xyz - strand.position, vec3(0.0, 0.0, 1.0));
    vec3 normal = strand.normals.x * strand.side + strand.normals.y * strand.toward;
    vec3 color;
    switch (DEBUG_VIEW) {
        case VIEW_NORMAL: color = 0.5 + 0.5 * normal; break;
        case VIEW_TANGENT: color = 0.5 + 0.5 * strand.tangent; break;
        case VIEW_OCCLUSION: color = vec3(visible(strand)); break;
        case VIEW_PLY: color = ply_color(strand.ply); break;
        case VIEW_KIND: color = KIND_COLORS[min(strand.shown, KIND_CORE)] * rounding(normal, to_eye); break;
        case VIEW_FRAME:
        case VIEW_LENGTH:
        case VIEW_LEVEL_OF_DETAIL:
            color = unpackUnorm4x8(strand.shown).rgb * rounding(normal, to_eye);
            break;
        default: color = shade(strand, to_eye); break;
    }
    return vec4(color, 1.0);
}

#endif
