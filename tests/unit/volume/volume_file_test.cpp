// Volumes of every format, and files that lie about theirs.
#include "engine/core/error.h"
#include "engine/import/volume_file/volume_import.h"
#include "engine/load/scene_loader.h"
#include "haptics/recording/scene_identity.h"
#include "tests/support/volume_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

namespace touchstone {
namespace {

namespace fs = std::filesystem;
using test::VolumeBytes;

class VolumeFiles : public testing::Test {
  protected:
    VolumeFiles()
        : folder_(fs::temp_directory_path() / ("touchstone_volumes_" + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
    }
    ~VolumeFiles() override { fs::remove_all(folder_); }

    fs::path file(const std::string& name, const VolumeBytes& bytes) const {
        const fs::path path = folder_ / name;
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return path;
    }
    std::shared_ptr<const Volume> read(const fs::path& path) const {
        const LoadOptions options;
        const ImportContext context(path.string(), options);
        const VolumeFormat format = *volumeFormatNamed(path);
        return readVolume(context, path, format, installedVolumeReader(format, fs::file_size(path)));
    }
    std::string refusal(const std::string& name, const VolumeBytes& bytes) const {
        try {
            (void)read(file(name, bytes));
        } catch (const Error& error) {
            EXPECT_FALSE(error.remedy().empty());
            return error.problem();
        }
        return "not refused";
    }
    fs::path folder_;
};

/// The value of the voxel whose centre is nearest.
double valueNear(const Volume& volume, const glm::dvec3& scenePoint) {
    const glm::dvec3 voxel = glm::inverse(volume.facts().axes) * (scenePoint - volume.facts().origin);
    const glm::ivec3 at = glm::clamp(glm::ivec3(glm::round(voxel)), glm::ivec3(0), volume.size() - 1);
    std::array<float, 1> value{};
    volume.row(at, value);
    return static_cast<double>(value[0]);
}

/// The scene has left, superior and anterior along its axes, metres.
glm::dvec3 sceneFromLpsMillimetres(const glm::dvec3& lps) {
    return 1e-3 * glm::dvec3(lps.x, lps.z, -lps.y);
}

void expectHead(const Volume& volume, const assets::VolumeData& made, const std::string& name) {
    std::mt19937 random(7);
    for (int i = 0; i < 300; ++i) {
        glm::ivec3 at;
        for (int axis = 0; axis < 3; ++axis)
            at[axis] = static_cast<int>(random() % static_cast<unsigned>(made.voxels[axis]));
        const glm::dvec3 lps = test::firstVoxel(made) + made.spacing * glm::dvec3(at);
        const size_t index = static_cast<size_t>(at.x + made.voxels.x * (at.y + made.voxels.y * at.z));
        ASSERT_EQ(valueNear(volume, sceneFromLpsMillimetres(lps)), static_cast<double>(made.values[index]))
            << name << " at voxel " << at.x << " " << at.y << " " << at.z;
    }
    EXPECT_GT(glm::determinant(volume.facts().axes), 0.0) << name;
    EXPECT_NEAR(volume.bounds().extent().y, 1e-3 * made.spacing.z * (made.voxels.z - 1), 1e-6) << name;
}

TEST_F(VolumeFiles, EveryFormatPlacesTheSameHead) {
    // Anisotropic: its axes cannot be mistaken for one another.
    for (const char* type : {"uint8", "int16", "float"}) {
        const assets::VolumeData head = assets::makeVolume("head", {24, 32, 18}, type);
        const VolumeBytes nrrd = test::nrrdFile(head);
        expectHead(*read(file("head.nrrd", nrrd)), head, "nrrd");
        for (const bool big : {false, true}) {
            expectHead(*read(file("head.mha", test::metaFile(head, "LOCAL", big))), head, "mha");
            for (const auto place : {test::NiftiPlace::Sform, test::NiftiPlace::Qform}) {
                const VolumeBytes nifti = test::niftiFile(head, place, big);
                expectHead(*read(file("head.nii", nifti)), head, "nii");
                expectHead(*read(file("head.nii.gz", test::gzipped(nifti))), head, "nii.gz");
            }
        }
        VolumeBytes data;
        test::append(data, assets::valuesOf(head));
        file("head.raw", data);
        expectHead(*read(file("head.mhd", test::metaFile(head, "head.raw"))), head, "mhd");
    }
}

TEST_F(VolumeFiles, AnOpenVdbFileIsReadOverItsActiveVoxels) {
    const assets::VolumeData ball = assets::makeVolume("ball", glm::ivec3(24), "float");
    const fs::path path = folder_ / "ball.vdb";
    assets::writeVdb(path, ball);
    const auto volume = read(path);
    EXPECT_EQ(volume->size(), glm::ivec3(26)); // and one voxel beyond on each side
    const glm::dvec3 first = 1e-3 * test::firstVoxel(ball);
    for (const glm::ivec3 at : {glm::ivec3(12), glm::ivec3(3, 12, 12), glm::ivec3(5, 6, 20)})
        EXPECT_EQ(valueNear(*volume, first + 1e-3 * ball.spacing * glm::dvec3(at)),
                  static_cast<double>(ball.values[static_cast<size_t>(at.x + 24 * (at.y + 24 * at.z))]));
}

/// A small NRRD with the given lines and data.
VolumeBytes nrrd(const std::string& lines, const VolumeBytes& data) {
    VolumeBytes bytes = test::bytesOfText("NRRD0004\n" + lines + "\n");
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

TEST_F(VolumeFiles, EveryTypeOfNumberIsRead) {
    const std::array<std::pair<const char*, size_t>, 10> types{{{"uchar", 1},
                                                                {"int8", 1},
                                                                {"ushort", 2},
                                                                {"short", 2},
                                                                {"uint", 4},
                                                                {"int", 4},
                                                                {"ulonglong", 8},
                                                                {"longlong", 8},
                                                                {"float", 4},
                                                                {"double", 8}}};
    for (const auto& [type, each] : types)
        for (const bool big : {false, true}) {
            VolumeBytes data;
            for (int i = 0; i < 27; ++i) { // 0, 4 ... 104
                const bool real = std::string(type) == "float" || std::string(type) == "double";
                const double value = 4.0 * i;
                uint64_t bits = static_cast<uint64_t>(value);
                if (real && each == 4)
                    bits = std::bit_cast<uint32_t>(static_cast<float>(value));
                else if (real)
                    bits = std::bit_cast<uint64_t>(value);
                for (size_t k = 0; k < each; ++k)
                    data.push_back(static_cast<uint8_t>(bits >> 8 * (big ? each - 1 - k : k)));
            }
            const std::string lines =
                std::string("type: ") + type +
                "\ndimension: 3\nsizes: 3 3 3\nspacings: 1 2 3\nendian: " + (big ? "big" : "little") +
                "\nencoding: ";
            for (const bool packed : {false, true}) {
                const auto volume = read(file("v.nrrd", nrrd(lines + (packed ? "gzip\n" : "raw\n"),
                                                             packed ? test::gzipped(data) : data)));
                std::array<float, 3> row{};
                volume->row({0, 2, 2}, row);
                EXPECT_EQ(row, (std::array<float, 3>{96.0f, 100.0f, 104.0f})) << type << big << packed;
                EXPECT_EQ(volume->facts().notes.size(), 2u) << "no unit, no orientation";
                EXPECT_NEAR(glm::length(volume->facts().axes[2]), 3e-3, 1e-12);
            }
        }
    const auto text = read(file("v.nrrd", nrrd("type: short\ndimension: 3\nsizes: 2 2 2\nencoding: text\n",
                                               test::bytesOfText("-1 2\n3 4 5,6 7 -8e0"))));
    std::array<float, 2> row{};
    text->row({0, 1, 1}, row);
    EXPECT_EQ(row, (std::array<float, 2>{7.0f, -8.0f}));
}

TEST_F(VolumeFiles, AxesOfTheWrongHandAreTurned) {
    VolumeBytes data;
    for (uint8_t i = 0; i < 8; ++i)
        data.push_back(i);
    const auto volume =
        read(file("v.nrrd", nrrd("type: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 2 2\n"
                                 "space directions: (-2,0,0) (0,2,0) (0,0,2)\nspace units: \"cm\" \"cm\" "
                                 "\"cm\"\nspace origin: (10,0,0)\nencoding: raw\n",
                                 data)));
    EXPECT_GT(glm::determinant(volume->facts().axes), 0.0);
    EXPECT_EQ(valueNear(*volume, {0.10, 0, 0}), 0.0);
    EXPECT_EQ(valueNear(*volume, {0.08, 0, 0}), 1.0);
    EXPECT_EQ(valueNear(*volume, {0.08, 0.02, -0.02}), 7.0);
}

TEST_F(VolumeFiles, NiftiScalesItsValues) {
    VolumeBytes bytes = test::niftiFile(assets::makeVolume("ball", glm::ivec3(16), "int16"));
    const float slope = 0.5f, inter = -3.0f;
    std::memcpy(bytes.data() + 112, &slope, 4);
    std::memcpy(bytes.data() + 116, &inter, 4);
    const auto volume = read(file("v.nii", bytes));
    EXPECT_EQ(volume->low(), -3.0);
    EXPECT_EQ(volume->high(), 0.5 * 200.0 - 3.0);
}

TEST_F(VolumeFiles, NiftiNumbersThatCountForNothingMayBeMissing) {
    const assets::VolumeData head = assets::makeVolume("head", {24, 32, 18}, "int16");
    VolumeBytes bytes = test::niftiFile(head, test::NiftiPlace::Sform);
    const float none = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 112, &none, 4); // no scaling
    std::memcpy(bytes.data() + 80, &none, 4);  // the sform has the spacing
    expectHead(*read(file("v.nii", bytes)), head, "nan");
    const float endless = std::numeric_limits<float>::infinity();
    std::memcpy(bytes.data() + 112, &endless, 4);
    EXPECT_NE(refusal("v.nii", bytes).find("not finite"), std::string::npos);
    VolumeBytes qform = test::niftiFile(head, test::NiftiPlace::Qform);
    std::memcpy(qform.data() + 80, &none, 4);
    EXPECT_NE(refusal("v.nii", qform).find("not finite"), std::string::npos);
}

TEST_F(VolumeFiles, WhatLiesIsRefusedWithItsReason) {
    const assets::VolumeData ball = assets::makeVolume("ball", glm::ivec3(16), "int16");
    const VolumeBytes good = test::nrrdFile(ball);
    const auto cut = [](VolumeBytes bytes, size_t off) {
        bytes.resize(bytes.size() - off);
        return bytes;
    };
    VolumeBytes lost = test::gzipped(test::niftiFile(ball));
    VolumeBytes damaged = lost;
    damaged[damaged.size() / 2] ^= 0x55;
    VolumeBytes nan = test::nrrdFile(assets::makeVolume("ball", glm::ivec3(16), "float"));
    const float none = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(nan.data() + nan.size() - 40, &none, 4);
    const std::string head = "type: short\ndimension: 3\nendian: little\nencoding: raw\n";
    std::string comments;
    while (comments.size() < 70'000)
        comments += "# a line of a header that goes on\n";
    const auto after = [](const std::string& first, VolumeBytes file) { // behind its first line
        file.insert(std::find(file.begin(), file.end(), uint8_t{'\n'}) + 1, first.begin(), first.end());
        return file;
    };
    const std::string line = "# " + std::string(70'000, 'x') + "\n", named = "Comment = " + line;
    const auto firstLine =
        static_cast<size_t>(std::find(good.begin(), good.end(), uint8_t{'\n'}) + 1 - good.begin());
    struct Case {
        const char* name;
        VolumeBytes bytes;
        const char* reason;
    };
    const Case cases[] = {
        {"cut.nrrd", cut(good, 100), "asks for 8192 bytes of values, and there are 8092"},
        {"cut.mha", cut(test::metaFile(ball), 1), "and there are 8191"},
        {"cut.nii.gz", cut(lost, lost.size() / 2), "cut off"},
        {"damaged.nii.gz", damaged, "damaged"},
        {"huge.nrrd", nrrd(head + "sizes: 2000 2000 1250\n", {1, 2}),
         "10.0 GB of values (2000 x 2000 x 1250 voxels, int16), and 1.1 GB fit"},
        {"huge2.nrrd", nrrd(head + "sizes: 9000000000000000 9000000000000000 9000000000000000\n", {1}),
         "fit"},
        {"flat.nrrd", nrrd(head + "sizes: 64 64 1\n", VolumeBytes(8192)), "at least two on each axis"},
        {"colour.nrrd", nrrd("type: uchar\ndimension: 4\nsizes: 3 4 4 4\nencoding: raw\n", VolumeBytes(192)),
         "4 axes"},
        {"block.nrrd", nrrd("type: block\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n", VolumeBytes(64)),
         "no number's"},
        {"endless.nrrd", nrrd("type: short\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n", VolumeBytes(128)),
         "order of its bytes"},
        {"even.nrrd", nrrd("type: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n", VolumeBytes(64)),
         "every voxel has the value 0"},
        {"plane.nrrd",
         nrrd("type: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspace dimension: 3\nspace directions: "
              "(1,0,0) (0,1,0) (1,1,0)\n",
              {1, 2, 3, 4, 5, 6, 7, 8}),
         "lie in a plane"},
        {"nothing.nrrd",
         nrrd("type: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspacings: 0 1 1\n",
              {1, 2, 3, 4, 5, 6, 7, 8}),
         "no usable number"},
        {"comments.nrrd", after(comments, good), "its header is longer than 64 KiB, or has no end"},
        {"line.nrrd", after(line, good), "its header is longer than 64 KiB, or has no end"},
        {"line.mha", after(named, test::metaFile(ball)), "its header is longer than 64 KiB, or has no end"},
        {"end.nrrd", nrrd(head + "sizes: 4 4 4\n" + comments, VolumeBytes(128)),
         "its header is longer than 64 KiB, or has no end"},
        {"edge.nrrd", after(std::string(size_t{65535} - firstLine, '#') + "\n", good),
         "its header is longer than 64 KiB, or has no end"},
        {"other.nrrd", test::bytesOfText("glTF"), "NRRD000"},
        {"other.vdb", test::bytesOfText("no grid at all, but text"), "cannot be read as OpenVDB"},
        {"other.nii", VolumeBytes(400), "size of 0 instead of 348"},
        {"nan.nrrd", nan, "1 voxels are not finite numbers, the first at (6, 15, 15)"},
        {"outside.mhd", test::metaFile(ball, "../secret.raw"), "'../secret.raw' leaves the header's folder"},
        {"within.mhd", test::metaFile(ball, "a/../../secret.raw"), "leaves the header's folder"},
        {"windows.mhd", test::metaFile(ball, "a\\b.raw"), "has backslashes"},
        {"bell.mhd", test::metaFile(ball, "a\ab.raw"), "'a b.raw' holds a control character"},
        {"zero.mhd", test::metaFile(ball, std::string("a\0b.raw", 7)), "holds a control character"},
        {"long.mhd", test::metaFile(ball, std::string(2000, 'a')), "longer than 1024 bytes"},
        {"list2.mhd", test::metaFile(ball, "LIST 2"), "slices are in files of their own"},
        {"pattern.mhd", test::metaFile(ball, "slice%03d.raw"), "slices are in files of their own"},
        {"pattern.nrrd", nrrd(head + "sizes: 4 4 4\ndata file: slice%d.raw 1 4 1\n", {}),
         "slices are in files of their own"},
        {"absolute.mhd", test::metaFile(ball, "/etc/passwd"), "/etc/passwd"},
        {"missing.mhd", test::metaFile(ball, "missing.raw"), "there is no such file"},
        {"list.mhd", test::metaFile(ball, "LIST"), "slices are in files of their own"},
    };
    for (const Case& each : cases) {
        const std::string problem = refusal(each.name, each.bytes);
        EXPECT_NE(problem.find(each.reason), std::string::npos) << each.name << ": " << problem;
    }
}

TEST_F(VolumeFiles, DataFilesAreFoundByTheirNamesAsTheyAre) {
    const assets::VolumeData head = assets::makeVolume("head", {24, 32, 18}, "int16");
    VolumeBytes data;
    test::append(data, assets::valuesOf(head));
    fs::create_directory(folder_ / "Daten");
    for (const std::string& name : {std::string("Sch\xc3\xa4"
                                                "del.raw"),
                                    std::string("Sch\xe4"
                                                "del.raw"),
                                    std::string("a%20b.raw"), std::string("CT:1.raw"), std::string("50%.raw"),
                                    std::string("100%25 d.raw"), std::string("two words.raw"),
                                    std::string("Daten/k..o.raw"), std::string(200, 'n') + ".raw"}) {
        file(name, data);
        expectHead(*read(file("head.mhd", test::metaFile(head, name))), head, name);
    }
    fs::create_directories(folder_ / std::string(200, 'f') / std::string(200, 'g'));
    const std::string far = std::string(200, 'f') + "/" + std::string(200, 'g') + "/h.raw";
    file(far, data);
    expectHead(*read(file("head.mhd", test::metaFile(head, far))), head, "a long name");
}

TEST_F(VolumeFiles, RangesThatFloatsCannotDivideAreRefused) {
    const auto problem = [&](float low, float high) {
        VolumeBytes data;
        for (int i = 0; i < 27; ++i) {
            const auto bits = std::bit_cast<std::array<uint8_t, 4>>(i < 13 ? low : high);
            data.insert(data.end(), bits.begin(), bits.end());
        }
        return refusal(
            "v.nrrd", nrrd("type: float\ndimension: 3\nsizes: 3 3 3\nendian: little\nencoding: raw\n", data));
    };
    const char* const reason = "numbers of 32 bits cannot divide that";
    for (const auto& [low, high] :
         {std::pair{-3e38f, 3e38f}, {0.0f, 1e-45f}, {1e9f, std::nextafter(1e9f, 2e9f)}, {-2e-38f, 3e-38f}})
        EXPECT_NE(problem(low, high).find(reason), std::string::npos)
            << low << " " << high << problem(low, high);
    for (const auto& [low, high] : {std::pair{-1.5e38f, 1.5e38f}, {0.0f, 1e-20f}, {1e9f, 1.0001e9f}})
        EXPECT_EQ(problem(low, high), "not refused") << low << " " << high;
}

TEST_F(VolumeFiles, ABrokenReaderIsAnErrorOfItsFile) {
    const fs::path volume =
        file("v.nrrd", test::nrrdFile(assets::makeVolume("ball", glm::ivec3(8), "uint8")));
    const auto problem = [&](const std::string& script, const ProcessLimits& limits = {}) {
        const fs::path program = file("reader", test::bytesOfText("#!/bin/sh\n" + script));
        fs::permissions(program, fs::perms::owner_all);
        const LoadOptions options;
        const ImportContext context("v.nrrd", options);
        try {
            (void)readVolume(context, volume, VolumeFormat::Nrrd,
                             {.program = program, .limits = limits, .mostBytes = 1000});
        } catch (const Error& error) {
            return error.problem();
        }
        return std::string("read");
    };
    EXPECT_NE(problem("kill -SEGV $$").find("crashed"), std::string::npos);
    EXPECT_NE(problem("exit 5").find("status 5"), std::string::npos);
    EXPECT_NE(problem("echo TVF1").find("damaged answer"), std::string::npos);
    EXPECT_NE(problem("sleep 20", {.seconds = 0}).find("longer than"), std::string::npos);
    EXPECT_NE(problem("exec head -c 900000 /dev/zero").find("more than"), std::string::npos);
    EXPECT_NE(problem("printf 'a\\033[31m\\nrest'; exit 1").find("cannot be read as NRRD: a [31m"),
              std::string::npos);
}

TEST_F(VolumeFiles, HugeFilesAreRefusedUnreadAndReadingIsCancelled) {
    const fs::path path = file("v.nrrd", test::nrrdFile(assets::makeVolume("ball", glm::ivec3(16), "int16")));
    fs::resize_file(path, uint64_t{1} << 40); // sparse
    try {
        (void)read(path);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(error.problem().find("its file has 1048576 MiB, and at most"), std::string::npos)
            << error.what();
    }
    // The reader is done at once; what takes long is to know the file again.
    fs::resize_file(path, uint64_t{8} << 30);
    std::atomic<bool> cancel{false};
    int before = 0, after = 0; // reports: one every 50 ms for as long as this process runs
    LoadOptions options;
    options.cancel = &cancel;
    options.progress = [&](double, const char*) {
        if (cancel.load())
            ++after;
        else
            cancel = ++before == 6;
    };
    const ImportContext context(path.string(), options);
    EXPECT_THROW(
        (void)readVolume(context, path, VolumeFormat::Nrrd, installedVolumeReader(VolumeFormat::Nrrd, 0)),
        Cancelled);
    EXPECT_EQ(before, 6);
    EXPECT_LT(after, 10) << "within half a second";
}

TEST_F(VolumeFiles, AVolumeIsASceneWithItsSurface) {
    const fs::path path =
        file("ball.nrrd", test::nrrdFile(assets::makeVolume("ball", glm::ivec3(32), "int16")));
    LoadOptions watched;
    double reached = 0.0;
    watched.progress = [&](double fraction, const char* what) {
        EXPECT_GE(fraction, reached) << what;
        reached = fraction;
    };
    const ScenePtr scene = loadScene(path, watched);
    EXPECT_EQ(reached, 1.0);
    ASSERT_NE(scene->volume, nullptr);
    EXPECT_GT(scene->triangleCount(), 1000u);
    EXPECT_EQ(scene->iso, scene->volume->defaultIso());
    EXPECT_GT(scene->iso, 25.0); // between air and the ball, or the ball and its core
    EXPECT_LT(scene->iso, 175.0);
    LoadOptions options;
    options.iso = 150.0;
    options.volume = scene->volume;
    fs::remove(path); // not read again
    const ScenePtr core = loadScene(path, options);
    EXPECT_EQ(core->volume, scene->volume);
    EXPECT_LT(core->triangleCount(), scene->triangleCount());
    EXPECT_EQ(core->bounds.low, scene->bounds.low) << "the model keeps its size in the hand";
    options.iso = 201.0;
    try {
        (void)loadScene(path, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(error.remedy().find("its values go from 0 to 200"), std::string::npos) << error.what();
    }
}

TEST_F(VolumeFiles, ARecordingKnowsAVolumeWithoutReadingItAgain) {
    const fs::path path =
        file("ball.nrrd", test::nrrdFile(assets::makeVolume("ball", {96, 96, 80}, "int16")));
    const ScenePtr scene = loadScene(path);
    const auto haptic = compileHapticScene(*scene, workspaceFromScene(*scene, Fit::Workspace));
    // As every file is known: the hash of its blocks.
    std::ifstream bytes(path, std::ios::binary);
    std::vector<std::byte> block(size_t{1} << 20);
    Hash64 hash;
    uint64_t size = 0;
    while (bytes.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size())) ||
           bytes.gcount() > 0) {
        hash.addBytes(std::span(block).first(static_cast<size_t>(bytes.gcount())));
        size += static_cast<uint64_t>(bytes.gcount());
    }
    EXPECT_GT(size, block.size()) << "more than a block";
    fs::remove(path);
    const SceneIdentity identity = identify(*haptic, *scene, Fit::Workspace);
    EXPECT_EQ(identity.fileSize, size);
    EXPECT_EQ(identity.fileHash, hash.value());
}

TEST(Otsu, TheThresholdLiesBetweenTwoPeaks) {
    Volume::Histogram histogram{};
    histogram[10] = 5000;
    histogram[200] = 300;
    EXPECT_NEAR(otsuThreshold(histogram, 0.0, 256.0), 105.5, 0.5);
}

} // namespace
} // namespace touchstone
