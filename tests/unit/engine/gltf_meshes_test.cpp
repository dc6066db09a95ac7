#include "tests/unit/engine/load_support.h"

#include <cmath>
#include <limits>
#include <tuple>

namespace touchstone::gltf_meshes_test {
namespace {

using test::GltfMaker;
using test::load;
using test::warns;

void expectClose(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-6f) {
    EXPECT_NEAR(glm::distance(a, b), 0.0f, tolerance) << a.x << " " << a.y << " " << a.z;
}

glm::vec3 faceNormal(const Mesh& mesh, size_t triangle) {
    const glm::vec3 a = mesh.positions[mesh.indices[3 * triangle]],
                    b = mesh.positions[mesh.indices[3 * triangle + 1]],
                    c = mesh.positions[mesh.indices[3 * triangle + 2]];
    return glm::normalize(glm::cross(b - a, c - a));
}

TEST(GltfMeshes, ASquareComesThroughAsItIs) {
    const ScenePtr scene = load(GltfMaker::square());
    ASSERT_EQ(scene->meshes.size(), 1u);
    const Mesh& mesh = scene->meshes[0];
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(mesh.normalsFromFile);
    EXPECT_EQ(mesh.uv0[1], glm::vec2(1, 1));
    EXPECT_TRUE(mesh.tangents.empty()); // no normal map, no tangents
    EXPECT_EQ(scene->triangleCount(), 2u);
    EXPECT_EQ(scene->materials.size(), 1u); // glTF's default material
    EXPECT_EQ(scene->bounds.low, glm::dvec3(0.0));
    EXPECT_EQ(scene->bounds.high, glm::dvec3(1.0, 1.0, 0.0));
    EXPECT_TRUE(scene->warnings.empty());
}

TEST(GltfMeshes, StripsTurnEveryOtherTriangleRound) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["indices"] = maker.addAccessor<uint8_t>({0, 1, 3, 2}, "SCALAR");
    maker.primitive()["mode"] = 5;
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->triangleCount(), 2u);
    for (size_t t = 0; t < 2; ++t)
        expectClose(faceNormal(scene->meshes[0], t), {0, 0, 1});
}

TEST(GltfMeshes, FansShareTheirFirstVertex) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["indices"] = maker.addAccessor<uint32_t>({0, 1, 2, 3}, "SCALAR");
    maker.primitive()["mode"] = 6;
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->triangleCount(), 2u);
    for (size_t t = 0; t < 2; ++t)
        expectClose(faceNormal(scene->meshes[0], t), {0, 0, 1});
}

/// A stray vertex would decide the frame in which the object is touched, and its tolerances: at a thousand
/// kilometres all triangles welded into one place.
TEST(GltfMeshes, VerticesThatNothingUsesAreDropped) {
    GltfMaker maker;
    const size_t positions =
        maker.addAccessor<float>({1e6f, 0, 0, 0, 0, 0, 5, 5, 5, 1, 0, 0, 0, 1, 0}, "VEC3");
    const size_t normals = maker.addAccessor<float>({1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 1}, "VEC3");
    const size_t indices = maker.addAccessor<uint16_t>({1, 3, 4}, "SCALAR");
    maker.append(
        "meshes",
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}}}}});
    maker.show(0);
    const ScenePtr scene = load(maker);
    const Mesh& mesh = scene->meshes[0];
    ASSERT_EQ(mesh.positions.size(), 3u);
    ASSERT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
}

TEST(GltfMeshes, WithoutIndicesTheVerticesAreTakenInOrder) {
    GltfMaker maker;
    const size_t positions =
        maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3");
    maker.append("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
    maker.show(0);
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->triangleCount(), 2u);
    EXPECT_EQ(scene->bounds.high, glm::dvec3(1.0));
}

TEST(GltfMeshes, MissingNormalsBecomeFlatOnesBySplittingVertices) {
    GltfMaker maker;
    // Two triangles that share an edge and stand at a right angle.
    const size_t positions = maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
    const size_t colors = maker.addAccessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, "VEC3");
    const size_t indices = maker.addAccessor<uint16_t>({0, 1, 2, 0, 3, 1}, "SCALAR");
    maker.append(
        "meshes",
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}, {"indices", indices}}}}});
    maker.show(0);
    const ScenePtr scene = load(maker);
    const Mesh& mesh = scene->meshes[0];
    ASSERT_EQ(mesh.positions.size(), 6u);
    ASSERT_EQ(mesh.normals.size(), 6u);
    EXPECT_FALSE(mesh.normalsFromFile);
    for (size_t i = 0; i < 6; ++i)
        expectClose(mesh.normals[i], faceNormal(mesh, i / 3));
    EXPECT_EQ(mesh.colors[4], glm::vec4(1, 1, 1, 1)); // vertex 3 of the file went along
}

