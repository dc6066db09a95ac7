// Feeds the importer bytes that are nearly glTF. It may refuse them with an Error; it may not crash, hang,
// throw anything else, or make a scene that breaks what scene.h promises.
#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "tests/support/scene_promises.h"

#include <cstdio>
#include <cstdlib>

namespace touchstone {
namespace {

/// True if it loaded.
bool loadAndCheck(const uint8_t* data, size_t size) {
    try {
        // A folder without files: no URI of a mutant finds anything.
        const ScenePtr scene = loadSceneFromMemory({data, data + size}, "/nonexistent");
        if (const auto broken = test::brokenPromise(*scene)) {
            std::fprintf(stderr, "scene breaks its promise: %s\n", broken->c_str());
            std::abort();
        }
        return true;
    } catch (const Error&) {
        return false;
    }
}

} // namespace
} // namespace touchstone

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    (void)touchstone::loadAndCheck(data, size);
    return 0;
}

#ifndef TOUCHSTONE_LIBFUZZER
#include "tests/support/compressed_gltf.h"
#include "tests/support/gltf_maker.h"

#include <gtest/gtest.h>

#include <random>

namespace touchstone {
namespace {

using nlohmann::json;
using test::GltfMaker;

/// A skinned and morphed square on a node of its own, and three copies of it on another.
void addPoses(GltfMaker& maker) {
    json mesh = maker.json["meshes"][0];
    json& primitive = mesh["primitives"][0];
    primitive["attributes"]["JOINTS_0"] =
        maker.addAccessor<uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1}, "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = maker.addAccessor<uint8_t>(
        {255, 0, 0, 0, 100, 155, 0, 0, 0, 255, 0, 0, 55, 100, 50, 50}, "VEC4", true);
    primitive["targets"] = {
        {{"POSITION", maker.addAccessor<int8_t>({0, 0, 9, 0, 0, -9, 1, 1, 1, 0, 0, 0}, "VEC3", true)},
         {"NORMAL", maker.addAccessor<float>({0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3")}},
        {{"TEXCOORD_0", maker.addAccessor<float>({0, 1, 0, 0, 0, 1, 0, 1}, "VEC2")}}};
    mesh["weights"] = {0.5, 1.0};
    const std::vector<float> binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                      2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    const size_t view = maker.addView(binds.data(), binds.size() * sizeof(float));
    const size_t matrices = maker.append(
        "accessors", {{"bufferView", view}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
    maker.append("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", matrices}});
    const size_t posed = maker.show(maker.append("meshes", mesh));
    maker.json["nodes"][posed]["skin"] = 0;
    const size_t copied = maker.show(1);
    maker.json["nodes"][copied]["weights"] = {0.0, -1.0};
    maker.json["nodes"][copied]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}, "VEC3")},
        {"ROTATION", maker.addAccessor<int16_t>({0, 0, 0, 32767, 0, 1, 0, 0, 9, 9, 9, 9}, "VEC4", true)},
        {"SCALE", maker.addAccessor<float>({1, 1, 1, 2, -1, 1, 1, 1, 3}, "VEC3")}};
}

