// Layouts that the shaders and the renderer share: included by GLSL and by C++. Only vec4 and mat4 members, for
// which std140 and C++ agree; tests compare the offsets with those in the compiled SPIR-V.
//
// Frames: `eye` has the workspace's axes and its origin at the eye, so that float positions stay exact however
// far the model is from its own origin.
#ifndef TOUCHSTONE_SHADERS_SHARED_SCENE_TYPES_H
#define TOUCHSTONE_SHADERS_SHARED_SCENE_TYPES_H

#ifdef __cplusplus
#include <cstdint>

#include <glm/glm.hpp>
namespace touchstone::shared {
using glm::mat4;
using glm::vec4;
using glm::uvec4;
using uint = uint32_t;
#define TOUCHSTONE_CONST inline constexpr
#else
#define TOUCHSTONE_CONST const
#endif

/// Once a frame.
struct FrameUniforms {
    mat4 clipFromEye;
    mat4 eyeFromClip;      ///< its inverse
    vec4 toLight0;         ///< xyz unit, workspace axes
    vec4 toLight1;
    vec4 irradiance0;      ///< rgb, exposed
    vec4 irradiance1;
    vec4 irradiance[4];    ///< rgb: irradiance / pi of the surroundings: k0 + k1 x + k2 y + k3 z, exposed; and the grey
    vec4 irradianceSquares;///< k4 xy + k5 yz + k6 zx + k7 x² (k8 y² in irradiance[0].w)
    vec4 irradianceColor[5];///< rgb: k4..k8 of an environment file, which may be of any colour; exposed
    vec4 environment;      ///< of an environment file: factor of its texels, level of its mirror's last blur
    vec4 horizon;          ///< rgb radiance of the sky: horizon + skyRise y, and of the floor: rim - floorFall y; exposed
    vec4 skyRise;
    vec4 rim;
    vec4 floorFall;
    vec4 lampAxis[2];      ///< xyz unit, workspace axes; w: sharpness
    vec4 lampRadiance[2];  ///< rgb, exposed
    vec4 probe;            ///< xyz centre in the eye frame, w 1 / radius: what casts the probe's shadow
    vec4 backgroundTop;    ///< rgb
    vec4 backgroundBottom;
    vec4 image;            ///< width, height in pixels; alpha factor of hidden overlays; workspace metres in a model metre
    vec4 toEye;            ///< the eye lies from p (eye frame) towards xyz - w p: 0, 1 in a perspective, else toViewer, 0
    vec4 toViewer;         ///< xyz unit, workspace axes: opposite of the viewing direction; w: pixels of one nominal
                           ///< pixel, in which lines and points are measured
};

// Slots of textures in a material.
TOUCHSTONE_CONST uint kBaseColorSlot = 0u;
TOUCHSTONE_CONST uint kMetallicRoughnessSlot = 1u;
TOUCHSTONE_CONST uint kNormalSlot = 2u;
TOUCHSTONE_CONST uint kOcclusionSlot = 3u;
TOUCHSTONE_CONST uint kEmissiveSlot = 4u;
TOUCHSTONE_CONST uint kSpecularGlossinessSlot = 5u;
TOUCHSTONE_CONST uint kSpecularSlot = 6u;
TOUCHSTONE_CONST uint kSpecularColorSlot = 7u;
TOUCHSTONE_CONST uint kClearcoatSlot = 8u;
TOUCHSTONE_CONST uint kClearcoatRoughnessSlot = 9u;
TOUCHSTONE_CONST uint kSheenColorSlot = 10u;
TOUCHSTONE_CONST uint kSheenRoughnessSlot = 11u;
TOUCHSTONE_CONST uint kTransmissionSlot = 12u;
TOUCHSTONE_CONST uint kThicknessSlot = 13u;
TOUCHSTONE_CONST uint kTextureSlots = 14u; ///< with the environment 15 samplers; every Vulkan device has 16

/// Once a material. uv' = (dot(linear.xy, uv), dot(linear.zw, uv)) + offset.xy of UV set offset.z.
struct MaterialUniforms {
    vec4 baseColor;
    vec4 emissiveCutoff;   ///< rgb emissive, alpha cutoff
    vec4 factors;          ///< metallic, roughness, normal scale, occlusion strength
    vec4 specularGlossiness;///< rgb reflectance at normal incidence, glossiness
    vec4 dielectric;       ///< rgb reflectance at normal incidence, times the specular colour; specular factor
    vec4 layers;           ///< clearcoat, its roughness, sheen roughness, transmission
    vec4 sheenColorThickness;///< rgb; thickness, mesh metres
    vec4 absorption;       ///< rgb: halvings of the light per metre of the scene
    vec4 uvLinear[14];
    vec4 uvOffset[14];
};

/// Once a material and false-colour view. The map's red channel R and the vertex' scalar s give the position on the
/// colour scale t = (s * (offset + gain * R)) * scale + shift. Where the tilt is shown, gain is the height map's in model
/// metres and offset the normal map's scale; where one colour is, it is offset, gain, scale.
struct FalseColorUniforms {
    vec4 map;              ///< offset, gain, scale, shift
    vec4 uvLinear;
    vec4 uvOffset;
};

/// Once an instance whose material has a haptic program: the rows of the affine map from vertices to the program's frame,
/// and those of the map of normals.
struct ProgramObjectUniforms {
    vec4 programFromMesh[3];
    vec4 normalFromMesh[3];
    vec4 material;         ///< static and dynamic friction, stiffness N/m, damping N s/m
    uvec4 texels;          ///< persistent texture: width (0: none), height, its first float
    vec4 persistent;       ///< x: the value where there is no texture
};

/// Push constants, once an object: the rows of the affine map eyeFromMesh, and those of its cofactor matrix,
/// which takes normals (its w of the first row: -1 where the object is mirrored, else 1; of the second: scene metres of a
/// mesh metre; of the third with kIsClipped: 1 where the object is filled).
struct ObjectConstants {
    vec4 eyeFromMesh[3];
    vec4 normalFromMesh[3];
    vec4 clip;             ///< with kIsClipped: what is drawn lies where dot(clip, (p, 1)) <= 0, eye frame
};

// What a material needs; the pipelines are specialised on these bits, so that what it lacks costs nothing.
TOUCHSTONE_CONST uint kHasBaseColorTexture = 1u;
TOUCHSTONE_CONST uint kHasMetallicRoughnessTexture = 2u;
TOUCHSTONE_CONST uint kHasNormalTexture = 4u;
TOUCHSTONE_CONST uint kHasOcclusionTexture = 8u;
TOUCHSTONE_CONST uint kHasEmissiveTexture = 16u;
TOUCHSTONE_CONST uint kHasEmission = 32u;
TOUCHSTONE_CONST uint kHasVertexColor = 64u;
TOUCHSTONE_CONST uint kHasTangents = 128u;
TOUCHSTONE_CONST uint kHasUvTransform = 256u;      ///< any texture is transformed or uses the second UV set
TOUCHSTONE_CONST uint kSharesOcclusion = 512u;     ///< occlusion is R of the metallic-roughness sample
TOUCHSTONE_CONST uint kIsMasked = 1024u;
TOUCHSTONE_CONST uint kIsBlended = 2048u;
TOUCHSTONE_CONST uint kHasSecondLight = 4096u;
TOUCHSTONE_CONST uint kHasProbeShadow = 8192u;

TOUCHSTONE_CONST uint kIsUnlit = 16384u;
TOUCHSTONE_CONST uint kIsMetallic = 32768u;        ///< it may reflect so much that multiple scattering counts
TOUCHSTONE_CONST uint kHasSpecularGlossiness = 65536u;
TOUCHSTONE_CONST uint kHasSpecularGlossinessTexture = 131072u;
TOUCHSTONE_CONST uint kHasSpecular = 262144u;      ///< KHR_materials_ior or KHR_materials_specular
TOUCHSTONE_CONST uint kHasSpecularTextures = 524288u;
TOUCHSTONE_CONST uint kHasClearcoat = 1048576u;
TOUCHSTONE_CONST uint kHasClearcoatTextures = 2097152u;
TOUCHSTONE_CONST uint kHasSheen = 4194304u;
TOUCHSTONE_CONST uint kHasSheenTextures = 8388608u;
TOUCHSTONE_CONST uint kIsTransmissive = 16777216u; ///< always with kIsBlended
TOUCHSTONE_CONST uint kHasVolume = 33554432u;
TOUCHSTONE_CONST uint kHasTransmissionTextures = 67108864u;
TOUCHSTONE_CONST uint kHasEnvironment = 134217728u;
TOUCHSTONE_CONST uint kIsSolid = 268435456u;       ///< with kIsBlended: its alpha is 1 all the same (it transmits)
TOUCHSTONE_CONST uint kIsLines = 536870912u;
TOUCHSTONE_CONST uint kIsPoints = 1073741824u;
TOUCHSTONE_CONST uint kIsClipped = 2147483648u;

// Views of false_color.frag.
TOUCHSTONE_CONST uint kShowsMap = 0u;
TOUCHSTONE_CONST uint kShowsNormals = 1u;
TOUCHSTONE_CONST uint kShowsUv = 2u;
TOUCHSTONE_CONST uint kShowsTilt = 3u;
TOUCHSTONE_CONST uint kShowsFlat = 4u;

#ifdef __cplusplus
} // namespace touchstone::shared
#endif
#endif
