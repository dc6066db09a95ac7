// Draco and meshopt streams made with the libraries' own encoders.
#include "tests/support/compressed_gltf.h"
#include "tests/unit/engine/load_support.h"

#include <cmath>

namespace touchstone::compression_test {
namespace {

using test::DracoFile;
using test::dracoFile;
using test::GltfMaker;
using test::load;
using test::meshoptFile;
using test::wave;
using test::Wave;

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
    for (const auto method : {test::DracoMethod::Sequential, test::DracoMethod::Edgebreaker}) {
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
    DracoFile file = dracoFile(wave(6), test::DracoMethod::Edgebreaker);
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
    DracoFile file = dracoFile(wave(4), test::DracoMethod::Sequential);
    file.maker.json["accessors"][2]["count"] = 3;
    EXPECT_REFUSED(file.maker, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression",
                   "triangles, the accessor 3 indices");
    file = dracoFile(wave(4), test::DracoMethod::Sequential);
    file.maker.json["accessors"][0]["count"] = 2;
    EXPECT_REFUSED(file.maker, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression",
                   "vertices, the accessor 2");
    file = dracoFile(wave(4), test::DracoMethod::Sequential);
    file.maker.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 7;
    EXPECT_REFUSED(file.maker, "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.bufferView",
                   "bufferViews[7]");
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
    extensionOf(maker)["byteLength"] = 1.5;
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
} // namespace touchstone::compression_test
