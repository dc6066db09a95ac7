// Pictures by the command line: sizes, formats and cameras.

#include "tests/screenshot/golden.h"
#include "tests/support/gltf_maker.h"
#include "tests/support/program.h"
#include "tests/unit/workbench/picture_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

namespace touchstone::test::render_tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";
const Environment kValidated{"TOUCHSTONE_VALIDATION=1", "DISPLAY=", "WAYLAND_DISPLAY="};

/// A wedge-like corner of three coloured squares: no two sides of it look alike.
GltfMaker corner() {
    GltfMaker maker = GltfMaker::square();
    const std::vector<std::vector<double>> colors{{0.8, 0.1, 0.1, 1}, {0.1, 0.6, 0.1, 1}, {0.1, 0.2, 0.8, 1}};
    const json primitive = maker.primitive();
    for (size_t i = 0; i < colors.size(); ++i) {
        const size_t material = maker.append(
            "materials", {{"pbrMetallicRoughness", {{"baseColorFactor", colors[i]}, {"metallicFactor", 0}}},
                          {"doubleSided", true}});
        json own = primitive;
        own["material"] = material;
        if (i == 0)
            maker.primitive() = own;
        else
            maker.append("meshes", {{"primitives", {own}}});
    }
    const double half = std::sqrt(0.5);
    for (const json& node : {json{{"mesh", 1}, {"rotation", {0, -half, 0, half}}, {"scale", {0.7, 1, 1}}},
                             json{{"mesh", 2}, {"rotation", {half, 0, 0, half}}, {"scale", {1, 0.4, 1}}}})
        maker.json["scenes"][0]["nodes"].push_back(maker.append("nodes", node));
    return maker;
}

/// Cameras that stand at (2, 1.5, 3) and look at (0.5, 0.5, 0), upright: as a lens, and as parallel lines of
/// sight.
GltfMaker withCameras() {
    GltfMaker maker = corner();
    maker.append(
        "cameras",
        {{"name", "lens"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}});
    maker.append("cameras",
                 {{"type", "orthographic"},
                  {"orthographic", {{"xmag", 0.9}, {"ymag", 0.9}, {"znear", 0.0}, {"zfar", 10.0}}}});
    // back = (1.5, 1, 3) / 3.5, right = y x back, up = back x right.
    const double side = std::sqrt(11.25);
    const std::vector<double> right{3 / side, 0, -1.5 / side}, back{1.5 / 3.5, 1 / 3.5, 3 / 3.5};
    const std::vector<double> up{back[1] * right[2], back[2] * right[0] - back[0] * right[2],
                                 -back[1] * right[0]};
    const json matrix{right[0], right[1], right[2], 0, up[0], up[1], up[2], 0,
                      back[0],  back[1],  back[2],  0, 2,     1.5,   3,     1};
    for (const size_t camera : {0, 1})
        maker.json["scenes"][0]["nodes"].push_back(maker.append(
            "nodes", {{"camera", camera}, {"name", "stand" + std::to_string(camera)}, {"matrix", matrix}}));
    return maker;
}

class Render : public testing::Test {
  protected:
    Render() { writeFile(model_, withCameras().glb()); }

