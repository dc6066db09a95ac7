// Random files with nodes, skins, morph targets and instances against the specification, evaluated
// independently.

#include "engine/load/scene_loader.h"
#include "tests/support/gltf_maker.h"
#include "tests/support/pose_truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace touchstone::test {
namespace {

using nlohmann::json;

class RandomFile {
  public:
    explicit RandomFile(uint32_t seed) : random_(seed) {}

    GltfMaker make() {
        const size_t meshes = 1 + below(2);
        for (size_t m = 0; m < meshes; ++m)
            addMesh();
        makeForest(3 + below(10));
        const size_t skins = below(3);
        for (size_t s = 0; s < skins; ++s)
            addSkin();
        for (json& node : maker_.json["nodes"])
            if (chance(0.4))
                showMesh(node);
        if (!maker_.json["nodes"][0].contains("mesh"))
            showMesh(maker_.json["nodes"][0]);
        maker_.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization"};
        return std::move(maker_);
    }

  private:
    size_t below(size_t end) { return random_() % end; }
    bool chance(double p) { return static_cast<double>(random_()) < p * 4294967296.0; }
    double real(double low, double high) {
        return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
    }

    template <class T>
    size_t integers(size_t count, const char* type, double reach, bool normalized) {
        const double most = static_cast<double>(std::numeric_limits<T>::max());
        std::vector<T> values(count);
        for (T& value : values)
            value = static_cast<T>(std::round((std::is_signed_v<T> ? real(-reach, reach) : real(0, reach)) *
                                              (normalized ? most : 5.0)));
        return maker_.addAccessor(values, type, normalized);
    }

    /// `count` numbers of up to `reach` in any type that a displacement may have.
    size_t displacement(size_t count, const char* type, double reach) {
        const bool normalized = chance(0.7);
        switch (below(6)) {
        case 0:
            return integers<int8_t>(count, type, reach, normalized);
        case 1:
            return integers<int16_t>(count, type, reach, normalized);
        case 2:
            return integers<uint8_t>(count, type, reach, true);
        case 3:
            return sparse(count, type, reach);
        default:
            return maker_.addAccessor(floats(count, reach), type);
        }
    }

    std::vector<float> floats(size_t count, double reach) {
        std::vector<float> values(count);
        for (float& value : values)
            value = static_cast<float>(real(-reach, reach));
        return values;
    }

