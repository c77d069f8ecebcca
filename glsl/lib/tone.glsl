// From linear radiance to what a display shows; twin: src/math/tone.rs.
#ifndef WORSTED_TONE
#define WORSTED_TONE

// Above this the neutral curve bends; below it is the identity.
const float TONE_KNEE = 0.8;

// Identity up to the knee, then a hyperbola with the same slope that reaches 1 at infinity; scales
// the colour by its largest component, so that hue is kept.
vec3 tone_neutral(vec3 linear) {
    float peak = max(linear.r, max(linear.g, linear.b));
    if (peak <= TONE_KNEE) {
        return max(linear, vec3(0.0));
    }
    float room = 1.0 - TONE_KNEE;
    float bent = 1.0 - room * room / (peak + room - TONE_KNEE);
    return max(linear, vec3(0.0)) * (bent / peak);
}

// Above this the filmic curve is past 1.
const float FILMIC_END = 8.0;

// Narkowicz 2015's fit of ACES' reference and sRGB output transforms, component by component: contrast in the
// middle, highlights that fade to white. 18% grey becomes 0.267, 1.0 becomes 0.804, 7.24 and more becomes 1.
vec3 tone_filmic(vec3 linear) {
    vec3 x = clamp(linear, 0.0, FILMIC_END);
    return min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3(1.0));
}

// The sRGB transfer function (IEC 61966-2-1) of one component in [0, 1].
float srgb_from_linear(float linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

#endif