/// One file that uses much of what the importer can read.
GltfMaker richFile() {
    GltfMaker maker = GltfMaker::square();
    maker.json["images"] = {
        {{"uri",
          "data:image/"
          "png;base64,"
          "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGMwNjYGAADoAJr5vJ9AAAAAAElFTkSuQmCC"}}};
    maker.json["textures"] = {{{"source", 0}}};
    json material = {
        {"normalTexture", {{"index", 0}}},
        {"pbrMetallicRoughness", {{"roughnessFactor", 0.5}, {"baseColorTexture", {{"index", 0}}}}}};
    material["extensions"]["TOUCHSTONE_materials_haptic"] = {
        {"stiffness", 500}, {"heightTexture", {{"index", 0}, {"scale", 0.001}}}};
    maker.json["materials"] = {material};
    maker.primitive()["material"] = 0;
    maker.primitive()["attributes"]["COLOR_0"] = maker.addAccessor<uint8_t>(
        {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 9}, "VEC4", true);
    maker.primitive()["attributes"]["_STIFFNESS"] = maker.addAccessor<float>({1, 2, 3, 4}, "SCALAR");
    const std::vector<uint8_t> which = {1};
    const std::vector<float> instead = {3, 0, 0};
    maker.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", maker.addView(which.data(), 1)}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView(instead.data(), 12)}}}};
    const size_t times = maker.addAccessor<float>({0, 1, 2}, "SCALAR"),
                 moves = maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3");
    maker.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", moves}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    maker.json["nodes"].push_back({{"children", json::array({2})}, {"rotation", {0, 0, 0, 1}}});
    maker.json["nodes"].push_back({{"mesh", 0}, {"scale", {1, -1, 2}}});
    maker.json["scenes"][0]["nodes"].push_back(1);
    const size_t turns = maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 2}, "VEC4");
    maker.json["animations"][0]["samplers"].push_back({{"input", times}, {"output", turns}});
    maker.json["animations"][0]["channels"].push_back(
        {{"sampler", 1}, {"target", {{"node", 1}, {"path", "rotation"}}}});
    maker.json["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    maker.json["textures"][0]["sampler"] = 0;
    json strip = maker.primitive();
    strip["mode"] = 5;
    strip["indices"] = maker.addAccessor<uint8_t>({0, 1, 2, 255, 0, 2, 3}, "SCALAR");
    maker.json["meshes"][0]["primitives"].push_back(strip);
    maker.json["extensionsUsed"] = {"MPEG_material_haptic", "KHR_physics_rigid_bodies"};
    maker.json["extensions"]["MPEG_material_haptic"] = {
        {{"stiffness", {{{"texture", {{"index", 0}}}, {"type", "High_Resolution"}}}}}};
    maker.json["meshes"][0]["extensions"]["MPEG_material_haptic"] = 0;
    maker.json["extensions"]["KHR_physics_rigid_bodies"]["physicsMaterials"] = {{{"staticFriction", 0.9}}};
    maker.json["nodes"][0]["extensions"]["KHR_physics_rigid_bodies"]["collider"]["physicsMaterial"] = 0;
    addPoses(maker);
    return maker;
}

/// Deterministic: the same mutants on every machine.
struct Random {
    explicit Random(unsigned seed) : generator(seed) {}
    unsigned operator()() { return static_cast<unsigned>(generator()); }
    std::mt19937 generator;
};

/// Every value of a JSON, to be changed at random.
void collect(json& value, std::vector<json*>& into) {
    into.push_back(&value);
    if (value.is_structured())
        for (json& child : value)
            collect(child, into);
}

const std::vector<json>& strangeValues() {
    static const std::vector<json> kStrange = {0,
                                               1,
                                               -1,
                                               2,
                                               3,
                                               5,
                                               255,
                                               5121,
                                               5123,
                                               5125,
                                               5126,
                                               65535,
                                               1e9,
                                               2147483647,
                                               4294967295u,
                                               9007199254740991,
                                               18446744073709551615ull,
                                               -9223372036854775807,
                                               0.5,
                                               -0.0,
                                               1e-300,
                                               1e300,
                                               2.0,
                                               nullptr,
                                               true,
                                               "",
                                               "VEC2",
                                               "MAT4",
                                               "SCALAR",
                                               "translation",
                                               "CUBICSPLINE",
                                               "../x",
                                               "data:,",
                                               json::array(),
                                               json::object(),
                                               {0, 0, 0},
                                               {{"index", 0}}};
    return kStrange;
}

json strangeValue(Random& random) {
    return strangeValues()[random() % strangeValues().size()];
}

class GltfFuzz : public testing::TestWithParam<unsigned> {};

TEST(GltfFuzzSeed, Loads) {
    const std::vector<uint8_t> seed = richFile().glb();
    EXPECT_TRUE(loadAndCheck(seed.data(), seed.size()))
        << "mutants of a file that is refused anyway test little";
}

