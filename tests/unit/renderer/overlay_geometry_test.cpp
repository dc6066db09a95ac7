#include "renderer/overlay_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

glm::dvec3 mapped(const ShapeInstance& instance, const glm::dvec3& p) {
    const glm::dvec4 q(p, 1.0);
    return {glm::dot(glm::dvec4(instance.eyeFromShape[0]), q),
            glm::dot(glm::dvec4(instance.eyeFromShape[1]), q),
            glm::dot(glm::dvec4(instance.eyeFromShape[2]), q)};
}

TEST(ShapeMeshes, TrianglesFaceTheWayTheirNormalsPoint) {
    const ShapeMeshes meshes = makeShapeMeshes();
    for (const ShapeMeshes::Range& range : meshes.ranges) {
        EXPECT_GT(range.indexCount, 0u);
        for (uint32_t i = range.firstIndex; i < range.firstIndex + range.indexCount; i += 3) {
            const ShapeVertex &a = meshes.vertices[meshes.indices[i]],
                              &b = meshes.vertices[meshes.indices[i + 1]],
                              &c = meshes.vertices[meshes.indices[i + 2]];
            const glm::vec3 area = glm::cross(b.position - a.position, c.position - a.position);
            if (glm::length(area) < 1e-6f)
                continue; // at poles and tips
            EXPECT_GT(glm::dot(area, a.normal + b.normal + c.normal), 0.0f);
        }
        for (const ShapeVertex& vertex : meshes.vertices)
            EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-5f);
    }
}

TEST(LayOut, SphereIsPlacedRelativeToTheEye) {
    Overlay overlay;
    overlay.spheres.push_back({{1.0, 2.0, 3.0}, 0.5, glm::vec4(1.0f)});
    const OverlayDraw draw = layOut(overlay, {1.0, 0.0, 0.0});
    ASSERT_EQ(draw.shapes.size(), 1u);
    EXPECT_NEAR(glm::length(mapped(draw.shapes[0], {0.0, 0.0, 0.0}) - glm::dvec3(0.0, 2.0, 3.0)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(mapped(draw.shapes[0], {0.0, 1.0, 0.0}) - glm::dvec3(0.0, 2.5, 3.0)), 0.0, 1e-6);
}

TEST(LayOut, ArrowEndsAtItsTipInAnyDirection) {
    for (const glm::dvec3 direction :
         {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.3, 0.4, -0.5)}) {
        Overlay overlay;
        const glm::dvec3 from(0.1, 0.2, 0.3), to = from + direction;
        overlay.arrows.push_back({from, to, 0.01, glm::vec4(1.0f)});
        const OverlayDraw draw = layOut(overlay, glm::dvec3(0.0));
        ASSERT_EQ(draw.batches.size(), 2u);
        ASSERT_EQ(draw.batches[0].shape, OverlayShape::Cylinder);
        ASSERT_EQ(draw.batches[1].shape, OverlayShape::Cone);
        EXPECT_NEAR(glm::length(mapped(draw.shapes[0], glm::dvec3(0.0)) - from), 0.0, 1e-6);
        EXPECT_NEAR(glm::length(mapped(draw.shapes[1], {0.0, 1.0, 0.0}) - to), 0.0, 1e-6);
        // The head begins where the shaft ends.
        EXPECT_NEAR(
            glm::length(mapped(draw.shapes[0], {0.0, 1.0, 0.0}) - mapped(draw.shapes[1], glm::dvec3(0.0))),
            0.0, 1e-6);
        const glm::dvec3 rim = mapped(draw.shapes[0], {1.0, 0.0, 0.0});
        EXPECT_NEAR(glm::length(rim - from), 0.01, 1e-6);
        EXPECT_NEAR(glm::dot(rim - from, direction), 0.0, 1e-6);
    }
}

TEST(LayOut, ShortArrowIsAHeadOfItsLength) {
    Overlay overlay;
    overlay.arrows.push_back({{0.0, 0.0, 0.0}, {0.0, 0.002, 0.0}, 0.001, glm::vec4(1.0f)});
    const OverlayDraw draw = layOut(overlay, glm::dvec3(0.0));
    ASSERT_EQ(draw.shapes.size(), 1u);
    EXPECT_NEAR(mapped(draw.shapes[0], {0.0, 0.0, 0.0}).y, 0.0, 1e-9);
    EXPECT_NEAR(mapped(draw.shapes[0], {0.0, 1.0, 0.0}).y, 0.002, 1e-9);
}

TEST(LayOut, DiscLiesAcrossItsNormal) {
    Overlay overlay;
    const glm::dvec3 normal(2.0, -1.0, 0.5);
    overlay.discs.push_back({{0.0, 0.0, 0.0}, normal, 0.3, glm::vec4(1.0f)});
    const OverlayDraw draw = layOut(overlay, glm::dvec3(0.0));
    ASSERT_EQ(draw.shapes.size(), 1u);
    for (const glm::dvec3 edge : {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 0.0, 1.0)}) {
        EXPECT_NEAR(glm::length(mapped(draw.shapes[0], edge)), 0.3, 1e-6);
        EXPECT_NEAR(glm::dot(mapped(draw.shapes[0], edge), normal), 0.0, 1e-6);
    }
}

TEST(LayOut, OpaqueComesFirstAndTranslucentFromTheFarthest) {
    Overlay overlay;
    const glm::vec4 glass(1.0f, 1.0f, 1.0f, 0.5f);
    overlay.spheres.push_back({{0.0, 0.0, -1.0}, 0.1, glass});
    overlay.discs.push_back({{0.0, 0.0, -3.0}, {0.0, 0.0, 1.0}, 0.1, glass});
    overlay.spheres.push_back({{0.0, 0.0, -2.0}, 0.1, glass});
    overlay.spheres.push_back({{0.0, 0.0, -4.0}, 0.1, glm::vec4(1.0f)});
    const OverlayDraw draw = layOut(overlay, glm::dvec3(0.0));
    ASSERT_EQ(draw.batches.size(), 3u);
    EXPECT_FALSE(draw.batches[0].translucent);
    EXPECT_EQ(draw.batches[1].shape, OverlayShape::Disc);
    EXPECT_EQ(draw.batches[2].count, 2u);
    EXPECT_EQ(draw.shapes[draw.batches[2].first].eyeFromShape[2].w, -2.0f);
    EXPECT_EQ(draw.shapes[draw.batches[2].first + 1].eyeFromShape[2].w, -1.0f);
}

TEST(LayOut, LeavesOutWhatHasNoSizeOrIsNotANumber) {
    Overlay overlay;
    overlay.spheres.push_back({{0.0, 0.0, 0.0}, 0.0, glm::vec4(1.0f)});
    overlay.spheres.push_back({glm::dvec3(std::nan("")), 1.0, glm::vec4(1.0f)});
    overlay.arrows.push_back({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.1, glm::vec4(1.0f)});
    overlay.arrows.push_back({{1.0, 0.0, 0.0}, glm::dvec3(INFINITY), 0.1, glm::vec4(1.0f)});
    overlay.discs.push_back({{0.0, 0.0, 0.0}, glm::dvec3(0.0), 1.0, glm::vec4(1.0f)});
    overlay.lines.push_back({glm::dvec3(std::nan("")), glm::dvec3(0.0), glm::vec4(1.0f), 1.0f});
    const OverlayDraw draw = layOut(overlay, glm::dvec3(0.0));
    EXPECT_TRUE(draw.shapes.empty());
    EXPECT_TRUE(draw.batches.empty());
    EXPECT_TRUE(draw.lines.empty());
}

} // namespace
} // namespace touchstone
