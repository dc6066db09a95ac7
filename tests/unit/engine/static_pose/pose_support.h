#pragma once
// Skinned, morphed and instanced files made in memory, and their comparison with the specification.

#include "tests/support/pose_truth.h"
#include "tests/unit/engine/load_support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <numbers>

namespace touchstone::test {

/// Largest difference of a pose from the specification, in sizes of the scene and as a unit normal.
inline constexpr double kPoseTolerance = 1e-5;

/// Times of 0 and 1 s for an animation.
inline size_t addTimes(GltfMaker& maker) {
    const size_t times = maker.addAccessor<float>({0.0f, 1.0f}, "SCALAR");
    maker.json["accessors"][times]["min"] = nlohmann::json::array({0.0});
    maker.json["accessors"][times]["max"] = nlohmann::json::array({1.0});
    return times;
}

inline TruthFile truthFile(const GltfMaker& maker) {
    return {maker.json, {maker.bytes}};
}

/// A box 1 x 2 x 1 m from (0, 0, 0), `rings` quads high, whose vertices follow joint 0 below and joint 1
/// above, by weights linear in y. Corners have normals of their own. Mesh 0; shown by node 0 with skin 0,
/// whose joints are nodes 1 and 2 (a child of 1, 1 m above it), with inverse binds that undo them.
struct Beam {
    explicit Beam(size_t rings = 4) {
        std::vector<float> positions, normals, weights;
        std::vector<uint8_t> joints;
        std::vector<uint16_t> indices;
        const float side[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                    out[4][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
        for (size_t s = 0; s < 4; ++s)
            for (size_t r = 0; r <= rings; ++r)
                for (size_t end = 0; end < 2; ++end) {
                    const float* at = side[(s + end) % 4];
                    const float y = 2.0f * static_cast<float>(r) / static_cast<float>(rings);
                    positions.insert(positions.end(), {at[0], y, at[1]});
                    normals.insert(normals.end(), {out[s][0], 0.0f, out[s][1]});
                    joints.insert(joints.end(), {0, 1, 0, 0});
                    weights.insert(weights.end(), {1.0f - 0.5f * y, 0.5f * y, 0.0f, 0.0f});
                    const auto first = static_cast<uint16_t>(positions.size() / 3 - 1);
                    if (r < rings && end == 0)
                        for (const int corner : {0, 2, 1, 1, 2, 3})
                            indices.push_back(static_cast<uint16_t>(first + corner));
                }
        attributes["POSITION"] = maker.addAccessor(positions, "VEC3");
        maker.json["accessors"][0]["min"] = {0.0, 0.0, 0.0};
        maker.json["accessors"][0]["max"] = {1.0, 2.0, 1.0};
        attributes["NORMAL"] = maker.addAccessor(normals, "VEC3");
        attributes["JOINTS_0"] = maker.addAccessor(joints, "VEC4");
        attributes["WEIGHTS_0"] = maker.addAccessor(weights, "VEC4");
        vertices = positions.size() / 3;
        maker.append("meshes",
                     {{"primitives",
                       {{{"attributes", attributes}, {"indices", maker.addAccessor(indices, "SCALAR")}}}}});
        maker.show(0);
        maker.json["nodes"][0]["skin"] = 0;
        maker.append("nodes", {{"children", {2}}});
        maker.append("nodes", {{"translation", {0.0, 1.0, 0.0}}});
        maker.json["scenes"][0]["nodes"].push_back(1);
        maker.append("skins", {{"joints", {1, 2}},
                               {"inverseBindMatrices",
                                matrices({glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0, -1, 0})})}});
    }

    size_t matrices(const std::vector<glm::mat4>& list) {
        const size_t view = maker.addView(list.data(), list.size() * sizeof(glm::mat4));
        return maker.append(
            "accessors",
            {{"bufferView", view}, {"componentType", 5126}, {"count", list.size()}, {"type", "MAT4"}});
    }

    nlohmann::json& primitiveAttributes() { return maker.primitive()["attributes"]; }
    nlohmann::json& node(size_t index) { return maker.json["nodes"][index]; }
    /// Turns the upper joint about z, so that the beam bends.
    void bend(double angle) {
        node(2)["rotation"] = {0.0, 0.0, std::sin(0.5 * angle), std::cos(0.5 * angle)};
    }

    GltfMaker maker;
    nlohmann::json attributes;
    size_t vertices = 0;
};

/// Loads the file and holds it to the specification. Returns the scene.
inline ScenePtr expectPose(const GltfMaker& maker) {
    const ScenePtr scene = load(maker);
    const PoseDifference off = compare(evaluatePose(truthFile(maker)), objectsOf(*scene));
    EXPECT_EQ(off.problem, "");
    EXPECT_LT(off.position, kPoseTolerance) << off.worst;
    EXPECT_LT(off.normal, kPoseTolerance) << off.worst;
    EXPECT_LT(off.uv0, kPoseTolerance) << off.worst;
    EXPECT_LT(off.color, kPoseTolerance) << off.worst;
    return scene;
}

} // namespace touchstone::test
