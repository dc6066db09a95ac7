// Draco and meshopt streams made with the libraries' own encoders.
#include "tests/unit/engine/load_support.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>

namespace touchstone {
namespace {

using test::GltfMaker;
using test::load;

struct Wave {
    std::vector<glm::vec3> positions, normals;
    std::vector<uint32_t> indices;
};

/// A wavy sheet of n x n squares.
Wave wave(uint32_t n) {
    Wave wave;
    for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i <= n; ++i) {
            const float x = static_cast<float>(i) / static_cast<float>(n),
                        y = static_cast<float>(j) / static_cast<float>(n);
            wave.positions.push_back({x, y, 0.1f * std::sin(6.0f * x)});
            wave.normals.push_back(glm::normalize(glm::vec3(-0.6f * std::cos(6.0f * x), 0.0f, 1.0f)));
        }
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            wave.indices.insert(wave.indices.end(), {a, b, c, a, c, d});
        }
    return wave;
}

struct DracoFile {
    GltfMaker maker;
    size_t view = 0;
};

DracoFile dracoFile(const Wave& wave, int method) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(wave.indices.size() / 3));
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    for (uint32_t f = 0; f < wave.indices.size() / 3; ++f) {
        const uint32_t* v = &wave.indices[3 * f];
        builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), &wave.positions[v[0]],
                                          &wave.positions[v[1]], &wave.positions[v[2]]);
        builder.SetAttributeValuesForFace(normal, draco::FaceIndex(f), &wave.normals[v[0]],
                                          &wave.normals[v[1]], &wave.normals[v[2]]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

    DracoFile file;
    GltfMaker& maker = file.maker;
    maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    file.view = maker.addView(buffer.data(), buffer.size());
    maker.append("accessors",
                 {{"componentType", 5126}, {"count", encoder.num_encoded_points()}, {"type", "VEC3"}});
    maker.append("accessors",
                 {{"componentType", 5126}, {"count", encoder.num_encoded_points()}, {"type", "VEC3"}});
    maker.append("accessors", {{"componentType", 5125}, {"count", wave.indices.size()}, {"type", "SCALAR"}});
    maker.append("meshes",
                 {{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}}}}});
    maker.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.view},
        {"attributes",
         {{"POSITION", mesh->attribute(position)->unique_id()},
          {"NORMAL", mesh->attribute(normal)->unique_id()}}}};
    maker.show(0);
    return file;
}

double area(const Mesh& mesh) {
    double sum = 0.0;
    for (size_t t = 0; t < mesh.triangleCount(); ++t) {
        const auto p = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]); };
        sum += 0.5 * glm::length(glm::cross(p(1) - p(0), p(2) - p(0)));
    }
    return sum;
}

double area(const Wave& wave) {
    Mesh mesh;
    mesh.positions = wave.positions;
    mesh.indices = wave.indices;
    return area(mesh);
}

TEST(Draco, BothMethodsDecodeToTheSameSurface) {
    const Wave sheet = wave(12);
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const ScenePtr scene = load(dracoFile(sheet, method).maker);
        ASSERT_EQ(scene->triangleCount(), sheet.indices.size() / 3);
        const Mesh& mesh = scene->meshes[0];
        EXPECT_NEAR(area(mesh), area(sheet), 1e-9);
        for (size_t v = 0; v < mesh.positions.size();
             ++v) // every vertex lies on the sheet, with the sheet's normal
        {
            const float x = mesh.positions[v].x;
            EXPECT_NEAR(mesh.positions[v].z, 0.1f * std::sin(6.0f * x), 1e-6f);
            EXPECT_NEAR(mesh.normals[v].x, glm::normalize(glm::vec3(-0.6f * std::cos(6.0f * x), 0, 1)).x,
                        1e-5f);
        }
    }
}

TEST(Draco, ABrokenStreamIsRefusedNeverACrash) {
    DracoFile file = dracoFile(wave(6), draco::MESH_EDGEBREAKER_ENCODING);
    const size_t offset = file.maker.json["bufferViews"][file.view]["byteOffset"],
                 size = file.maker.json["bufferViews"][file.view]["byteLength"];
    size_t refused = 0;
    for (size_t i = 0; i < size; ++i) {
        GltfMaker broken = file.maker;
        broken.bytes[offset + i] ^= static_cast<uint8_t>(1 + i % 255);
        try {
            (void)load(broken);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0u);
}

TEST(Draco, CountsMustBeThoseOfTheAccessors) {
    DracoFile file = dracoFile(wave(4), draco::MESH_SEQUENTIAL_ENCODING);
    file.maker.json["accessors"][2]["count"] = 3;
    EXPECT_REFUSED(file.maker, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression",
                   "triangles, the accessor 3 indices");
    file = dracoFile(wave(4), draco::MESH_SEQUENTIAL_ENCODING);
    file.maker.json["accessors"][0]["count"] = 2;
    EXPECT_REFUSED(file.maker, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression",
                   "vertices, the accessor 2");
    file = dracoFile(wave(4), draco::MESH_SEQUENTIAL_ENCODING);
    file.maker.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 7;
    EXPECT_REFUSED(file.maker, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.bufferView",
                   "bufferViews[7]");
}

/// A view that is compressed, over a fallback buffer without bytes.
size_t compressedView(GltfMaker& maker, const std::vector<unsigned char>& stream, size_t count, size_t stride,
                      const char* mode, const char* filter) {
    const size_t source = maker.addView(stream.data(), stream.size());
    const auto& view = maker.json["bufferViews"][source];
    nlohmann::json extension = {{"buffer", 0},
                                {"byteOffset", view["byteOffset"]},
                                {"byteLength", stream.size()},
                                {"byteStride", stride},
                                {"count", count},
                                {"mode", mode}};
    if (filter != nullptr)
        extension["filter"] = filter;
    nlohmann::json made = {{"buffer", 1}, {"byteLength", count * stride}};
    made["extensions"]["EXT_meshopt_compression"] = extension;
    return maker.append("bufferViews", made);
}

template <class Vertex>
std::vector<unsigned char> encodedVertices(const std::vector<Vertex>& vertices) {
    std::vector<unsigned char> stream(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)));
    stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), vertices.data(), vertices.size(),
                                             sizeof(Vertex)));
    return stream;
}

