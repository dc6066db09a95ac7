#pragma once
// The touched triangle and the contact point, at which attributes and maps are read. For stage 5 only.

#include "haptics/shape/mesh/haptic_object.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/texture/haptic_material.h"

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace touchstone {

/// Everything in the frame of the touched object, lengths in object units unless stated otherwise.
struct SurfaceSpot {
    const HapticObject& object;
    const HapticMaterialData& material;
    Triangle triangle;
    size_t first = 0;               ///< index of the triangle's first corner
    glm::dvec3 weight{0.0};         ///< barycentric
    glm::dvec3 normal{0.0};         ///< unit, of the felt shape, on the outer side
    bool backside = false;          ///< touched from the inner side
    bool smooth = false;            ///< gradients are interpolated between vertices, like normals
    std::array<glm::dvec2, 2> uv{}; ///< texture coordinates of both sets, where present
    double workspacePerObject = 1.0;
    double modelPerObject = 1.0;               ///< metres of the model in one object unit
    const HapticMap::Slopes* slopes = nullptr; ///< precomputed for the height map; null without

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
