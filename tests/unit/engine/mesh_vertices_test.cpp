// The list of vertex arrays, what is built on it, and the code that once had a list of its own.
#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "engine/scene/clip_mesh.h"
#include "engine/scene/mesh_vertices.h"
#include "engine/scene/tangent_space.h"
#include "tests/support/gltf_maker.h"

#include <gtest/gtest.h>

#include <limits>

namespace touchstone::mesh_vertices_test {
namespace {

using test::GltfMaker;

/// A value that differs between vertices.
void set(float& value, size_t v) {
    value = 0.25f + static_cast<float>(v);
}
template <int N>
void set(glm::vec<N, float>& value, size_t v) {
    value = glm::vec<N, float>(0.25f + static_cast<float>(v));
}

/// Two unit squares side by side whose texture runs outwards from the seam on both, and every vertex array.
Mesh mirroredSquares() {
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    forEachVertexArray(mesh, [](const char*, auto& array) {
        const size_t filled = array.size();
        array.resize(6);
        for (size_t v = filled; v < 6; ++v)
            set(array[v], v);
    });
    mesh.normals.assign(6, {0, 0, 1});
    mesh.tangents.clear();
    mesh.uv0 = {{1, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}};
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    return mesh;
}

TEST(MeshVertices, AVertexIsDuplicatedInEveryArray) {
    Mesh mesh = mirroredSquares();
    mesh.tangents.assign(6, {1, 0, 0, 1});
    EXPECT_EQ(duplicateVertex(mesh, 4), 6u);
    size_t arrays = 0;
    forEachVertexArray(mesh, [&](const char* name, const auto& array) {
        ASSERT_EQ(array.size(), 7u) << name;
        EXPECT_EQ(array[6], array[4]) << name;
        ++arrays;
    });
    EXPECT_EQ(arrays, 10u);
    EXPECT_EQ(meshFault(mesh), std::nullopt);
}

/// The clipping of meshes had a list of its own.
TEST(MeshVertices, ACutMeshHasEveryArray) {
    Mesh mesh = mirroredSquares();
    mesh.tangents.assign(6, {1, 0, 0, 1});
    Mesh cut = clippedMesh(mesh, {1, 0, 0, -0.5}, 1e-9).value(); // x <= 0.5
    EXPECT_EQ(meshFault(cut), std::nullopt);
    size_t arrays = 0;
    forEachVertexArray(mesh, cut, [&](const auto& from, const auto& to) {
        arrays += !from.empty() && to.size() == cut.positions.size();
    });
    EXPECT_EQ(arrays, 10u);
}

TEST(MeshVertices, EmptyArraysStayEmpty) {
    Mesh mesh = mirroredSquares();
    mesh.heights.clear();
    mesh.uv1.clear();
    EXPECT_EQ(bytesPerVertex(mesh), 12u + 12u + 8u + 16u + 3u * 4u);
    (void)duplicateVertex(mesh, 0);
    selectVertices(mesh, std::vector<uint32_t>{6, 5, 1, 1});
    EXPECT_TRUE(mesh.heights.empty());
    EXPECT_TRUE(mesh.uv1.empty());
    EXPECT_EQ(mesh.friction, (std::vector<float>{0.25f, 5.25f, 1.25f, 1.25f}));
    EXPECT_EQ(mesh.positions[1], glm::vec3(1, 1, 0));
}

TEST(MeshVertices, EveryArrayIsChecked) {
    Mesh mesh = mirroredSquares();
    mesh.tangents.assign(6, {1, 0, 0, 1});
    ASSERT_EQ(meshFault(mesh), std::nullopt);
    std::vector<std::string> names;
    forEachVertexArray(mesh, [&](const char* name, const auto&) { names.emplace_back(name); });
    for (const std::string& wrong : names) {
        const auto spoil = [&](auto&& change) {
            Mesh spoiled = mesh;
            forEachVertexArray(spoiled, [&](const char* name, auto& array) {
                if (name == wrong)
                    change(array);
            });
            return meshFault(spoiled).value_or("no fault");
        };
        EXPECT_NE(spoil([](auto& array) { array.pop_back(); }).find("entries for"), std::string::npos)
            << wrong;
        const float nan = std::numeric_limits<float>::quiet_NaN();
        EXPECT_EQ(spoil([&](auto& array) { array[3] *= nan; }), wrong + " of vertex 3 is not finite");
    }
    Mesh beyond = mesh;
    beyond.indices[7] = 6;
    EXPECT_EQ(meshFault(beyond), "index 6 exceeds the last of 6 vertices");
    Mesh line = mesh;
    line.indices.clear();
    line.lineIndices = {0, 6};
    EXPECT_EQ(meshFault(line), "index 6 exceeds the last of 6 vertices");
    line.lineIndices = {0, 1, 2};
    EXPECT_EQ(meshFault(line), "3 indices are no line segments");
    line.lineIndices.clear();
    line.pointIndices = {5, 6};
    EXPECT_EQ(meshFault(line), "index 6 exceeds the last of 6 vertices");
    Mesh odd = mesh;
    odd.indices.pop_back();
    EXPECT_EQ(meshFault(odd), "11 indices are no triangles");
    EXPECT_THROW(checkMesh(odd, "file", "place"), Error);
}

/// Failed: `heights` kept six entries for eight vertices, and the servo read past them.
TEST(MeshVertices, VerticesSplitAtAMirroredSeamKeepAllTheirAttributes) {
    Mesh mesh = mirroredSquares();
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(meshFault(mesh), std::nullopt);
    for (const uint32_t copy : {6u, 7u}) {
        const uint32_t original = mesh.positions[copy].y == 0.0f ? 1 : 4;
        EXPECT_EQ(mesh.heights[copy], mesh.heights[original]);
        EXPECT_EQ(mesh.friction[copy], mesh.friction[original]);
        EXPECT_EQ(mesh.uv1[copy], mesh.uv1[original]);
    }
}

/// The file of the fault: normals, mirrored u, _HEIGHT and a normal map without tangents.
TEST(MeshVertices, AMirroredFileWithHeightsIsConsistent) {
    for (const bool withNormals : {true, false}) {
        GltfMaker maker;
        const size_t positions =
            maker.addAccessor<float>({-1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
        nlohmann::json attributes = {{"POSITION", positions}};
        if (withNormals)
            attributes["NORMAL"] =
                maker.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        attributes["TEXCOORD_0"] = maker.addAccessor<float>({1, 1, 0, 1, 1, 1, 1, 0, 0, 0, 1, 0}, "VEC2");
        attributes["_HEIGHT"] = maker.addAccessor<float>({0, 1, 2, 3, 4, 5}, "SCALAR");
        const size_t indices = maker.addAccessor<uint16_t>({0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}, "SCALAR");
        maker.append("meshes",
                     {{"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}});
        maker.append(
            "images",
            {{"uri", "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGM"
                     "wNjYGAADoAJr5vJ9AAAAAAElFTkSuQmCC"}});
        maker.append("textures", {{"source", 0}});
        maker.append("materials", {{"normalTexture", {{"index", 0}}}});
        maker.show(0);
        const ScenePtr scene = loadSceneFromMemory(maker.glb(), "/nonexistent");
        const Mesh& mesh = scene->meshes[0];
        EXPECT_EQ(mesh.positions.size(), withNormals ? 8u : 12u);
        ASSERT_EQ(mesh.heights.size(), mesh.positions.size());
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            EXPECT_EQ(mesh.heights[v], mesh.positions[v].x + 1.0f + 3.0f * mesh.positions[v].y) << v;
    }
}

} // namespace
} // namespace touchstone::mesh_vertices_test
