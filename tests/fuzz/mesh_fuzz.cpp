// Feeds the mesh reader bytes that are nearly OBJ, STL or PLY. It may refuse them; the program that called it
// may not crash, hang, throw anything but Error, or make a scene that breaks what scene.h promises. A reader
// that crashes is no failure, it is what its process is for; how many do is printed.
#include "engine/import/mesh_file/mesh_import.h"
#include "engine/load/scene_loader.h"
#include "tests/support/mesh_files.h"
#include "tests/support/scene_promises.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

namespace touchstone {
namespace {

using test::Bytes;

struct Seed {
    const char* name;
    MeshFormat format;
    Bytes bytes;
};

std::vector<Seed> seeds() {
    return {{"obj", MeshFormat::Obj, test::tetrahedronObj()},
            {"asciiStl", MeshFormat::Stl, test::tetrahedronAsciiStl()},
            {"binaryStl", MeshFormat::Stl, test::tetrahedronBinaryStl()},
            {"asciiPly", MeshFormat::Ply, test::tetrahedronAsciiPly()},
            {"binaryPly", MeshFormat::Ply, test::tetrahedronBinaryPly()}};
}

/// Text that changes what a parser does: numbers out of range, keywords, ends of lines.
constexpr const char* kStrangeWords[] = {"nan",        "-inf",        "1e999", "-1",       "0",
                                         "4294967296", "99999999999", "\n",    "\r",       "face",
                                         "f",          "usemtl x\n",  "list",  "endsolid", "vertex",
                                         "f 1 2 3\n",  "/",           "//",    "\\\n",     "end_header\n"};

Bytes mutant(const Bytes& seed, std::mt19937& random) {
    Bytes bytes = seed;
    for (size_t changes = 1 + random() % 6; changes > 0 && !bytes.empty(); --changes) {
        const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size());
        const std::string word = kStrangeWords[random() % std::size(kStrangeWords)];
        switch (random() % 6) {
        case 0:
            *at = static_cast<uint8_t>(random());
            break;
        case 1:
            *at ^= static_cast<uint8_t>(1u << random() % 8);
            break;
        case 2:
            bytes.erase(at,
                        at + std::min<std::ptrdiff_t>(bytes.end() - at, 1 + static_cast<int>(random() % 30)));
            break;
        case 3:
            bytes.insert(at, word.begin(), word.end());
            break;
        case 4: { // a piece once more
            const Bytes piece(
                at, at + std::min<std::ptrdiff_t>(bytes.end() - at, static_cast<int>(random() % 60)));
            bytes.insert(bytes.end(), piece.begin(), piece.end());
            break;
        }
        default:
            bytes.resize(static_cast<size_t>(at - bytes.begin()));
            break;
        }
    }
    return bytes;
}

class MeshFuzz : public testing::TestWithParam<size_t> {};

TEST_P(MeshFuzz, MutantsAreRefusedOrGiveAScene) {
    const Seed seed = seeds()[GetParam()];
    std::mt19937 random(static_cast<unsigned>(GetParam() + 1));
    MeshReader reader = installedMeshReader(0);
    reader.limits.processorSeconds = 1;
    reader.limits.seconds = 60;
    const LoadOptions options;
    size_t loaded = 0, crashed = 0, refused = 0;
    constexpr size_t kRounds = 50;
    for (size_t round = 0; round < kRounds; ++round) {
        const Bytes bytes = mutant(seed.bytes, random);
        ImportContext context("mutant", options);
        try {
            const ScenePtr scene =
                loadSceneFromMemory(meshAsGlb(context, bytes, seed.format, reader), "/nonexistent");
            ASSERT_EQ(test::brokenPromise(*scene), std::nullopt) << seed.name << " " << round;
            ++loaded;
        } catch (const Error& error) {
            ++(error.problem().find("crashed") != std::string::npos ? crashed : refused);
        }
    }
    std::printf("%s: %zu loaded, %zu refused, %zu readers crashed\n", seed.name, loaded, refused, crashed);
    EXPECT_GT(loaded, 0u) << "mutants that are all refused test little";
    EXPECT_LT(loaded, kRounds);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshFuzz, testing::Range(size_t{0}, size_t{5}));

} // namespace
} // namespace touchstone
