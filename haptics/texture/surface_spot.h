#pragma once
// The touched triangle with its contact point: what attributes and maps are read at. For stage 5 only.

#include "haptics/shape/mesh/haptic_object.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/texture/haptic_material.h"

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace touchstone {

/// Everything in the frame of the touched object, lengths in object units unless said otherwise.
struct SurfaceSpot {
    const HapticObject& object;
    const HapticMaterialData& material;
    Triangle triangle;
    size_t first = 0;               ///< index of the triangle's first corner
    glm::dvec3 weight{0.0};         ///< barycentric
    glm::dvec3 normal{0.0};         ///< unit, of the felt shape, on the outer side
    bool backside = false;          ///< touched from the inner side
    bool smooth = false;            ///< gradients are interpolated between vertices, as normals are
    std::array<glm::dvec2, 2> uv{}; ///< texture coordinates of both sets, where there are such
    double workspacePerObject = 1.0;
    double modelPerObject = 1.0;               ///< metres of the model in one object unit
    const HapticMap::Slopes* slopes = nullptr; ///< kept for the height map, where they are wanted and there

    [[nodiscard]] uint32_t source(size_t corner) const { return object.sourceIndices[first + corner]; }
    [[nodiscard]] double attribute(const std::vector<float>& values, double otherwise) const {
        if (values.empty())
            return otherwise;
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
            sum += weight[k] * static_cast<double>(values[source(static_cast<size_t>(k))]);
        return sum;
    }
    [[nodiscard]] bool hasUv(int set) const { return !object.uv[set & 1].empty(); }
    [[nodiscard]] glm::dvec2 uvAt(int set, size_t corner) const {
        return glm::dvec2(object.uv[set & 1][source(corner)]);
    }
};

} // namespace touchstone