TEST(GltfMeshes, NormalsAreBroughtToUnitLengthAndMended) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["attributes"]["NORMAL"] =
        maker.addAccessor<float>({0, 0, 5, 0, 0, 1, 0, 0, 0, 0, 0, 1}, "VEC3");
    const ScenePtr scene = load(maker);
    for (const glm::vec3& normal : scene->meshes[0].normals)
        expectClose(normal, {0, 0, 1});
    EXPECT_TRUE(warns(*scene, "NORMAL", "not of unit length"));
    EXPECT_TRUE(warns(*scene, "NORMAL", "no direction"));
}

TEST(GltfMeshes, SparseAccessorsReplaceElements) {
    GltfMaker maker = GltfMaker::square();
    const std::vector<uint8_t> which = {1, 2};
    const std::vector<float> instead = {3, 0, 0, 3, 4, 0};
    maker.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", maker.addView(which.data(), 2)}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView(instead.data(), 24)}}}};
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->meshes[0].positions[1], glm::vec3(3, 0, 0));
    EXPECT_EQ(scene->meshes[0].positions[2], glm::vec3(3, 4, 0));
    EXPECT_EQ(scene->meshes[0].positions[3], glm::vec3(0, 1, 0));
}

/// Section 3.6.2.3: what is replaced keeps the stride of its view, the indices and values have none.
TEST(GltfMeshes, SparseAccessorsReplaceElementsOfAStridedView) {
    GltfMaker maker = GltfMaker::square();
    const std::vector<float> strided = {7, 0, 0, 0, 7, 7, 1, 0, 0, 7, 7, 1, 1, 0, 7, 7, 0, 1, 0, 7};
    const std::vector<uint8_t> which = {1, 2};
    const std::vector<float> instead = {3, 0, 0, 3, 4, 0};
    maker.json["accessors"][0]["bufferView"] =
        maker.addView(strided.data(), strided.size() * sizeof(float), 20);
    maker.json["accessors"][0]["byteOffset"] = 4;
    maker.json["accessors"][0]["max"] = {3, 4, 0};
    maker.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", maker.addView(which.data(), 2)}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView(instead.data(), 24)}}}};
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->meshes.at(0).positions,
              (std::vector<glm::vec3>{{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 1, 0}}));
    EXPECT_TRUE(scene->warnings.empty()) << test::warningsOf(*scene);
}

TEST(GltfMeshes, SparseAccessorsWithoutABufferViewStartFromZero) {
    GltfMaker maker = GltfMaker::square();
    const std::vector<uint16_t> which = {1, 3};
    const std::vector<float> instead = {2, 0, 0, 0, 2, 0};
    maker.json["accessors"][0].erase("bufferView");
    maker.json["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", maker.addView(which.data(), 4)}, {"componentType", 5123}}},
        {"values", {{"bufferView", maker.addView(instead.data(), 24)}}}};
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->meshes[0].positions[2], glm::vec3(0.0f));
    EXPECT_EQ(scene->meshes[0].positions[3], glm::vec3(0, 2, 0));
}

TEST(GltfMeshes, SparseIndicesOutOfRangeAreRefused) {
    GltfMaker maker = GltfMaker::square();
    const std::vector<uint8_t> which = {4};
    const std::vector<float> instead = {3, 0, 0};
    maker.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", maker.addView(which.data(), 1)}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView(instead.data(), 12)}}}};
    EXPECT_REFUSED(maker, "accessors[0].sparse.indices", "element 4 of 4");
}

