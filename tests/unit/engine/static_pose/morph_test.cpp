// Morph targets at their default weights, against the specification evaluated independently.
#include "tests/unit/engine/static_pose/pose_support.h"

namespace touchstone::morph_test {
namespace {

using namespace test;

const char* const kPrimitive = "meshes[0].primitives[0]";

/// The unit square with two targets: one lifts it to a bump, one shears it; normals with them.
GltfMaker morphedSquare() {
    GltfMaker maker = GltfMaker::square();
    const size_t lift = maker.addAccessor<float>({0, 0, 0.5f, 0, 0, 0.25f, 0, 0, 1, 0, 0, 0}, "VEC3"),
                 lean = maker.addAccessor<float>({0.3f, 0, 0, 0, 0.4f, 0, 0, 0, 0, -0.2f, 0, 0}, "VEC3"),
                 shear = maker.addAccessor<float>({0, 0, 0, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 0.25f, 0}, "VEC3");
    maker.primitive()["targets"] = {{{"POSITION", lift}, {"NORMAL", lean}}, {{"POSITION", shear}}};
    return maker;
}

TEST(Morph, WeightsAreTheNodesElseTheMeshsElseNone) {
    GltfMaker maker = morphedSquare();
    EXPECT_TRUE(expectPose(maker)->warnings.empty());
    maker.json["meshes"][0]["weights"] = {0.5, 1.0};
    maker.show(0);
    maker.json["nodes"][1]["weights"] = {-0.25, 2.0};
    maker.json["nodes"][1]["translation"] = {3.0, 0.0, 0.0};
    maker.show(0);
    maker.json["nodes"][2]["weights"] = {0.5, 1.0}; // the mesh's own
    maker.json["nodes"][2]["translation"] = {6.0, 0.0, 0.0};
    const ScenePtr scene = expectPose(maker);
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message;
    EXPECT_EQ(scene->meshes.size(), 2u) << "equal weights share a mesh";
}

TEST(Morph, WithoutNormalsTheFlatOnesAreThoseOfTheMorphedShape) {
    GltfMaker maker = morphedSquare();
    maker.json["meshes"][0]["weights"] = {1.0, 0.5};
    maker.primitive()["attributes"].erase("NORMAL");
    const ScenePtr scene = expectPose(maker);
    EXPECT_TRUE(warns(*scene, std::string(kPrimitive) + ".targets[0].NORMAL", "does not have"));
    EXPECT_GT(glm::length(glm::vec2(scene->meshes[0].normals[0])), 0.1f);
}

TEST(Morph, DisplacesCoordinatesAndColours) {
    GltfMaker maker = morphedSquare();
    maker.primitive()["attributes"]["COLOR_0"] = maker.addAccessor<uint8_t>(
        {255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 128, 128, 128, 0}, "VEC4", true);
    maker.primitive()["targets"][0]["TEXCOORD_0"] =
        maker.addAccessor<float>({1, 0, 0, 1, 0.5f, 0.5f, 0, 0}, "VEC2");
    maker.primitive()["targets"][1]["COLOR_0"] = maker.addAccessor<int8_t>(
        {-127, 127, 0, 0, 127, 127, 127, 0, 0, 0, -64, 0, 10, 20, 30, 127}, "VEC4", true);
    maker.json["meshes"][0]["weights"] = {0.5, 0.75};
    const ScenePtr scene = expectPose(maker);
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message;
    EXPECT_NEAR(scene->meshes[0].uv0[0].x, 0.5f, 1e-6f);
    EXPECT_NEAR(scene->meshes[0].colors[0].y, 0.75f, 1e-6f);
}

TEST(Morph, TakesEveryTypeOfDisplacement) {
    const auto withType = [](auto sample, bool normalized) {
        using T = decltype(sample);
        GltfMaker maker = morphedSquare();
        std::vector<T> values;
        for (int i = 0; i < 12; ++i)
            values.push_back(static_cast<T>((std::is_signed_v<T> ? 1 - 2 * (i % 2) : 1) * 9 * i));
        maker.primitive()["targets"][0]["POSITION"] = maker.addAccessor(values, "VEC3", normalized);
        maker.json["meshes"][0]["weights"] = {0.125};
        maker.json["extensionsUsed"] = {"KHR_mesh_quantization"};
        const ScenePtr scene = expectPose(maker);
        EXPECT_TRUE(warns(*scene, "meshes[0].weights", "1 weights for 2 morph targets"));
    };
    for (const bool normalized : {false, true}) {
        withType(int8_t{}, normalized);
        withType(uint8_t{}, normalized);
        withType(int16_t{}, normalized);
        withType(uint16_t{}, normalized);
    }
    withType(float{}, false);
}

TEST(Morph, TakesSparseDisplacements) {
    GltfMaker maker = morphedSquare();
    const std::vector<uint16_t> which = {1, 3};
    const std::vector<float> moved = {0, 0, 2, 0.5f, 0, 1};
    const size_t indices = maker.addView(which.data(), 4), values = maker.addView(moved.data(), 24);
    const nlohmann::json sparse = {{"count", 2},
                                   {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                   {"values", {{"bufferView", values}}}};
    const size_t alone = maker.append(
        "accessors", {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}, {"sparse", sparse}});
    nlohmann::json over = maker.json["accessors"][maker.primitive()["targets"][0]["POSITION"].get<size_t>()];
    over["sparse"] = sparse;
    maker.primitive()["targets"][0]["POSITION"] = maker.append("accessors", over);
    maker.primitive()["targets"][1]["POSITION"] = alone;
    maker.json["meshes"][0]["weights"] = {0.5, 0.25};
    expectPose(maker);
}

TEST(Morph, DisplacesTangentsAndKeepsTheirHand) {
    GltfMaker maker = morphedSquare();
    maker.primitive()["attributes"]["TANGENT"] =
        maker.addAccessor<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    maker.primitive()["targets"][0]["TANGENT"] =
        maker.addAccessor<float>({0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1}, "VEC3");
    maker.append("images", {{"uri", "nowhere.png"}});
    maker.append("textures", {{"source", 0}});
    maker.append("materials", {{"normalTexture", {{"index", 0}}}});
    maker.primitive()["material"] = 0;
    maker.json["meshes"][0]["weights"] = {1.0};
    const ScenePtr scene = expectPose(maker);
    const Mesh& mesh = scene->meshes[0];
    ASSERT_TRUE(mesh.tangentsFromFile);
    const float half = std::sqrt(0.5f);
    EXPECT_NEAR(glm::distance(mesh.tangents[0], glm::vec4(half, half, 0, -1)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(mesh.tangents[2], glm::vec4(half, 0, half, 1)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(mesh.tangents[3], glm::vec4(half, 0, -half, 1)), 0.0f, 1e-6f);
}

TEST(Morph, CountsThatDoNotMatch) {
    GltfMaker many = morphedSquare();
    many.json["nodes"][0]["weights"] = {0.5, 0.5, 7.0};
    EXPECT_TRUE(
        warns(*expectPose(many), "nodes[0].weights", "3 weights for 2 morph targets; the rest is ignored"));
    GltfMaker none = GltfMaker::square();
    none.json["meshes"][0]["weights"] = {1.0};
    EXPECT_TRUE(warns(*expectPose(none), "meshes[0].weights", "1 weights for 0 morph targets"));
    GltfMaker uneven = morphedSquare();
    uneven.json["meshes"][0]["primitives"].push_back(uneven.primitive());
    uneven.json["meshes"][0]["primitives"][1].erase("targets");
    uneven.json["meshes"][0]["weights"] = {0.5, 0.5};
    EXPECT_TRUE(
        warns(*expectPose(uneven), "meshes[0].primitives[1].targets", "0 morph targets where another"));
}

/// More flaws than an import remembers: looked for again in every pose, those beyond would count twice.
TEST(Morph, TargetsAreCheckedOnceHoweverManyPosesTheyAreShownIn) {
    constexpr size_t kTargets = 70'000;
    GltfMaker maker = morphedSquare();
    const nlohmann::json coordinates = {{"TEXCOORD_1", maker.primitive()["attributes"]["TEXCOORD_0"]}};
    maker.primitive()["targets"] = nlohmann::json::array_t(kTargets, coordinates);
    maker.json["meshes"][0]["weights"] = {1.0};
    for (const double weight : {0.25, 0.5, 0.75})
        maker.json["nodes"][maker.show(0)]["weights"] = {weight};
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->meshes.size(), 4u);
    EXPECT_TRUE(warns(*scene, std::string(kPrimitive) + ".targets[0].TEXCOORD_1",
                      "ignored (also meshes[0].primitives[0].targets[1].TEXCOORD_1, "
                      "meshes[0].primitives[0].targets[2].TEXCOORD_1, "
                      "meshes[0].primitives[0].targets[3].TEXCOORD_1 and " +
                          std::to_string(kTargets - 4) + " more)"))
        << test::warningsOf(*scene);
}

TEST(Morph, BrokenTargetsAreRefusedWhereTheyAreShown) {
    const std::string place = std::string(kPrimitive) + ".targets[1].POSITION";
    const auto broken = [](const std::vector<float>& values) {
        GltfMaker maker = morphedSquare();
        maker.primitive()["targets"][1]["POSITION"] = maker.addAccessor(values, "VEC3");
        return maker;
    };
    GltfMaker few = broken({0, 0, 1});
    EXPECT_TRUE(warns(*load(few), place, "where its weight is 0, it is ignored"));
    few.json["meshes"][0]["weights"] = {0.0, 1.0};
    EXPECT_REFUSED(few, place, "has 1 vertices where the attribute has 4");
    GltfMaker nan = broken({0, 0, 0, 0, NAN, 0, 0, 0, 0, 0, 0, 0});
    nan.json["meshes"][0]["weights"] = {0.0, 1.0};
    EXPECT_REFUSED(nan, place, "vertex 1 is not a finite number");
    GltfMaker far = morphedSquare();
    far.json["meshes"][0]["weights"] = {0.0, 1e300};
    EXPECT_REFUSED(far, std::string(kPrimitive) + ".attributes.POSITION", "is not a finite number");
    // What does not change the shape is left out: here normals that are fewer than their displacements.
    GltfMaker normals = morphedSquare();
    normals.primitive()["attributes"]["NORMAL"] = normals.addAccessor<float>({0, 0, 1}, "VEC3");
    normals.json["meshes"][0]["weights"] = {1.0, 0.0};
    EXPECT_TRUE(warns(*load(normals), std::string(kPrimitive) + ".attributes.NORMAL", "it is left out"));
    normals = morphedSquare();
    normals.primitive()["targets"][0]["NORMAL"] = normals.addAccessor<float>({0, 0, 1}, "VEC3");
    normals.json["meshes"][0]["weights"] = {1.0, 0.0};
    EXPECT_TRUE(warns(*load(normals), std::string(kPrimitive) + ".targets[0].NORMAL", "it is left out"));
    GltfMaker missing = morphedSquare();
    missing.primitive()["targets"][1]["POSITION"] = 99;
    EXPECT_REFUSED(missing, place, "refers to accessors[99]");
    GltfMaker type = morphedSquare();
    type.primitive()["targets"] = 3;
    EXPECT_REFUSED(type, std::string(kPrimitive) + ".targets", "should be an array");
    GltfMaker word = morphedSquare();
    word.json["nodes"][0]["weights"] = {"all"};
    EXPECT_REFUSED(word, "nodes[0].weights", "should be a number");
}

TEST(Morph, AnimatedWeightsBeginInTheStaticPose) {
    GltfMaker maker = morphedSquare();
    maker.json["meshes"][0]["weights"] = {0.5, 0.25};
    const size_t times = addTimes(maker), weights = maker.addAccessor<float>({0, 0, 1, 1}, "SCALAR");
    maker.append("animations",
                 {{"samplers", {{{"input", times}, {"output", weights}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    const ScenePtr scene = expectPose(maker);
    EXPECT_TRUE(scene->warnings.empty()) << warningsOf(*scene);
    EXPECT_NE(scene->meshes[0].deformation, nullptr);
}

TEST(Morph, ManyTargetsOfLittleDataAreBounded) {
    GltfMaker maker;
    constexpr size_t kVertices = 300'000;
    const size_t zeros =
        maker.append("accessors", {{"componentType", 5126}, {"count", kVertices}, {"type", "VEC3"}});
    nlohmann::json targets = nlohmann::json::array(), weights = nlohmann::json::array();
    for (int t = 0; t < 1000; ++t) {
        targets.push_back({{"POSITION", zeros}});
        weights.push_back(1.0);
    }
    maker.append("meshes", {{"primitives", {{{"attributes", {{"POSITION", zeros}}}, {"targets", targets}}}},
                            {"weights", weights}});
    maker.show(0);
    const Error error = loadError(maker);
    EXPECT_TRUE(contains(error.problem(), "the geometry would expand")) << error.what();
}

} // namespace
} // namespace touchstone::morph_test
