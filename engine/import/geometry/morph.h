#pragma once
// Morph targets at their default weights (glTF 2.0, section 3.7.2.2).

#include "engine/import/geometry/vertex_attributes.h"
#include "engine/import/materials/gltf_document.h"

#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The number of morph targets of every mesh of the file; the largest, with a warning, where its primitives
/// differ. Warns of flaws of a target that hold in any pose: displacements without an attribute to displace,
/// and other numbers of vertices.
[[nodiscard]] std::vector<size_t> morphTargetCounts(ImportContext& context, const GltfDocument& document);

/// The weights of a shown mesh of `targets` targets: those of `gltfNode`, else the mesh's own, else none.
/// Weights of targets that do not exist and trailing zeros are left out, so that equal shapes have equal
/// weights. A negative `gltfNode` means no node. Warns where there are more or fewer weights than targets.
/// Spends geometry memory.
[[nodiscard]] std::vector<double> morphWeights(ImportContext& context, const GltfDocument& document,
                                               size_t gltfMesh, size_t targets, int gltfNode);

/// The targets of one primitive that have a weight.
class MorphTargets {
  public:
    /// Missing `weights` are 0.
    MorphTargets(ImportContext& context, const GltfDocument& document, const tinygltf::Primitive& primitive,
                 std::span<const double> weights, const std::string& place);

    /// True if some target with a weight displaces the attribute.
    [[nodiscard]] bool displaces(const std::string& attribute) const;

    /// base += sum of weight * displacement, summed in double. A displacement has as many components as the
    /// base, or fewer: the rest stays (the w of TANGENT). Spends geometry memory. Throws Error for another
    /// number of vertices than the base has and for values that are not finite.
    void displace(const std::string& attribute, RawAttribute& base) const;

  private:
    struct Target {
        size_t index;
        double weight;
    };
    [[nodiscard]] std::string at(size_t target) const;

    ImportContext& context_;
    const GltfDocument& document_;
    const tinygltf::Primitive& primitive_;
    std::string place_;
    std::vector<Target> shown_;
};

} // namespace touchstone
