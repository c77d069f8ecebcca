// Light from everywhere, as real spherical harmonics up to order 2; twin: src/precompute/environment.rs.
//
// Coefficients go with 1, x, y, z, xy, yz, zx, 3 y^2 - 1, x^2 - z^2 (Y is up), norms included. Order 2 rings:
// radiance can come out below 0 opposite a bright window, and is 0 then.
#ifndef WORSTED_ENVIRONMENT
#define WORSTED_ENVIRONMENT

// Mean over directions whose mean is `first`, with mean products `squares` (xx, yy, zz, of sum 1) and
// `products` (xy, yz, zx); bands 1 and 2 are multiplied by `bands`.
vec3 environment_mean(vec4 environment[9], vec3 first, vec3 squares, vec3 products, vec2 bands) {
    vec3 one = environment[1].rgb * first.x + environment[2].rgb * first.y + environment[3].rgb * first.z;
    vec3 two = environment[4].rgb * products.x + environment[5].rgb * products.y + environment[6].rgb * products.z
             + environment[7].rgb * (2.0 * squares.y - squares.x - squares.z)
             + environment[8].rgb * (squares.x - squares.z);
    return max(environment[0].rgb + bands.x * one + bands.y * two, vec3(0.0));
}

// Mean of irradiance / pi over normals in a fiber's cross-section, given as in glsl/bsdf/simple.glsl by the
// means of sin phi, cos phi, sin 2 phi, cos 2 phi. Irradiance is a quadratic form of the normal (Ramamoorthi &
// Hanrahan 2001, Eq. 11 to 13), hence linear in these means: one normal or a core's many, nothing more is lost.
vec3 environment_diffuse(vec4 environment[9], vec4 normals, vec3 side, vec3 toward) {
    vec3 first = normals.x * side + normals.y * toward;
    float sine_squared = 0.5 - 0.5 * normals.w;
    float cosine_squared = 0.5 + 0.5 * normals.w;
    vec3 squares = sine_squared * side * side + cosine_squared * toward * toward + normals.z * side * toward;
    vec3 products = sine_squared * side * side.yzx + cosine_squared * toward * toward.yzx
                  + 0.5 * normals.z * (side * toward.yzx + side.yzx * toward);
    return environment_mean(environment, first, squares, products, vec2(2.0 / 3.0, 0.25));
}

// Radiance in a unit direction, blurred by a Gaussian of `variance` (radians squared, along each axis): what
// a forward lobe gathers. The blur is the heat kernel's, exp(-l (l + 1) variance / 2) in band l.
vec3 environment_toward(vec4 environment[9], vec3 direction, float variance) {
    vec2 bands = vec2(exp(-variance), exp(-3.0 * variance));
    return environment_mean(environment, direction, direction * direction, direction * direction.yzx, bands);
}

// Mean radiance over the circle of directions whose angle to the cross-section of a fiber with unit `tangent`
// has sine `sin_theta`, blurred likewise: what a lobe gathers that is the same all around the fiber. Averaging
// over the circle multiplies band l by P_l(sin theta) (Funk-Hecke).
vec3 environment_cone(vec4 environment[9], vec3 tangent, float sin_theta, float variance) {
    vec2 legendre = vec2(sin_theta, 1.5 * sin_theta * sin_theta - 0.5);
    vec2 bands = legendre * vec2(exp(-variance), exp(-3.0 * variance));
    return environment_mean(environment, tangent, tangent * tangent, tangent * tangent.yzx, bands);
}

#endif