    ProgramResult render(const std::vector<std::string>& more, const std::string& name = "picture.png") {
        std::vector<std::string> words{
            kProgram, "render", model_.string(), "--out", (scratch_ / name).string(), "--size", "160x120"};
        words.insert(words.end(), more.begin(), more.end());
        return runProgram(words, kValidated);
    }
    /// The bytes of a picture that must come out, without a word on stderr.
    std::string picture(const std::vector<std::string>& more) {
        const ProgramResult result = render(more);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return readFile(scratch_ / "picture.png");
    }
    PixelData pixelsOf(const std::vector<std::string>& more) {
        EXPECT_EQ(render(more).status, 0);
        PixelData pixels = readPicture(scratch_ / "picture.png");
        if (pixels.width != 160 || pixels.height != 120 || pixels.channels != 4) {
            ADD_FAILURE() << "a picture of another size";
            pixels = {.width = 160, .height = 120, .channels = 4, .bytes = {}};
            pixels.bytes.assign(size_t{4} * 160 * 120, std::byte{0});
        }
        return pixels;
    }
    /// Share of pixels that differ visibly.
    double difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
        return failingShare(pixelsOf(a), pixelsOf(b));
    }
    /// Share of pixels of a picture that are in neither of two others.
    double inNeither(const std::vector<std::string>& whole, const std::vector<std::string>& a,
                     const std::vector<std::string>& b) {
        const std::array<PixelData, 3> pictures{pixelsOf(whole), pixelsOf(a), pixelsOf(b)};
        int missed = 0;
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 160; ++x) {
                const auto same = [&](size_t i) {
                    bool all = true;
                    for (int c = 0; c < 4; ++c)
                        all = all && std::abs(pictures[0].value(x, y, c) - pictures[i].value(x, y, c)) <
                                         7.0f / 255.0f;
                    return all;
                };
                missed += same(1) || same(2) ? 0 : 1;
            }
        return missed / (160.0 * 120.0);
    }
    /// Four pictures a row.
    static PixelData sheet(const std::vector<PixelData>& pictures) {
        constexpr int kColumns = 4, kWidth = 160, kHeight = 120;
        const int rows = (static_cast<int>(pictures.size()) + kColumns - 1) / kColumns;
        PixelData all{.width = kColumns * kWidth, .height = rows * kHeight, .channels = 4, .bytes = {}};
        all.bytes.assign(static_cast<size_t>(4 * all.width * all.height), std::byte{255});
        for (size_t i = 0; i < pictures.size(); ++i) {
            const auto column = static_cast<int>(i) % kColumns, row = static_cast<int>(i) / kColumns;
            std::byte* const corner = all.bytes.data() + 4 * (row * kHeight * all.width + column * kWidth);
            for (int y = 0; y < kHeight; ++y)
                std::ranges::copy_n(pictures[i].bytes.begin() + 4 * y * kWidth, 4 * kWidth,
                                    corner + 4 * y * all.width);
        }
        return all;
    }
    void expectRefused(const std::vector<std::string>& more, const std::vector<std::string>& words) {
        const ProgramResult result = render(more, "refused.png");
        EXPECT_EQ(result.status, 1) << result.err;
        for (const std::string& word : words)
            EXPECT_NE(result.err.find(word), std::string::npos) << word << " is not in: " << result.err;
        EXPECT_FALSE(fs::exists(scratch_ / "refused.png"));
    }

    ScratchFolder scratch_;
    fs::path model_ = scratch_ / "corner.glb";
};

const std::vector<std::string> kPlaced{"--camera-position", "2,1.5,3", "--look-at", "0.5,0.5,0"};