GltfMaker meshoptFile(const Wave& sheet) {
    GltfMaker maker;
    maker.json["extensionsUsed"] =
        maker.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    std::vector<unsigned char> indices(
        meshopt_encodeIndexBufferBound(sheet.indices.size(), sheet.positions.size()));
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), sheet.indices.data(),
                                             sheet.indices.size()));
    std::vector<glm::vec4> four;
    for (const glm::vec3& n : sheet.normals)
        four.push_back(glm::vec4(n, 0.0f));
    std::vector<std::array<int8_t, 4>> octahedral(sheet.normals.size());
    meshopt_encodeFilterOct(octahedral.data(), octahedral.size(), 4, 8, &four[0].x);

    const size_t positionView = compressedView(maker, encodedVertices(sheet.positions),
                                               sheet.positions.size(), 12, "ATTRIBUTES", nullptr);
    const size_t normalView =
        compressedView(maker, encodedVertices(octahedral), octahedral.size(), 4, "ATTRIBUTES", "OCTAHEDRAL");
    const size_t indexView = compressedView(maker, indices, sheet.indices.size(), 4, "TRIANGLES", nullptr);
    maker.append("accessors", {{"bufferView", positionView},
                               {"componentType", 5126},
                               {"count", sheet.positions.size()},
                               {"type", "VEC3"}});
    maker.append("accessors", {{"bufferView", normalView},
                               {"componentType", 5120},
                               {"normalized", true},
                               {"count", sheet.positions.size()},
                               {"type", "VEC3"}});
    maker.json["bufferViews"][normalView]["byteStride"] = 4;
    maker.append("accessors", {{"bufferView", indexView},
                               {"componentType", 5125},
                               {"count", sheet.indices.size()},
                               {"type", "SCALAR"}});
    maker.append("meshes",
                 {{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}}}}});
    maker.show(0);
    nlohmann::json fallback = {{"byteLength", 1'000'000}};
    fallback["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}}, fallback};
    return maker;
}

TEST(Meshopt, AttributesTrianglesAndTheOctahedralFilterDecode) {
    const Wave sheet = wave(10);
    const ScenePtr scene = load(meshoptFile(sheet));
    const Mesh& mesh = scene->meshes[0];
    EXPECT_EQ(mesh.positions, sheet.positions); // lossless
    ASSERT_EQ(mesh.triangleCount(), sheet.indices.size() / 3);
    EXPECT_NEAR(area(mesh), area(sheet), 1e-12);
    for (size_t v = 0; v < sheet.normals.size(); ++v)
        EXPECT_GT(glm::dot(mesh.normals[v], sheet.normals[v]), 0.999f);
}

TEST(Meshopt, MalformedExtensionsAreRefusedByField) {
    const auto extensionOf = [](GltfMaker& maker) -> nlohmann::json& {
        for (auto& view : maker.json["bufferViews"])
            if (view.contains("extensions"))
                return view["extensions"]["EXT_meshopt_compression"];
        return maker.json;
    };
    const std::string place = "bufferViews[1].extensions.EXT_meshopt_compression";
    GltfMaker maker = meshoptFile(wave(3));
    extensionOf(maker)["mode"] = "SOMETHING";
    EXPECT_REFUSED(maker, place + ".mode", "not a mode");
    maker = meshoptFile(wave(3));
    extensionOf(maker)["byteStride"] = 10;
    EXPECT_REFUSED(maker, place, "is not the buffer view's byteLength");
    maker = meshoptFile(wave(3));
    extensionOf(maker)["buffer"] = 5;
    EXPECT_REFUSED(maker, place + ".buffer", "does not exist");
    maker = meshoptFile(wave(3));
    extensionOf(maker)["byteLength"] = 1e9;
    EXPECT_REFUSED(maker, place + ".byteLength", "integer");
    maker = meshoptFile(wave(3));
    extensionOf(maker)["byteLength"] = 1'000'000'000;
    EXPECT_REFUSED(maker, place, "beyond their buffer");
    maker = meshoptFile(wave(3));
    extensionOf(maker)["filter"] = "QUATERNION";
    EXPECT_REFUSED(maker, place + ".filter", "does not fit");
    maker = meshoptFile(wave(3));
    maker.bytes[0] = 0;
    EXPECT_REFUSED(maker, place, "broken");
}

} // namespace
} // namespace touchstone
