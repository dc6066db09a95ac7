#pragma once
// What a generated file holds: a set of features, and the seed of everything that they leave open.

#include <bitset>
#include <cstdint>
#include <string>

namespace touchstone::test {

// clang-format off
#define TOUCHSTONE_FEATURES(X)                                                                                        \
    /* vertex attributes */                                                                                          \
    X(Normals) X(Tangents) X(Uv0) X(Uv1) X(NormalizedUv) X(MirroredUv) X(CollapsedUv) X(Colors) X(QuantizedGeometry) \
    X(VertexStiffness) X(VertexDamping) X(VertexFriction) X(VertexHeight) X(OtherAttributes)                          \
    /* how accessors are stored */                                                                                   \
    X(Interleaved) X(SharedView) X(Padded) X(Sparse) X(SparseOnly) X(DataUris)                                        \
    /* primitives and geometry */                                                                                    \
    X(NoIndices) X(NarrowIndices) X(Strip) X(Fan) X(PointsAndLines) X(SeveralPrimitives) X(SeveralMeshes)             \
    X(Degenerate) X(NonManifold) X(UnusedVertices) X(OffCentre) X(TinyShape) X(HugeShape) X(NoPositions)              \
    /* nodes */                                                                                                      \
    X(Transforms) X(MatrixNodes) X(Mirrored) X(Uneven) X(Sheared) X(ZeroScale) X(TinyScale) X(HugeScale)              \
    X(DeepNesting) X(Instances) X(OtherScenes) X(NoScene) X(EmptyNodes)                                               \
    /* materials */                                                                                                  \
    X(CoreFactors) X(CoreMaps) X(NormalMap) X(HeightMap) X(FactorMaps) X(HapticFields) X(TextureTransform)            \
    X(Samplers) X(OddImages) X(SeveralMaterials) X(MaterialExtensions) X(Physics) X(Mpeg)                             \
    X(Dents) X(Programs) X(PersistentTextures) X(TextureMapping) X(Bodies)                                           \
    /* motion and deformation */                                                                                     \
    X(Translations) X(Rotations) X(Scales) X(Weights) X(Steps) X(Cubic) X(NormalizedKeys) X(Morph) X(Skin)            \
    X(GpuInstances)                                                                                                   \
    /* the rest of the file */                                                                                       \
    X(Extras) X(UnknownExtensions) X(OddNames)
// clang-format on

enum class Feature : uint8_t {
#define TOUCHSTONE_FEATURE(name) name,
    TOUCHSTONE_FEATURES(TOUCHSTONE_FEATURE)
#undef TOUCHSTONE_FEATURE
        Count
};

inline constexpr size_t kFeatureCount = static_cast<size_t>(Feature::Count);

struct Recipe {
    uint64_t seed = 0;
    std::bitset<kFeatureCount> features;

    [[nodiscard]] bool has(Feature feature) const { return features[static_cast<size_t>(feature)]; }
    void add(Feature feature) { features.set(static_cast<size_t>(feature)); }
    /// "seed 7: Normals Uv0 NormalMap".
    [[nodiscard]] std::string text() const;
};

[[nodiscard]] const char* featureName(Feature feature);

/// The recipe of file `index` of a run: first each feature alone, then random sets of few, some and most of
/// them.
[[nodiscard]] Recipe recipeOf(uint64_t seed, uint64_t index);

} // namespace touchstone::test
