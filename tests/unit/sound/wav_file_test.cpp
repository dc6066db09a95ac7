#include "engine/core/error.h"
#include "sound/wav_file.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <sndfile.h>

#include <fstream>
#include <iterator>
#include <vector>

namespace touchstone::test::wav_file_test {
namespace {

TEST(WavFile, HoldsWhatWasWritten) {
    const ScratchFolder scratch;
    const auto file = scratch / "a b.wav";
    WavFile out(file, 48000);
    const std::vector<SoundFrame> frames{{0.0f, 0.0f}, {0.5f, -0.5f}, {1.0f, -1.0f}};
    out.write(frames);
    out.write({});
    EXPECT_FALSE(std::filesystem::exists(file)) << "it is not half there";
    out.commit();
    SF_INFO info{};
    SNDFILE* in = sf_open(file.c_str(), SFM_READ, &info);
    ASSERT_NE(in, nullptr);
    EXPECT_EQ(info.samplerate, 48000);
    EXPECT_EQ(info.channels, 2);
    ASSERT_EQ(info.frames, 3);
    std::vector<float> read(6);
    EXPECT_EQ(sf_readf_float(in, read.data(), 3), 3);
    sf_close(in);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(read[i], (&frames[0].left)[i], 1.0f / 32767.0f) << i;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1)
        << "nothing else stays";
}

TEST(WavFile, LeavesWhatWasThereUntilItIsDone) {
    const ScratchFolder scratch;
    const auto file = scratch / "old.wav";
    std::ofstream(file) << "old";
    {
        WavFile out(file, 48000);
        out.write(std::vector<SoundFrame>(100));
    }
    std::string text;
    std::ifstream(file) >> text;
    EXPECT_EQ(text, "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1);
}

TEST(WavFile, SaysWhatIsWrongWithAPlace) {
    const ScratchFolder scratch;
    const auto problemOf = [](const std::filesystem::path& path) -> std::string {
        try {
            WavFile out(path, 48000);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const std::string folder = problemOf(scratch.path());
    EXPECT_NE(folder.find(scratch.path().string() + ": is a folder"), std::string::npos) << folder;
    const std::string missing = problemOf(scratch / "no" / "x.wav");
    EXPECT_NE(missing.find("x.wav: cannot be written"), std::string::npos) << missing;
    EXPECT_NE(missing.find("remedy"), std::string::npos) << missing;
    EXPECT_NE(problemOf("/dev/null").find("is no file"), std::string::npos);
}

} // namespace
} // namespace touchstone::test::wav_file_test