/// What is mended and left out makes more paths than chance finds: each value once as each strange one, and
/// gone.
TEST(GltfFuzzSeed, EveryValueReplacedByEveryStrangeOne) {
    GltfMaker maker = richFile();
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}}};
    std::vector<json*> values;
    collect(maker.json, values);
    size_t loaded = 0, tried = 0;
    const auto tryIt = [&] {
        const std::vector<uint8_t> bytes = maker.glb();
        loaded += loadAndCheck(bytes.data(), bytes.size()) ? 1 : 0;
        ++tried;
    };
    for (size_t i = 1; i < values.size(); ++i)
        for (const json& strange : strangeValues()) {
            json kept = strange;
            values[i]->swap(kept);
            tryIt();
            values[i]->swap(kept);
        }
    for (json* value : values) {
        if (!value->is_object())
            continue;
        std::vector<std::string> names;
        for (const auto& [name, unused] : value->items())
            names.push_back(name);
        for (const std::string& name : names) {
            // The node itself, as `values` points into it.
            auto& members = value->get_ref<json::object_t&>();
            auto kept = members.extract(name);
            tryIt();
            members.insert(std::move(kept));
        }
    }
    EXPECT_GT(loaded, tried / 4);
    EXPECT_LT(loaded, tried);
}

TEST_P(GltfFuzz, StrangeValuesInTheJson) {
    Random random(GetParam());
    size_t loaded = 0;
    for (int round = 0; round < 500; ++round) {
        GltfMaker maker = richFile();
        maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}}};
        for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
            std::vector<json*> values;
            collect(maker.json, values);
            *values[1 + random() % (values.size() - 1)] = strangeValue(random); // the root stays an object
        }
        const std::vector<uint8_t> bytes = maker.glb();
        loaded += loadAndCheck(bytes.data(), bytes.size()) ? 1 : 0;
    }
    EXPECT_GT(loaded, 0u);
    EXPECT_LT(loaded, 500u);
}

TEST_P(GltfFuzz, ChangedBytes) {
    Random random(GetParam() + 1000);
    const std::vector<uint8_t> seed = richFile().glb();
    size_t loaded = 0;
    for (int round = 0; round < 500; ++round) {
        std::vector<uint8_t> bytes = seed;
        for (unsigned changes = 1 + random() % 8; changes > 0; --changes) {
            const size_t at = random() % bytes.size();
            switch (random() % 4) {
            case 0:
                bytes[at] = static_cast<uint8_t>(random());
                break;
            case 1:
                bytes[at] ^= static_cast<uint8_t>(1u << random() % 8);
                break;
            case 2:
                bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            default:
                bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), static_cast<uint8_t>(random()));
                break;
            }
        }
        loaded += loadAndCheck(bytes.data(), bytes.size()) ? 1 : 0;
    }
    EXPECT_LT(loaded, 500u);
}

TEST_P(GltfFuzz, ChangedBinary) {
    Random random(GetParam() + 2000);
    size_t loaded = 0;
    for (int round = 0; round < 500; ++round) {
        GltfMaker maker = richFile();
        for (unsigned changes = 1 + random() % 16; changes > 0; --changes)
            maker.bytes[random() % maker.bytes.size()] = static_cast<uint8_t>(random());
        const std::vector<uint8_t> bytes = maker.glb();
        loaded += loadAndCheck(bytes.data(), bytes.size()) ? 1 : 0;
    }
    EXPECT_GT(loaded, 0u);
}

TEST_P(GltfFuzz, ChangedStreamsOfCompressedFiles) {
    Random random(GetParam() + 3000);
    const test::Wave sheet = test::wave(5);
    const GltfMaker seeds[] = {test::dracoFile(sheet, test::DracoMethod::Sequential).maker,
                               test::dracoFile(sheet, test::DracoMethod::Edgebreaker).maker,
                               test::meshoptFile(sheet)};
    for (const GltfMaker& seed : seeds) {
        size_t loaded = 0;
        for (int round = 0; round < 200; ++round) {
            GltfMaker maker = seed;
            for (unsigned changes = random() % 5; changes > 0; --changes)
                maker.bytes[random() % maker.bytes.size()] = static_cast<uint8_t>(random());
            const std::vector<uint8_t> bytes = maker.glb();
            loaded += loadAndCheck(bytes.data(), bytes.size()) ? 1 : 0;
        }
        EXPECT_GT(loaded, 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, GltfFuzz, testing::Range(1u, 6u));

} // namespace
} // namespace touchstone
#endif
