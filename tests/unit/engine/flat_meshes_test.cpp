// The answer of the mesh reader is read like any file: nothing in it is believed.
#include "engine/import/mesh_file/flat_glb.h"
#include "tests/support/mesh_files.h"
#include "tests/support/scene_promises.h"
#include "tests/unit/engine/load_support.h"

#include <cmath>
#include <limits>
#include <random>

namespace touchstone::flat_meshes_test {
namespace {

using test::append;
using test::Bytes;
using test::contains;

/// Two meshes of one triangle each; the second has all arrays.
struct Answer {
    uint32_t magic = kFlatMagic, materials = 1, meshes = 2, material = 0, vertices = 3, triangles = 1,
             has = kFlatAll;
    float coordinate = 1.0f;
    uint32_t corner = 2, nameLength = 5;
    std::string meshName{};         ///< of the second
    float positionsOfSecond = 1.0f; ///< its first coordinate

    [[nodiscard]] Bytes bytes() const {
        Bytes all;
        const auto words = [&](std::initializer_list<uint32_t> numbers) {
            for (const uint32_t number : numbers)
                append(all, number);
        };
        words({magic, materials, meshes});
        words({nameLength});
        for (const char c : {'c', 'o', 'r', 'k', '\xff', '\0', '\0', '\0'})
            all.push_back(static_cast<uint8_t>(c));
        words({0, 0, 3, 1, 0});
        words({static_cast<uint32_t>(meshName.size())});
        for (size_t i = 0; i < (meshName.size() + 3) / 4 * 4; ++i)
            all.push_back(i < meshName.size() ? static_cast<uint8_t>(meshName[i]) : uint8_t{0});
        words({material, vertices, triangles, has});
        const auto floats = [&](int count, float first) {
            for (int i = 0; i < count; ++i)
                append(all, i == 0 ? first : static_cast<float>(i % 7));
        };
        floats(9, coordinate);
        words({0, 1, 2});
        floats(9, std::isfinite(coordinate) ? positionsOfSecond : coordinate);
        floats(9 + 6 + 12, coordinate);
        words({0, 1, corner});
        return all;
    }
};

Error errorOf(const Bytes& bytes) {
    return test::errorOf([&] { return readFlatMeshes(bytes, "model.stl"); });
}

TEST(FlatMeshes, AWholeAnswerBecomesAScene) {
    const Bytes bytes = Answer().bytes();
    const FlatMeshes meshes = readFlatMeshes(bytes, "model.stl");
    ASSERT_EQ(meshes.meshes.size(), 2u);
    EXPECT_EQ(meshes.materials.at(0), "cork\xff");
    EXPECT_FALSE(meshes.meshes[0].normals);
    EXPECT_TRUE(meshes.meshes[1].colors);
    EXPECT_EQ(meshes.meshes[1].positions.offset, 9 * 4 + 12u);
    const ScenePtr scene = loadSceneFromMemory(glbOf(meshes, "a test", "model.stl"), ".");
    EXPECT_EQ(scene->triangleCount(), 2u);
    EXPECT_EQ(scene->materials.at(0).name, "cork\xEF\xBF\xBD") << "what is no UTF-8 is replaced";
    EXPECT_EQ(test::brokenPromise(*scene), std::nullopt);
}

TEST(FlatMeshes, EveryLieIsFound) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::pair<Answer, const char*> lies[] = {
        {{.magic = 0}, "begins with something else"},
        {{.materials = 0}, "damaged answer"},
        {{.materials = 2}, "damaged answer"},
        {{.materials = ~0u}, "a count of"},
        {{.meshes = 0}, "damaged answer"},
        {{.meshes = kMaxFlatParts + 1}, "a count of"},
        {{.material = 1}, "impossible counts"},
        {{.vertices = 0}, "impossible counts"},
        {{.vertices = 4}, "cut off"},
        {{.vertices = ~0u}, "cut off"},
        {{.vertices = 2}, "damaged answer"},
        {{.triangles = 0}, "impossible counts"},
        {{.triangles = 2}, "cut off"},
        {{.triangles = ~0u}, "cut off"},
        {{.has = 8}, "impossible counts"},
        {{.has = 3}, "damaged answer"},
        {{.coordinate = std::nanf("")}, "not a finite number"},
        {{.coordinate = -infinity}, "not a finite number"},
        {{.corner = 3}, "a vertex that does not exist"},
        {{.corner = ~0u}, "a vertex that does not exist"},
        {{.nameLength = kMaxFlatNameBytes + 1}, "a name of"},
    };
    for (const auto& [answer, says] : lies)
        EXPECT_TRUE(contains(errorOf(answer.bytes()).problem(), says))
            << errorOf(answer.bytes()).what() << says;
}

TEST(FlatMeshes, AnErrorNamesTheMeshInTextThatMayBeShown) {
    const Error error = errorOf(
        Answer{.coordinate = std::nanf(""), .meshName = std::string("a\x1b[31m\xff\n\0b", 10)}.bytes());
    EXPECT_EQ(error.place(), "") << "the first mesh, without a name, is broken, too";
    Answer answer{.meshName = std::string("a\x1b[31m\xff\n\0b", 10)};
    answer.positionsOfSecond = std::nanf("");
    EXPECT_EQ(errorOf(answer.bytes()).place(), "mesh \"a\\u001b[31m\xEF\xBF\xBD\\n\\u0000b\"");
}

TEST(FlatMeshes, EveryLengthButTheRightOneIsRefused) {
    const Bytes whole = Answer().bytes();
    for (size_t length = 0; length < whole.size(); ++length)
        EXPECT_TRUE(
            contains(errorOf({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}).problem(),
                     "damaged answer"))
            << length;
    Bytes more = whole;
    more.push_back(0);
    EXPECT_TRUE(contains(errorOf(more).problem(), "goes on after its end"));
}

TEST(FlatMeshes, ChangedBytesAreRefusedOrGiveAScene) {
    std::mt19937 random(1);
    const Bytes whole = Answer().bytes();
    size_t loaded = 0;
    constexpr size_t kRounds = 4000;
    for (size_t round = 0; round < kRounds; ++round) {
        Bytes bytes = whole;
        for (size_t changes = 1 + random() % 4; changes > 0; --changes)
            bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
        try {
            const FlatMeshes meshes = readFlatMeshes(bytes, "model.stl");
            const ScenePtr scene = loadSceneFromMemory(glbOf(meshes, "a test", "model.stl"), ".");
            ASSERT_EQ(test::brokenPromise(*scene), std::nullopt) << round;
            ++loaded;
        } catch (const Error&) {
        }
    }
    EXPECT_GT(loaded, kRounds / 20);
    EXPECT_LT(loaded, kRounds);
}

} // namespace
} // namespace touchstone::flat_meshes_test
