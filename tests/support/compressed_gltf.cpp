#include "tests/support/compressed_gltf.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>

namespace touchstone::test {
namespace {

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

} // namespace

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

DracoFile dracoFile(const Wave& wave, DracoMethod method) {
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
    encoder.SetEncodingMethod(method == DracoMethod::Sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                : draco::MESH_EDGEBREAKER_ENCODING);
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

} // namespace touchstone::test