TEST(GltfMeshes, QuantisedAttributesAreDecoded) {
    GltfMaker maker;
    maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const size_t positions = maker.addAccessor<uint16_t>({0, 0, 0, 65535, 0, 0, 0, 32768, 0}, "VEC3", true);
    // Three bytes and one of padding, as the extension asks.
    const std::vector<int8_t> padded = {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -128, 0};
    const size_t normals =
        maker.append("accessors", {{"bufferView", maker.addView(padded.data(), padded.size(), 4)},
                                   {"componentType", 5120},
                                   {"normalized", true},
                                   {"count", 3},
                                   {"type", "VEC3"}});
    const size_t uv = maker.addAccessor<uint16_t>({0, 0, 3, 0, 0, 7}, "VEC2");
    maker.append("meshes",
                 {{"primitives",
                   {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}}}}}}});
    maker.show(0);
    const ScenePtr scene = load(maker);
    const Mesh& mesh = scene->meshes[0];
    expectClose(mesh.positions[1], {1, 0, 0});
    EXPECT_NEAR(mesh.positions[2].y, 32768.0 / 65535.0, 1e-7);
    expectClose(mesh.normals[0], {0, 0, 1});
    expectClose(mesh.normals[2], {0, 0, -1}); // -128 is clamped to -1
    EXPECT_EQ(mesh.uv0[2], glm::vec2(0, 7));  // not normalised: as it is
}

TEST(GltfMeshes, HapticAttributesOfVerticesAreRead) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["attributes"]["_STIFFNESS"] = maker.addAccessor<float>({100, 200, 300, 400}, "SCALAR");
    maker.primitive()["attributes"]["_FRICTION"] =
        maker.addAccessor<float>({0.1f, 0.2f, 0.3f, 0.4f}, "SCALAR");
    maker.primitive()["attributes"]["_DAMPING"] =
        maker.addAccessor<uint8_t>({0, 255, 0, 255}, "SCALAR", true);
    maker.primitive()["attributes"]["_HEIGHT"] =
        maker.addAccessor<float>({-0.001f, 0.0f, 0.002f, 0.0f}, "SCALAR");
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->meshes[0].heights, (std::vector<float>{-0.001f, 0.0f, 0.002f, 0.0f}));
    EXPECT_EQ(scene->meshes[0].stiffness[3], 400.0f);
    EXPECT_EQ(scene->meshes[0].friction[1], 0.2f);
    EXPECT_EQ(scene->meshes[0].damping[1], 1.0f);
    maker.primitive()["attributes"]["_STIFFNESS"] = maker.addAccessor<float>({100, 200, -300, 400}, "SCALAR");
    EXPECT_REFUSED(maker, "meshes[0].primitives[0].attributes._STIFFNESS", "vertex 2 is negative");
}

TEST(GltfMeshes, PlacesThatAreNoNumbersAreRefusedAndDirectionsMended) {
    for (const float broken :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const auto with = [&](const char* attribute, const char* type, int components) {
            GltfMaker maker = GltfMaker::square();
            std::vector<float> values(static_cast<size_t>(4 * components), 0.0f);
            for (size_t i = 0; i < values.size(); ++i)
                values[i] =
                    i % static_cast<size_t>(components) + 1 == static_cast<size_t>(components) ? 1.0f : 0.0f;
            values[static_cast<size_t>(2 * components)] = broken;
            maker.primitive()["attributes"][attribute] = maker.addAccessor<float>(values, type);
            return maker;
        };
        const std::string attributes = "meshes[0].primitives[0].attributes.";
        EXPECT_REFUSED(with("POSITION", "VEC3", 3), attributes + "POSITION", "vertex 2 is not a finite");
        EXPECT_REFUSED(with("_STIFFNESS", "SCALAR", 1), attributes + "_STIFFNESS",
                       "vertex 2 is not a finite");
        for (const auto& [name, type, components] : {std::tuple{"NORMAL", "VEC3", 3},
                                                     {"TANGENT", "VEC4", 4},
                                                     {"TEXCOORD_0", "VEC2", 2},
                                                     {"COLOR_0", "VEC4", 4}}) {
            EXPECT_MENDED(with(name, type, components), attributes + name, "not finite");
            const ScenePtr scene = load(with(name, type, components));
            for (const glm::vec3& normal : scene->meshes[0].normals)
                EXPECT_EQ(normal, glm::vec3(0, 0, 1));
        }
    }
}

TEST(GltfMeshes, IndicesOutOfRangeAreRefusedWithTheirPlace) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["indices"] = maker.addAccessor<uint16_t>({0, 1, 2, 0, 2, 812}, "SCALAR");
    EXPECT_REFUSED(maker, "meshes[0].primitives[0].indices", "index 812 exceeds 3");
    maker.primitive()["indices"] = maker.addAccessor<uint16_t>({0, 1, 65535}, "SCALAR");
    EXPECT_TRUE(warns(*load(maker), "meshes[0].primitives[0].indices", "primitive-restart"));
    maker.primitive()["indices"] = maker.addAccessor<int16_t>({0, 1, 2}, "SCALAR");
    EXPECT_REFUSED(maker, "meshes[0].primitives[0].indices", "unsigned");
}

