// Directional albedos in closed form: what a lobe reflects, over all directions, of a uniform surrounding. Fits to
// their integrals, which tests/unit/renderer/closed_forms_test.cpp works out again; included by GLSL and by C++.
#ifndef TOUCHSTONE_SHADERS_SHARED_CLOSED_FORMS_H
#define TOUCHSTONE_SHADERS_SHARED_CLOSED_FORMS_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace touchstone::shared {
using glm::clamp;
using glm::exp;
using glm::min;
using glm::sqrt;
#define TOUCHSTONE_FORM inline
#else
#define TOUCHSTONE_FORM
#endif

/// Of GGX with F = 1 and Hammon's visibility (scene.frag's lobe). nv in 0..1. Its single scattering loses up to 70 % at
/// roughness 1; dividing by this gives that back (Turquin, "Practical multiple scattering compensation for
/// microfacet models", 2019). Within 6 % for roughness 0.2..1 and nv 0.08..1; 1 for a mirror.
TOUCHSTONE_FORM float ggxAlbedo(float nv, float roughness) {
    const float s = sqrt(nv), r = roughness;
    const float c0 = 3.7370f + r * (-11.0502f + r * 7.3456f);
    const float c1 = -4.8545f + r * (25.0931f - r * 19.5706f);
    const float c2 = -2.5620f + r * (-10.2551f + r * 13.0616f);
    const float c3 = 3.1403f + r * (-1.8402f - r * 1.5424f);
    return clamp(1.0f - r * (c0 + s * (c1 + s * (c2 + s * c3))), 0.25f, 1.0f);
}

/// Of KHR_materials_sheen's lobe: the Charlie distribution (Estevez and Kulla, 2017) with Ashikhmin's visibility.
/// Within 0.04 for roughness 0.1..1; cut at 1, which the lobe itself exceeds at grazing angles.
TOUCHSTONE_FORM float sheenAlbedo(float nv, float roughness) {
    const float t = 1.0f / (roughness + 0.2f);
    const float c0 = -1.1180f + t * (0.6535f + t * 0.0169f);
    const float c1 = -2.2500f + t * (2.2099f - t * 1.7041f);
    const float c2 = 2.8699f + t * (-4.3147f + t * 1.4859f);
    return min(exp(c0 + nv * (c1 + nv * c2)), 1.0f);
}

#ifdef __cplusplus
} // namespace touchstone::shared
#endif
#undef TOUCHSTONE_FORM
#endif
