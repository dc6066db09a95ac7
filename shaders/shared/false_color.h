// The colour scale of false-colour views, for shader and legend alike: dark violet over teal to yellow, rising
// evenly in lightness so that it can be read in grey too. sRGB values, 0..1; included by GLSL and by C++.
#ifndef TOUCHSTONE_SHADERS_SHARED_FALSE_COLOR_H
#define TOUCHSTONE_SHADERS_SHARED_FALSE_COLOR_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace touchstone::shared {
using glm::clamp;
using glm::mix;
using glm::vec3;
inline
#endif
    vec3 falseColorAt(float t) {
    const float x = clamp(t, 0.0f, 1.0f) * 4.0f;
    const vec3 c0 = vec3(0.24f, 0.07f, 0.35f);
    const vec3 c1 = vec3(0.20f, 0.30f, 0.55f);
    const vec3 c2 = vec3(0.10f, 0.56f, 0.55f);
    const vec3 c3 = vec3(0.42f, 0.78f, 0.36f);
    const vec3 c4 = vec3(0.99f, 0.91f, 0.22f);
    vec3 c = mix(c0, c1, clamp(x, 0.0f, 1.0f));
    c = mix(c, c2, clamp(x - 1.0f, 0.0f, 1.0f));
    c = mix(c, c3, clamp(x - 2.0f, 0.0f, 1.0f));
    return mix(c, c4, clamp(x - 3.0f, 0.0f, 1.0f));
}

#ifdef __cplusplus
} // namespace touchstone::shared
#endif
#endif
