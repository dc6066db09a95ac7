// Feeds the volume reader bytes that are nearly NRRD, MetaImage, NIfTI or OpenVDB. It may refuse them; the
// program that called it may not crash, hang, throw anything but Error, or make a volume that breaks what
// volume.h promises. A reader that crashes is no failure, it is what its process is for; how many do is
// printed.
#include "engine/core/error.h"
#include "engine/import/volume_file/volume_import.h"
#include "engine/volume/volume_mesh.h"
#include "tests/support/sweep.h"
#include "tests/support/volume_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace touchstone {
namespace {

namespace fs = std::filesystem;
using test::VolumeBytes;

struct Seed {
    const char* name; ///< of the file
    VolumeBytes bytes;
};

std::vector<Seed> seeds(const fs::path& folder) {
    const assets::VolumeData ball = assets::makeVolume("ball", glm::ivec3(12), "int16");
    const fs::path vdb = folder / "seed.vdb";
    assets::writeVdb(vdb, ball);
    std::ifstream file(vdb, std::ios::binary);
    const VolumeBytes grid{std::istreambuf_iterator<char>(file), {}};
    return {{"v.nrrd", test::nrrdFile(ball)},
            {"float.nrrd", test::nrrdFile(assets::makeVolume("ball", glm::ivec3(12), "float"))},
            {"v.mha", test::metaFile(ball)},
            {"v.mhd", test::metaFile(ball, "seed.raw")},
            {"v.nii", test::niftiFile(ball)},
            {"v.nii.gz", test::gzipped(test::niftiFile(ball))},
            {"v.vdb", grid}};
}

/// Text that changes what a header means.
constexpr const char* kStrangeWords[] = {
    "nan",         "-inf", "1e999",      "-1",     "0",          "4294967296",     "99999999999",
    "\n",          "\r",   "\n\n",       ": ",     "=",          "none",           "(",
    ")",           "gzip", "text",       "double", "MET_DOUBLE", "sizes: 3 3 3\n", "../x",
    "/etc/passwd", "LIST", "NRRD0004\n", "big"};

/// Half of the changes fall into the first bytes, where the header is.
VolumeBytes mutant(const VolumeBytes& seed, size_t mostChanges, std::mt19937& random) {
    constexpr size_t kHeader = 360;
    VolumeBytes bytes = seed;
    for (size_t changes = 1 + random() % mostChanges; changes > 0 && !bytes.empty(); --changes) {
        const size_t within = random() % 2 == 0 ? bytes.size() : std::min(bytes.size(), kHeader);
        const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random() % within);
        const std::string word = kStrangeWords[random() % std::size(kStrangeWords)];
        const auto piece = std::min<std::ptrdiff_t>(bytes.end() - at, 1 + static_cast<int>(random() % 12));
        switch (random() % 5) {
        case 0:
            *at = static_cast<uint8_t>(random());
            break;
        case 1:
            *at ^= static_cast<uint8_t>(1u << random() % 8);
            break;
        case 2:
            bytes.erase(at, at + piece);
            break;
        case 3:
            bytes.insert(at, word.begin(), word.end());
            break;
        default:
            if (random() % 4 == 0)
                bytes.resize(static_cast<size_t>(at - bytes.begin()));
            else
                std::fill(at, at + piece, static_cast<uint8_t>('0' + random() % 10));
            break;
        }
    }
    return bytes;
}

class VolumeFuzz : public testing::TestWithParam<size_t> {};

TEST_P(VolumeFuzz, MutantsAreRefusedOrGiveAVolume) {
    const fs::path folder = fs::temp_directory_path() / ("volume_fuzz_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const Seed seed = seeds(folder)[GetParam()];
    {
        const std::vector<std::byte> values =
            assets::valuesOf(assets::makeVolume("ball", glm::ivec3(12), "int16"));
        std::ofstream(folder / "seed.raw", std::ios::binary)
            .write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size()));
    }
    std::mt19937 random(static_cast<unsigned>(GetParam() + 1));
    const VolumeFormat format = *volumeFormatNamed(seed.name);
    VolumeReader reader = installedVolumeReader(format, 0);
    reader.limits.processorSeconds = 1;
    reader.limits.seconds = 60;
    reader.mostBytes = uint64_t{1} << 24;
    const LoadOptions options;
    size_t loaded = 0, crashed = 0, refused = 0;
    // OpenVDB's files are slow to refuse, and hardly any survives several changes.
    const bool vdb = format == VolumeFormat::Vdb;
    const int rounds = vdb ? test::repetitions(16, 400) : test::repetitions(48, 1200);
    for (int round = 0; round < rounds; ++round) {
        const VolumeBytes bytes = mutant(seed.bytes, vdb ? 1 : 5, random);
        const fs::path path = folder / seed.name;
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        const ImportContext context(path.string(), options);
        try {
            const auto volume = readVolume(context, path, format, reader);
            ASSERT_TRUE(volume->low() < volume->high()) << round;
            ASSERT_TRUE(std::isfinite(volume->low() + volume->high())) << round;
            ASSERT_GT(glm::determinant(volume->facts().axes), 0.0) << round;
            ASSERT_GT(volume->defaultIso(), volume->low()) << round;
            ++loaded;
            const SurfaceMesh mesh = meshOfVolume(*volume, 0.5 * (volume->low() + volume->high()), "mutant");
            for (const uint32_t corner : mesh.corners)
                ASSERT_LT(corner, mesh.positions.size());
        } catch (const Error& error) {
            ++(error.problem().find("crashed") != std::string::npos ? crashed : refused);
        }
    }
    fs::remove_all(folder);
    std::printf("%s: %zu loaded, %zu refused, %zu readers crashed\n", seed.name, loaded, refused, crashed);
    EXPECT_GT(loaded, 0u) << "mutants that are all refused test little";
    EXPECT_GT(refused, 0u);
}

INSTANTIATE_TEST_SUITE_P(Formats, VolumeFuzz, testing::Range(size_t{0}, size_t{7}));

} // namespace
} // namespace touchstone