TEST(GltfMeshes, AttributesMustAgreeInNumberAndShape) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["attributes"]["NORMAL"] = maker.addAccessor<float>({0, 0, 1, 0, 0, 1}, "VEC3");
    EXPECT_MENDED(maker, "meshes[0].primitives[0].attributes.NORMAL", "2 vertices where POSITION has 4");
    maker.primitive()["attributes"]["NORMAL"] = maker.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0}, "VEC2");
    EXPECT_MENDED(maker, "meshes[0].primitives[0].attributes.NORMAL", "2 components");
    EXPECT_FALSE(load(maker)->meshes[0].normalsFromFile);
    maker.primitive()["attributes"]["_DAMPING"] = maker.addAccessor<float>({1, 2}, "SCALAR");
    EXPECT_REFUSED(maker, "meshes[0].primitives[0].attributes._DAMPING", "2 vertices where POSITION has 4");
}

TEST(GltfMeshes, TangentsWithoutHandednessAreComputedAnew) {
    GltfMaker maker = GltfMaker::square();
    const auto tangents = [&](float w) {
        maker.primitive()["attributes"]["TANGENT"] =
            maker.addAccessor<float>({1, 0, 0, 1, 1, 0, 0, w, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
    };
    tangents(0.0f);
    EXPECT_MENDED(maker, "attributes.TANGENT", "1 have a w that is neither 1 nor -1; all are computed anew");
    tangents(-0.9f);
    EXPECT_MENDED(maker, "attributes.TANGENT", "its sign is taken");
}

TEST(GltfMeshes, ARestartValueIsAVertexWhereThereIsOne) {
    GltfMaker maker;
    std::vector<float> places;
    for (int i = 0; i < 256; ++i)
        places.insert(places.end(), {static_cast<float>(i % 16), static_cast<float>(i / 16), 0.0f});
    const size_t positions = maker.addAccessor<float>(places, "VEC3");
    const size_t indices = maker.addAccessor<uint8_t>({0, 1, 255}, "SCALAR");
    maker.append("meshes",
                 {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
    maker.show(0);
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(warns(*scene, "meshes[0].primitives[0].indices", "255")) << test::warningsOf(*scene);
    ASSERT_EQ(scene->triangleCount(), 1u);
    EXPECT_EQ(scene->bounds.high, glm::dvec3(15, 15, 0));
}

/// The triangles as corner places, to be compared however they are indexed.
std::vector<glm::vec3> cornersOf(const Scene& scene) {
    std::vector<glm::vec3> corners;
    for (const uint32_t index : scene.meshes.at(0).indices)
        corners.push_back(scene.meshes[0].positions[index]);
    return corners;
}

template <class T>
void expectRestartsEndPrimitives() {
    constexpr T kEnd = std::numeric_limits<T>::max();
    const auto drawn = [](int mode, const std::vector<T>& indices) {
        GltfMaker maker = GltfMaker::square();
        maker.primitive()["mode"] = mode;
        maker.primitive()["indices"] = maker.addAccessor<T>(indices, "SCALAR");
        return maker;
    };
    constexpr int kList = 4, kStrip = 5, kFan = 6;
    const std::vector<glm::vec3> two = cornersOf(*load(drawn(kList, {0, 1, 2, 1, 2, 3})));
    EXPECT_EQ(two.size(), 6u);
    EXPECT_EQ(cornersOf(*load(drawn(kList, {0, 1, 2, 3, kEnd, 1, 2, 3}))), two);
    // Each part of a strip begins with a triangle that does not turn round, after an odd part and after an
    // even one.
    EXPECT_EQ(cornersOf(*load(drawn(kStrip, {0, 1, 2, kEnd, 1, 2, 3}))), two);
    std::vector<glm::vec3> three = cornersOf(*load(drawn(kList, {0, 1, 2, 1, 3, 2, 1, 2, 3})));
    EXPECT_EQ(cornersOf(*load(drawn(kStrip, {0, 1, 2, 3, kEnd, kEnd, 1, kEnd, 1, 2, 3, kEnd}))), three);
    EXPECT_TRUE(warns(*load(drawn(kStrip, {0, 1, 2, kEnd, 1, 2, 3})), "primitives[0].indices", "restart"));
    EXPECT_REFUSED(drawn(kFan, {0, 1, 2, kEnd, 1, 2, 3}), "meshes[0].primitives[0].indices", "restart");
    EXPECT_REFUSED(drawn(kStrip, {0, 1, 2, kEnd, 1, 2, 9}), "meshes[0].primitives[0].indices", "exceeds 3");
}

TEST(GltfMeshes, ElsewhereARestartValueEndsThePrimitive) {
    expectRestartsEndPrimitives<uint8_t>();
    expectRestartsEndPrimitives<uint16_t>();
    expectRestartsEndPrimitives<uint32_t>();
}

/// Each primitive is a mesh with the name of its own.
TEST(GltfMeshes, NamesArePaidForLikeGeometry) {
    GltfMaker maker = GltfMaker::square();
    maker.json["meshes"][0]["name"] = std::string(1'000'000, 'x');
    maker.json["meshes"][0]["primitives"] = nlohmann::json::array_t(300, maker.primitive());
    EXPECT_TRUE(test::contains(test::loadError(maker).problem(), "the geometry would expand"));
}

TEST(GltfMeshes, TrianglesThatUseAVertexTwiceAreDropped) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["indices"] = maker.addAccessor<uint16_t>({0, 1, 2, 1, 1, 2}, "SCALAR");
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->triangleCount(), 1u);
    EXPECT_TRUE(warns(*scene, "meshes[0].primitives[0]", "1 triangles use a vertex twice"));
}

TEST(GltfMeshes, PointsAndLinesAreReadToBeDrawnAndNotFelt) {
    using Indices = std::vector<uint32_t>;
    struct Case {
        int mode;
        Indices points, lines;
    };
    const std::vector<uint16_t> drawn{0, 1, 1, 2, 3};
    for (const Case& expected : {Case{0, {0, 1, 1, 2, 3}, {}}, Case{1, {}, {0, 1, 1, 2}},
                                 Case{2, {}, {0, 1, 1, 2, 2, 3, 3, 0}}, Case{3, {}, {0, 1, 1, 2, 2, 3}}}) {
        GltfMaker maker = GltfMaker::square();
        maker.primitive()["mode"] = expected.mode;
        maker.primitive()["indices"] = maker.addAccessor<uint16_t>(drawn, "SCALAR");
        maker.primitive()["attributes"].erase("NORMAL");
        const ScenePtr scene = load(maker);
        ASSERT_EQ(scene->meshes.size(), 1u) << expected.mode;
        const Mesh& mesh = scene->meshes[0];
        EXPECT_EQ(mesh.pointIndices, expected.points) << expected.mode;
        EXPECT_EQ(mesh.lineIndices, expected.lines) << expected.mode;
        EXPECT_TRUE(mesh.indices.empty());
        EXPECT_TRUE(mesh.normals.empty()) << "unlit";
        EXPECT_EQ(scene->pointCount(), expected.points.size());
        EXPECT_EQ(scene->lineCount(), expected.lines.size() / 2);
        EXPECT_EQ(scene->bounds.extent(), glm::dvec3(1.0, 1.0, 0.0)) << "the bounds hold what is drawn";
        EXPECT_FALSE(scene->touchable());
        EXPECT_EQ(warns(*scene, "meshes[0]", "no multiple of two"), expected.mode == 1);
        EXPECT_TRUE(warns(*scene, "meshes[0]", "cannot be touched"));
        EXPECT_TRUE(warns(*scene, "", "nothing to touch"));
    }
}

TEST(GltfMeshes, LinesBesideTrianglesLeaveTheSceneTouchable) {
    GltfMaker maker = GltfMaker::square();
    maker.json["meshes"][0]["primitives"].push_back(maker.primitive());
    maker.json["meshes"][0]["primitives"][1]["mode"] = 3;
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->touchable());
    EXPECT_EQ(scene->triangleCount(), 2u);
    EXPECT_EQ(scene->lineCount(), 5u);
    EXPECT_FALSE(warns(*scene, "", "nothing to touch"));
}

TEST(GltfMeshes, ColoursOutsideTheirRangeAreClamped) {
    GltfMaker maker = GltfMaker::square();
    maker.primitive()["attributes"]["COLOR_0"] =
        maker.addAccessor<float>({2, 0, 0, 1, 0, -1, 0, 1, 0, 0, 1, 0.5f, 1, 1, 1, 1}, "VEC4");
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->meshes[0].colors[0], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene->meshes[0].colors[2], glm::vec4(0, 0, 1, 0.5f));
    EXPECT_TRUE(warns(*scene, "COLOR_0", "2 colours"));
}

} // namespace
} // namespace touchstone::gltf_meshes_test