    /// Replaces some elements of zeros, or of other floats.
    size_t sparse(size_t count, const char* type, double reach) {
        const size_t width = static_cast<size_t>(type[3] - '0'), elements = count / width;
        std::vector<uint8_t> which;
        for (size_t i = 0; i < elements && i < 255; ++i)
            if (chance(0.3) || which.empty())
                which.push_back(static_cast<uint8_t>(i));
        const std::vector<float> replaced = floats(which.size() * width, reach);
        const size_t indices = maker_.addView(which.data(), which.size()),
                     values = maker_.addView(replaced.data(), replaced.size() * sizeof(float));
        json accessor = {{"componentType", 5126}, {"count", elements}, {"type", type}};
        if (chance(0.5)) {
            const std::vector<float> all = floats(count, reach);
            accessor["bufferView"] = maker_.addView(all.data(), all.size() * sizeof(float));
        }
        accessor["sparse"] = {{"count", which.size()},
                              {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                              {"values", {{"bufferView", values}}}};
        return maker_.append("accessors", accessor);
    }

    /// A jittered sheet of quads, in one or two primitives with their own attributes and the same targets.
    void addMesh() {
        const size_t targets = below(4), primitives = 1 + below(2);
        json list = json::array();
        for (size_t p = 0; p < primitives; ++p) {
            const size_t side = 2 + below(4), count = side * side;
            std::vector<float> positions, normals;
            std::vector<uint16_t> indices;
            for (size_t i = 0; i < count; ++i) {
                for (const double at : {static_cast<double>(i % side), static_cast<double>(i / side), 0.0})
                    positions.push_back(static_cast<float>(at + real(-0.2, 0.2)));
                for (const double at : {0.0, 0.0, 1.0})
                    normals.push_back(static_cast<float>(at + real(-0.5, 0.5)));
                const auto v = static_cast<uint16_t>(i), next = static_cast<uint16_t>(i + side);
                if (i % side + 1 < side && i / side + 1 < side)
                    for (const int corner : {v + 0, v + 1, next + 0, next + 0, v + 1, next + 1})
                        indices.push_back(static_cast<uint16_t>(corner));
            }
            json attributes = {{"POSITION", maker_.addAccessor(positions, "VEC3")}};
            if (chance(0.7))
                attributes["NORMAL"] = maker_.addAccessor(normals, "VEC3");
            if (chance(0.5))
                attributes["TEXCOORD_0"] = maker_.addAccessor(floats(2 * count, 1.0), "VEC2");
            if (chance(0.5))
                attributes["COLOR_0"] = integers<uint8_t>(4 * count, "VEC4", 1.0, true);
            for (size_t set = 0; chance(set == 0 ? 0.8 : 0.3); ++set)
                addInfluences(count, set, attributes);
            json primitive = {{"attributes", attributes}, {"targets", json::array()}};
            for (size_t t = 0; t < targets; ++t) {
                json target = json::object();
                for (const auto& [name, type, reach] : {std::tuple{"POSITION", "VEC3", 0.1},
                                                        {"NORMAL", "VEC3", 0.2},
                                                        {"TEXCOORD_0", "VEC2", 1.0},
                                                        {"COLOR_0", "VEC4", 1.0}})
                    if (attributes.contains(name) && chance(0.7))
                        target[name] = displacement(count * static_cast<size_t>(type[3] - '0'), type, reach);
                primitive["targets"].push_back(target);
            }
            if (targets == 0)
                primitive.erase("targets");
            if (chance(0.8))
                primitive["indices"] = maker_.addAccessor(indices, "SCALAR");
            list.push_back(primitive);
        }
        json mesh = {{"primitives", list}};
        if (targets > 0 && chance(0.7))
            mesh["weights"] = weights(targets);
        targets_.push_back(targets);
        maker_.append("meshes", mesh);
    }

    /// Joints below kMinJoints, so that every skin has them. Weights of several sets sum to anything
    /// positive.
    void addInfluences(size_t count, size_t set, json& attributes) {
        const bool wide = chance(0.5);
        std::vector<uint8_t> narrowJoints;
        std::vector<uint16_t> wideJoints;
        std::vector<float> weights;
        for (size_t i = 0; i < count; ++i) {
            double sum = 0.0;
            for (size_t k = 0; k < 4; ++k) {
                narrowJoints.push_back(static_cast<uint8_t>(below(kMinJoints)));
                wideJoints.push_back(narrowJoints.back());
                weights.push_back(chance(0.5) ? 0.0f : static_cast<float>(real(0.1, 1.0)));
                sum += static_cast<double>(weights.back());
            }
            if (sum == 0.0)
                weights[4 * i] = 1.0f;
        }
        const std::string suffix = std::to_string(set);
        attributes["JOINTS_" + suffix] =
            wide ? maker_.addAccessor(wideJoints, "VEC4") : maker_.addAccessor(narrowJoints, "VEC4");
        std::vector<uint16_t> shorts;
        std::vector<uint8_t> bytes;
        for (const float weight : weights) {
            shorts.push_back(static_cast<uint16_t>(weight * 65535.0f));
            bytes.push_back(static_cast<uint8_t>(weight * 255.0f));
        }
        attributes["WEIGHTS_" + suffix] = chance(0.5)   ? maker_.addAccessor(weights, "VEC4")
                                          : chance(0.5) ? maker_.addAccessor(shorts, "VEC4", true)
                                                        : maker_.addAccessor(bytes, "VEC4", true);
    }

    json weights(size_t targets) {
        json result = json::array();
        for (size_t t = 0; t < targets; ++t)
            result.push_back(chance(0.3) ? 0.0 : real(-1.0, 1.5));
        return result;
    }

    json numbers(size_t count, double low, double high) {
        json result = json::array();
        for (size_t i = 0; i < count; ++i)
            result.push_back(real(low, high));
        return result;
    }

    json rotation() {
        double q[4], length = 0.0;
        for (double& each : q) {
            each = real(-1.0, 1.0);
            length += each * each;
        }
        json result = json::array();
        for (const double each : q)
            result.push_back(each / std::sqrt(length));
        return result;
    }

    json scale() {
        json result = numbers(3, 0.5, 2.0);
        if (chance(0.2))
            result[below(3)] = -result[0].get<double>();
        return result;
    }

    void makeForest(size_t count) {
        maker_.json["nodes"] = json::array();
        json roots = json::array();
        for (size_t n = 0; n < count; ++n) {
            json node = json::object();
            if (chance(0.1)) {
                node["matrix"] = numbers(16, -1.0, 1.0);
                for (size_t column = 0; column < 4; ++column) {
                    node["matrix"][4 * column + 3] = column == 3 ? 1.0 : 0.0;
                    if (column < 3)
                        node["matrix"][5 * column] = real(1.5, 2.5);
                }
            } else {
                if (chance(0.7))
                    node["translation"] = numbers(3, -2.0, 2.0);
                if (chance(0.7))
                    node["rotation"] = rotation();
                if (chance(0.5))
                    node["scale"] = scale();
            }
            maker_.json["nodes"].push_back(node);
            if (n > 0 && chance(0.8))
                maker_.json["nodes"][below(n)]["children"].push_back(n);
            else if (n == 0 || chance(0.8)) // else outside of the scene
                roots.push_back(n);
        }
        maker_.json["scenes"] = {{{"nodes", roots}}};
    }

    void addSkin() {
        const size_t joints = kMinJoints + below(3);
        json skin = {{"joints", json::array()}};
        std::vector<float> binds;
        for (size_t j = 0; j < joints; ++j) {
            skin["joints"].push_back(below(maker_.json["nodes"].size()));
            for (size_t k = 0; k < 16; ++k)
                binds.push_back(static_cast<float>(k == 15      ? 1.0
                                                   : k % 4 == 3 ? 0.0
                                                   : k % 5 == 0 ? real(0.8, 1.5)
                                                                : real(-0.4, 0.4)));
        }
        if (chance(0.8))
            skin["inverseBindMatrices"] =
                maker_.append("accessors", {{"bufferView", maker_.addView(binds.data(), 4 * binds.size())},
                                            {"componentType", 5126},
                                            {"count", joints},
                                            {"type", "MAT4"}});
        maker_.append("skins", skin);
    }

    void showMesh(json& node) {
        const size_t mesh = below(targets_.size());
        node["mesh"] = mesh;
        if (targets_[mesh] > 0 && chance(0.4))
            node["weights"] = weights(targets_[mesh]);
        if (maker_.json.contains("skins") && chance(0.6))
            node["skin"] = below(maker_.json["skins"].size());
        if (!chance(0.25))
            return;
        const size_t copies = 1 + below(5);
        json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        attributes["TRANSLATION"] = maker_.addAccessor(floats(3 * copies, 4.0), "VEC3");
        if (chance(0.6))
            attributes["ROTATION"] = chance(0.5)   ? integers<int16_t>(4 * copies, "VEC4", 1.0, true)
                                     : chance(0.5) ? integers<int8_t>(4 * copies, "VEC4", 1.0, true)
                                                   : maker_.addAccessor(floats(4 * copies, 1.0), "VEC4");
        if (chance(0.5)) {
            std::vector<float> scales = floats(3 * copies, 1.5);
            for (float& each : scales)
                each += each < 0.0f ? -0.5f : 0.5f;
            attributes["SCALE"] = maker_.addAccessor(scales, "VEC3");
        }
    }

    static constexpr size_t kMinJoints = 3;
    std::mt19937 random_;
    GltfMaker maker_;
    std::vector<size_t> targets_; ///< by mesh
};

TEST(StaticPose, OfRandomFilesIsThatOfTheSpecification) {
    constexpr uint32_t kFiles = 2000;
    PoseDifference worst;
    size_t skinned = 0, morphed = 0, copied = 0, objects = 0;
    for (uint32_t seed = 0; seed < kFiles; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const GltfMaker maker = RandomFile(seed).make();
        const std::vector<TruthObject> truth = evaluatePose({maker.json, {maker.bytes}});
        const ScenePtr scene = loadSceneFromMemory(maker.glb(), ".");
        const PoseDifference off = compare(truth, objectsOf(*scene));
        ASSERT_EQ(off.problem, "");
        ASSERT_LT(off.position, 1e-5L) << off.worst;
        ASSERT_LT(off.normal, 1e-5L) << off.worst;
        ASSERT_LT(off.uv0, 1e-5L) << off.worst;
        ASSERT_LT(off.color, 1e-5L) << off.worst;
        worst.position = std::max(worst.position, off.position);
        worst.normal = std::max(worst.normal, off.normal);
        objects += truth.size();
        for (const Instance& instance : scene->instances) {
            skinned += instance.followsNode ? 0 : 1;
            copied += instance.nodeFromMesh != glm::dmat4(1.0) ? 1 : 0;
        }
        for (const json& mesh : maker.json["meshes"])
            morphed += mesh.contains("weights") ? 1 : 0;
    }
    std::printf("%u files, %zu objects (%zu skinned, %zu copies), %zu meshes with weights: position %.2Le of "
                "the size, "
                "normal %.2Le\n",
                kFiles, objects, skinned, copied, morphed, worst.position, worst.normal);
    EXPECT_GT(skinned, 500u);
    EXPECT_GT(copied, 500u);
    EXPECT_GT(morphed, 500u);
}

} // namespace
} // namespace touchstone::test