/// kPlaced and further options.
std::vector<std::string> placedWith(const std::vector<std::string>& more) {
    std::vector<std::string> words = kPlaced;
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST_F(Render, WritesThePictureInTheSizeAskedFor) {
    const std::string shaded = (scratch_ / "a.png").string(), height = (scratch_ / "b.png").string();
    ASSERT_EQ(
        runProgram({kProgram, "render", kDoughnut, "--out", shaded, "--size", "320x200"}, kValidated).status,
        0);
    ASSERT_EQ(
        runProgram({kProgram, "render", kDoughnut, "--out", height, "--size", "320x200", "--view", "height"},
                   kValidated)
            .status,
        0);
    EXPECT_EQ(pngSize(readFile(shaded)), (std::pair<uint32_t, uint32_t>(320, 200)));
    EXPECT_NE(readFile(shaded), readFile(height));
}

/// What touch wears off is seen.
TEST_F(Render, ShowsTheModelAfterAStroke) {
    const std::string tooth = TOUCHSTONE_ASSETS "/plaque.glb";
    const auto drawn = [&](const std::string& name, std::vector<std::string> more) {
        more.insert(more.begin(),
                    {kProgram, "render", tooth, "--size", "240x180", "--out", (scratch_ / name).string()});
        const ProgramResult result = runProgram(more, kValidated);
        EXPECT_EQ(result.status, 0) << result.err;
        return result.out;
    };
    EXPECT_EQ(drawn("covered.png", {}).find("texture"), std::string::npos);
    const std::string brushed = drawn("brushed.png", {"--stroke", "tour", "--seconds", "3"});
    EXPECT_NE(brushed.find("tooth: coverage 9"), std::string::npos) << brushed;
    EXPECT_NE(brushed.find(" % removed"), std::string::npos) << brushed;
    EXPECT_NE(readFile(scratch_ / "covered.png"), readFile(scratch_ / "brushed.png"));
    EXPECT_EQ(
        runProgram({kProgram, "render", tooth, "--seconds", "3", "--out", (scratch_ / "x.png").string()})
            .status,
        2)
        << "of a stroke alone";
}

TEST_F(Render, WritesJpegToo) {
    ASSERT_EQ(render({}, "picture.jpg").status, 0);
    EXPECT_EQ(readFile(scratch_ / "picture.jpg").substr(0, 3), "\xff\xd8\xff");
    ASSERT_EQ(render({}, "picture.png").status, 0);
    EXPECT_LT(meanDifference(readPicture(scratch_ / "picture.jpg"), readPicture(scratch_ / "picture.png"), 3),
              0.02);
}

/// The same lens by the file and by hand is the same picture to the last byte, whichever way it is named.
TEST_F(Render, TheFilesCameraIsTheOneThatIsPlacedThere) {
    std::vector<std::string> byHand = kPlaced;
    byHand.insert(byHand.end(), {"--fov", "34.37746770784939"}); // 0.6 rad
    EXPECT_LT(difference({"--camera", "0"}, byHand), 1e-3);
    const std::string byIndex = picture({"--camera", "0"});
    EXPECT_EQ(picture({"--camera", "lens"}), byIndex);
    EXPECT_EQ(picture({"--camera", "stand0"}), byIndex);
    EXPECT_EQ(picture({"--camera", "0", "--view", "normals"}),
              picture({"--camera", "lens", "--view", "normals"}));
    EXPECT_GT(difference({"--camera", "0"}, {"--camera", "1"}), 0.01);
    EXPECT_EQ(picture({"--camera", "1"}), picture({"--camera", "stand1"}));
}

/// Far away and narrow, a perspective comes to the same picture as the parallel lines of sight.
TEST_F(Render, TheOrthographicCameraIsTheLimitOfALongLens) {
    // 10 times as far: off by the model's depth over the distance.
    const double nearer = 2.0 * std::atan(0.9 / 35.0) * 180.0 / 3.14159265358979324;
    EXPECT_LT(difference({"--camera", "1"}, {"--camera-position", "15.5,10.5,30", "--look-at", "0.5,0.5,0",
                                             "--fov", std::to_string(nearer)}),
              0.1);
}

TEST_F(Render, EveryOptionOfACameraChangesThePicture) {
    const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    EXPECT_GT(difference(kPlaced, with(kPlaced, {"--fov", "60"})), 0.05);
    EXPECT_GT(difference(kPlaced, with(kPlaced, {"--up", "1,0,0"})), 0.05);
    EXPECT_GT(difference(kPlaced, {"--camera-position", "2,1.5,3", "--look-at", "0.1,0.5,0"}), 0.05);
    EXPECT_GT(difference(kPlaced, {"--camera-position", "-2,1.5,3", "--look-at", "0.5,0.5,0"}), 0.05);
    EXPECT_EQ(picture(with(kPlaced, {"--up", "0,7,0"})), picture(kPlaced)) << "its length does not matter";
    // Without a target the model's centre: from (0, 0, 0) to (1, 1, 0.7) here.
    EXPECT_EQ(picture({"--camera-position", "3,4,5"}),
              picture({"--camera-position", "3,4,5", "--look-at", "0.5,0.5,0.35"}));
}

/// Every way to choose a camera, as we looked at it.
TEST_F(Render, CamerasAgainstTheirGoldenPictures) {
    std::vector<std::vector<std::string>> choices{{"--camera", "lens"},
                                                  {"--camera", "1"},
                                                  kPlaced,
                                                  placedWith({"--up", "1,0.3,0"}),
                                                  placedWith({"--fov", "60"})};
    for (const char* side : {"default", "front", "back", "right", "left", "top", "bottom"})
        choices.push_back({"--from", side});
    std::vector<PixelData> pictures;
    for (const std::vector<std::string>& choice : choices)
        pictures.push_back(pixelsOf(choice));
    constexpr double kMost = 0.0005; // of the sheet: 0.6 % of one picture
    expectMatchesGolden("render_cameras", sheet(pictures), kMost);
    const std::pair<size_t, std::vector<std::string>> mistakes[]{
        {0, {"--camera", "1"}},
        {3, placedWith({"--up", "1,0.2,0"})},
        {4, placedWith({"--fov", "57"})},
        {8, {"--from", "left"}},
    };
    for (const auto& [place, other] : mistakes) {
        std::vector<PixelData> wrong = pictures;
        wrong[place] = pixelsOf(other);
        expectMutationIsSeen("render_cameras", other.back(), sheet(wrong), kMost);
    }
}

TEST_F(Render, SeesTheModelFromEverySide) {
    std::set<std::string> seen;
    for (const char* side : {"default", "front", "back", "left", "right", "top", "bottom"})
        EXPECT_TRUE(seen.insert(picture({"--from", side})).second) << side;
    EXPECT_EQ(picture({"--from", "default"}), picture({}));
    EXPECT_NE(picture({"--from", "top", "--fov", "90"}), picture({"--from", "top"}));
    // From above the picture's top is the model's back.
    EXPECT_LT(difference({"--camera-position", "0.5,9,0.35", "--look-at", "0.5,0,0.35"},
                         {"--camera-position", "0.5,9,0.35", "--look-at", "0.5,0,0.35", "--up", "0,0,-1"}),
              1e-9);
}

/// Parallel lines of sight through the target's plane: the limit of a long lens from there.
TEST_F(Render, AnyCameraMayBeOrthographic) {
    const std::vector<std::string> parallel{"--projection", "orthographic"};
    const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    EXPECT_GT(difference(kPlaced, with(kPlaced, parallel)), 0.02);
    // The same target from 40 times as far: tan 20 deg / 40 is half the angle's tangent.
    EXPECT_LT(
        difference(with(kPlaced, {"--projection", "orthographic", "--fov", "40"}),
                   {"--camera-position", "60.5,40.5,120", "--look-at", "0.5,0.5,0", "--fov", "1.042669"}),
        0.005);
    EXPECT_GT(difference({"--from", "right"}, with(parallel, {"--from", "right"})), 0.01);
    EXPECT_EQ(picture({"--projection", "perspective"}), picture({}));
    EXPECT_EQ(render({"--projection", "fisheye"}).status, 2);
    EXPECT_EQ(render({"--camera", "0", "--projection", "orthographic"}).status, 2);
}

TEST_F(Render, DrawsAPartOfTheModel) {
    // The nodes of the corner have no names: "node 0" and on.
    const std::string whole = picture({});
    EXPECT_NE(picture({"--hide", "node 1"}), whole);
    EXPECT_EQ(picture({"--hide", "node 0", "--hide", "node 2"}), picture({"--isolate", "node 1"}));
    EXPECT_GT(difference({}, {"--clip", "1,0,0,0.5"}), 0.02);
    // What is seen of the whole lies on one side of the plane or on the other.
    EXPECT_LT(inNeither({}, {"--clip", "1,0,0,0.5"}, {"--clip", "-1,0,0,-0.5"}), 0.005);
    EXPECT_GT(inNeither({}, {"--clip", "1,0,0,0.4"}, {"--clip", "-1,0,0,-0.6"}), 0.02);
    EXPECT_EQ(picture({"--clip", "3,0,0,0.5"}), picture({"--clip", "1,0,0,0.5"}))
        << "a direction has no length";
    EXPECT_EQ(picture({"--clip", "1,0,0,5"}), whole) << "beyond the model";
    expectRefused({"--hide", "nose"}, {"--hide", "there is no object 'nose'", "node 0, node 1"});
    expectRefused({"--isolate", "nose"}, {"--isolate", "'nose'"});
    for (const char* plane :
         {"0,0,0,1", "1,0,0", "nan,0,0,1", "1,0,0,nan", "1,0,0,inf", "", "1,0,0,0,0", "x"}) {
        const ProgramResult result = render({"--clip", plane});
        EXPECT_EQ(result.status, 2) << plane << ": " << result.err;
        EXPECT_NE(result.err.find("--clip"), std::string::npos) << result.err;
    }
}

TEST_F(Render, DrawsEdgesAndTheGround) {
    EXPECT_GT(difference({}, {"--wireframe"}), 0.002);
    EXPECT_GT(difference({}, {"--grid"}), 0.02);
    std::vector<std::string> placed = kPlaced;
    placed.emplace_back("--grid");
    EXPECT_GT(difference(kPlaced, placed), 0.02) << "with a placed camera, too";
}

TEST_F(Render, AnImpossibleCameraIsRefused) {
    expectRefused({"--camera", "7"},
                  {"no camera '7'", "0 lens at the node stand0 (perspective)", "1 at the node stand1"});
    expectRefused({"--camera", "side"}, {"no camera 'side'", "orthographic"});
    expectRefused({"--camera", ""}, {"no camera ''"});
    // The target is the model's centre: only then is it known that nothing can be seen from there.
    expectRefused({"--camera-position", "0.5,0.5,0.35"}, {"at the point that it looks at"});
    expectRefused({"--camera-position", "0.5,0.5,2", "--up", "0,0,1"}, {"parallel"});
    expectRefused({"--camera-position", "0.5,0.5,2", "--up", "0,0,0"}, {"no length"});
    expectRefused({"--camera-position", "1e200,0,0"}, {"beyond what numbers can hold"});
    expectRefused({"--camera-position", "1e6,0,0"}, {"10,000 times", "inspect"});
    const std::string none = (scratch_ / "none.png").string();
    const ProgramResult result = runProgram({kProgram, "render", kDoughnut, "--out", none, "--camera", "0"});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("the scene has none"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(none));
}

/// A picture of nothing is drawn, and says so.
TEST_F(Render, WarnsOfAPictureWithoutTheModel) {
    for (const auto& [more, why] :
         {std::pair<std::vector<std::string>, const char*>{
              {"--camera-position", "0,0,3", "--look-at", "0,0,9"}, "behind the camera"},
          {{"--camera-position", "0,0,3", "--look-at", "9,0,3"}, "beside"},
          {{"--camera-position", "0,0,9000", "--fov", "90"}, "smaller than a pixel"}}) {
        const ProgramResult result = render(more);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    }
    EXPECT_NE(picture({"--camera-position", "0.3,0.3,0.2", "--look-at", "0,0,0"}), "")
        << "inside the model's box";
}

/// Neither a full disk nor a folder that takes no file leaves a part of a picture.
TEST_F(Render, AFailedPictureLeavesNothing) {
    fs::create_directory(scratch_ / "full");
    fs::create_symlink("/dev/full", scratch_ / "full/picture.png");
    const auto refused = [&](const std::string& file) {
        const ProgramResult result =
            runProgram({kProgram, "render", model_.string(), "--out", file}, kValidated);
        EXPECT_EQ(result.status, 1) << result.err;
        EXPECT_TRUE(result.out.empty()) << result.out;
        EXPECT_NE(result.err.find(file), std::string::npos) << result.err;
    };
    refused((scratch_ / "full/picture.png").string());
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch_ / "full"), fs::directory_iterator()), 1);
    refused("/proc/picture.png");
    refused((scratch_ / "nowhere/picture.png").string());
    fs::create_directory(scratch_ / "folder.png");
    refused((scratch_ / "folder.png").string());
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

} // namespace
} // namespace touchstone::test::render_tests
