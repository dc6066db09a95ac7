// `touchstone touch --sound`: what a known bump height sounds like, in the file.

#include "tests/support/program.h"
#include "tests/unit/sound/tone.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <sndfile.h>

#include <cmath>
#include <fstream>
#include <span>
#include <sstream>

namespace touchstone::test::sound_command_tests {
namespace {

/// The ribs of the swatches stand 4 mm apart, on the front of the board, x 68 to 108 mm, y 2 to 42 mm, z 6
/// mm.
class SoundCommand : public testing::Test {
  protected:
    struct Wav {
        int rate = 0;
        std::vector<SoundFrame> frames;
        [[nodiscard]] std::span<const SoundFrame> between(double from, double to) const {
            const auto at = [this](double t) { return static_cast<size_t>(t * rate); };
            return std::span(frames).subspan(at(from), at(to) - at(from));
        }
    };

    /// Presses 1 mm deep in the first 0.3 s, then strokes over the ribs at `speed` until `end`; the hand is
    /// in the air before 0.2 s and after `end`.
    void stroke(double speed, double end) {
        std::ofstream csv(path_);
        csv << "t,x,y,z\n";
        for (int i = 0; i <= static_cast<int>((end + 0.5) * 1000.0); ++i) {
            const double t = 1e-3 * i, pressed = std::clamp((t - 0.2) / 0.1, 0.0, 1.0);
            const double x = 0.070 + speed * std::clamp(t - 0.4, 0.0, end - 0.4);
            const double z = 0.006 + (t > end ? 0.005 : 0.002 - 0.003 * pressed);
            csv << t << ',' << x << ",0.022," << z << '\n';
        }
    }
    ProgramResult touch(std::vector<std::string> more) {
        more.insert(more.begin(), {TOUCHSTONE_BINARY, "touch", TOUCHSTONE_ASSETS "/swatches.glb", "--path",
                                   path_.string(), "--out", ticks_.string()});
        return runProgram(more);
    }
    Wav heard(const std::vector<std::string>& settings) {
        std::vector<std::string> arguments{"--sound", wav_.string()};
        for (const std::string& setting : settings)
            arguments.insert(arguments.end(), {"--set", setting});
        const ProgramResult done = touch(arguments);
        EXPECT_EQ(done.status, 0) << done.err;
        SF_INFO info{};
        SNDFILE* file = sf_open(wav_.c_str(), SFM_READ, &info);
        if (file == nullptr)
            throw std::runtime_error("no WAV file");
        Wav wav{info.samplerate, std::vector<SoundFrame>(static_cast<size_t>(info.frames))};
        EXPECT_EQ(sf_readf_float(file, &wav.frames[0].left, info.frames), info.frames);
        sf_close(file);
        return wav;
    }

    ScratchFolder scratch_;
    std::filesystem::path path_ = scratch_ / "hip.csv", ticks_ = scratch_ / "ticks.csv",
                          wav_ = scratch_ / "a touch.wav";
};

/// Minsky's force is proportional to the slope: over a sine of 4 mm at v it is a tone of v / 4 mm.
TEST_F(SoundCommand, RibsSoundAsSpeedOverTheirDistance) {
    for (const double speed : {0.16, 0.2, 0.3}) {
        const double end = 0.4 + 0.036 / speed;
        stroke(speed, end);
        const Wav wav = heard({"texture=minsky", "friction=off"});
        EXPECT_EQ(wav.rate, 48000);
        EXPECT_NEAR(static_cast<double>(wav.frames.size()), (end + 0.5) * wav.rate, 2e-3 * wav.rate);
        const std::vector<float> right = rightOf(wav.between(0.41, end - 0.005));
        const double tone = speed / 0.004;
        EXPECT_NEAR(strongestTone(right, wav.rate, 25.0, 500.0), tone, 2.0) << speed << " m/s";
        EXPECT_GT(toneIn(right, wav.rate, tone), 0.05);
    }
}

TEST_F(SoundCommand, IsSilentInTheAirOnWhatIsSmoothAndWithTheForceOff) {
    stroke(0.1, 0.7);
    const Wav ribs = heard({"friction=off"});
    EXPECT_GT(loudest(ribs.between(0.45, 0.69)), 0.1);
    EXPECT_EQ(loudest(ribs.between(0.0, 0.2)), 0.0) << "in the air";
    EXPECT_LT(loudest(ribs.between(0.95, 1.15)), 1e-3) << "in the air again";
    // Second t of it is second t of the path: the hand lets go at 0.7 s, to 2 ms.
    EXPECT_GT(loudest(ribs.between(0.699, 0.703)), 2.0 * loudest(ribs.between(0.69, 0.697)));
    const Wav smooth = heard({"friction=off", "texture=off"});
    EXPECT_LT(loudest(smooth.between(0.5, 0.69)), 1e-3) << "a smooth surface";
    EXPECT_EQ(loudest(heard({"forceEnabled=off"}).frames), 0.0) << "no force";
}

TEST_F(SoundCommand, ChangesNothingOfTheTouchAndIsTheSameEachTime) {
    stroke(0.1, 0.7);
    ASSERT_EQ(touch({}).status, 0);
    const std::string without = withoutColumn(readFile(ticks_), "step_ns");
    (void)heard({});
    EXPECT_EQ(withoutColumn(readFile(ticks_), "step_ns"), without);
    const std::string sound = readFile(wav_);
    EXPECT_GT(sound.size(), 100000u);
    (void)heard({});
    EXPECT_EQ(readFile(wav_), sound);
}

TEST_F(SoundCommand, SaysWhatItCannotDoAndLeavesNothing) {
    stroke(0.1, 0.7);
    const std::string nowhere = (scratch_ / "no/x.wav").string();
    const ProgramResult folder = touch({"--sound", nowhere});
    EXPECT_EQ(folder.status, 1);
    EXPECT_NE(folder.err.find(nowhere + ": cannot be written"), std::string::npos) << folder.err;
    EXPECT_FALSE(std::filesystem::exists(ticks_));
    std::ofstream(path_) << "t,x,y,z\n0,0.07,0.022,0.01\n0.2,0.07,0.022,0.01\n0.4,0.08,0.022,0.01\n";
    const ProgramResult slow = touch({"--sound", wav_.string()});
    EXPECT_EQ(slow.status, 1);
    EXPECT_NE(slow.err.find("--rate 1000"), std::string::npos) << slow.err;
    EXPECT_FALSE(std::filesystem::exists(wav_));
    EXPECT_EQ(touch({"--sound", wav_.string(), "--rate", "1000"}).status, 0);
    EXPECT_TRUE(std::filesystem::exists(wav_));
}

} // namespace
} // namespace touchstone::test::sound_command_tests
