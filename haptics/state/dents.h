#pragma once
// Local deformation: the places where a surface gives way.

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <memory>

namespace touchstone {

/// The dents that one hand has made, in the frames of the objects. An entry whose depth is 0 is free.
struct Dents {
    static constexpr size_t kMax = 4;
    std::array<int, kMax> object{};        ///< HapticScene::objects
    std::array<glm::dvec3, kMax> centre{}; ///< on the surface at rest, object units
    std::array<glm::dvec3, kMax> normal{}; ///< unit, of that surface, outwards
    std::array<double, kMax> depth{};      ///< workspace m, >= 0

    [[nodiscard]] bool any() const noexcept {
        for (const double d : depth)
            if (d > 0.0)
                return true;
        return false;
    }
};

} // namespace touchstone
