#version 460
// Every texel of every mip level and layer of a texture, as the host packs them: levels, layers, rows.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) uniform sampler2DArray picture;
layout(set = 0, binding = 1) writeonly buffer Results { float results[]; };

void main() {
    uint next = 0u;
    for (int level = 0; level < textureQueryLevels(picture); ++level) {
        ivec3 size = textureSize(picture, level);
        for (int layer = 0; layer < size.z; ++layer) {
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    results[next++] = texelFetch(picture, ivec3(x, y, layer), level).r;
                }
            }
        }
    }
}
