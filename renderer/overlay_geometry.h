#pragma once
// Converts an Overlay to instances of four unit shapes, and lines. Pure; any thread.

#include "renderer/overlay.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace touchstone {

/// Sphere: radius 1 about the origin. Cylinder: radius 1, from y = 0 to 1. Cone: base at y = 0 with radius 1,
/// tip at y = 1. Disc: radius 1 in the plane y = 0. Outsides are counter-clockwise.
enum class OverlayShape : uint8_t { Sphere, Cylinder, Cone, Disc };
inline constexpr size_t kShapeCount = 4;

struct ShapeVertex {
    glm::vec3 position, normal;
};

struct ShapeMeshes {
    struct Range {
        uint32_t firstIndex = 0, indexCount = 0;
    };
    std::vector<ShapeVertex> vertices;
    std::vector<uint16_t> indices;
    std::array<Range, kShapeCount> ranges;
};
[[nodiscard]] ShapeMeshes makeShapeMeshes();

/// Rows of the affine map eyeFromShape (eye frame: workspace axes, origin at the eye), and the colour.
struct ShapeInstance {
    std::array<glm::vec4, 3> eyeFromShape;
    glm::vec4 color;
};

struct LineInstance {
    glm::vec4 from; ///< eye frame; w: width in pixels
    glm::vec4 to;
    glm::vec4 color;
};

/// `batches` are in drawing order: opaque ones first, then translucent ones from the farthest to the nearest.
/// Items with a non-finite value, or without size, are left out.
struct OverlayDraw {
    struct Batch {
        OverlayShape shape = OverlayShape::Sphere;
        bool translucent = false;
        uint32_t first = 0, count = 0;
    };
    std::vector<ShapeInstance> shapes;
    std::vector<Batch> batches;
    std::vector<LineInstance> lines; ///< the first `shownHidden` also where the scene hides them
    uint32_t shownHidden = 0;
};
[[nodiscard]] OverlayDraw layOut(const Overlay& overlay, const glm::dvec3& eye);

} // namespace touchstone
