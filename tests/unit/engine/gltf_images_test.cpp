#include "tests/support/encoded_image.h"
#include "tests/unit/engine/load_support.h"

#include <cmath>
#include <cstring>

namespace touchstone::gltf_images_test {
namespace {

using nlohmann::json;
using test::base64;
using test::contains;
using test::GltfMaker;
using test::load;
using test::warns;

const std::vector<uint8_t> kFourColours = {255, 0, 0, 10, 0, 255, 0, 20, 0, 0, 255, 200, 255, 255, 255, 255};

/// The square with the image as its base colour.
GltfMaker textured(const json& image) {
    GltfMaker maker = GltfMaker::square();
    maker.json["images"] = {image};
    maker.json["textures"] = {{{"source", 0}}};
    maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    maker.primitive()["material"] = 0;
    return maker;
}

GltfMaker texturedByView(const std::vector<uint8_t>& bytes, const char* type) {
    GltfMaker maker = textured({});
    maker.json["images"] = {{{"bufferView", maker.addView(bytes.data(), bytes.size())}, {"mimeType", type}}};
    return maker;
}

TEST(GltfImages, PngComesThroughAsStoredRowsFromTheTop) {
    const std::vector<uint8_t> png = test::encodedImage("a.png", 2, 2, 4, kFourColours);
    const auto check = [](const Scene& scene) {
        const PixelData& pixels = scene.images.at(0).pixels;
        ASSERT_TRUE(scene.images[0].decoded);
        ASSERT_EQ(pixels.width, 2);
        ASSERT_EQ(pixels.channels, 4);
        EXPECT_EQ(pixels.type, ComponentType::U8);
        EXPECT_EQ(std::memcmp(pixels.bytes.data(), kFourColours.data(), kFourColours.size()),
                  0);                           // alpha not multiplied in
        EXPECT_EQ(pixels.value(0, 1, 2), 1.0f); // second row: blue first
    };
    check(*load(texturedByView(png, "image/png")));
    check(*load(textured({{"uri", "data:image/png;base64," + base64(png)}})));
    test::TemporaryFolder folder;
    test::writeFile(folder.path() / "textures" / "my picture.png", png);
    const GltfMaker maker = textured({{"uri", "textures/my%20picture.png"}});
    check(*loadSceneFromMemory(maker.glb(), folder.path()));
}

TEST(GltfImages, SixteenBitsStaySixteen) {
    const std::vector<uint16_t> ramp = {0, 1, 256, 32768, 65534, 65535};
    const ScenePtr scene = load(texturedByView(test::encodedImage("a.png", 3, 2, 1, ramp), "image/png"));
    const PixelData& pixels = scene->images.at(0).pixels;
    ASSERT_EQ(pixels.type, ComponentType::U16);
    EXPECT_EQ(std::memcmp(pixels.bytes.data(), ramp.data(), 12), 0);
    EXPECT_NEAR(pixels.value(1, 0, 0), 1.0 / 65535.0, 1e-9);
}

TEST(GltfImages, FloatsStayFloats) {
    const std::vector<float> heights = {-1.5f, 0.0f, 0.25f, 1e6f};
    for (const char* name : {"a.exr", "a.tif"}) {
        const ScenePtr scene =
            load(texturedByView(test::encodedImage(name, 2, 2, 1, heights), "image/x-height"));
        const PixelData& pixels = scene->images.at(0).pixels;
        ASSERT_EQ(pixels.type, ComponentType::F32) << name << scene->images[0].problem;
        EXPECT_EQ(std::memcmp(pixels.bytes.data(), heights.data(), 16), 0) << name;
    }
}

TEST(GltfImages, JpegAndWebpDecode) {
    std::vector<uint8_t> grey(16 * 16 * 3, 128);
    const ScenePtr jpeg = load(texturedByView(test::encodedImage("a.jpg", 16, 16, 3, grey), "image/jpeg"));
    ASSERT_TRUE(jpeg->images.at(0).decoded) << jpeg->images[0].problem;
    EXPECT_NEAR(jpeg->images[0].pixels.value(8, 8, 1), 128.0 / 255.0, 0.02);

    GltfMaker maker = texturedByView(test::encodedImage("a.webp", 16, 16, 3, grey), "image/webp");
    maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {"EXT_texture_webp"};
    maker.json["textures"][0] = json::object();
    maker.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 0;
    const ScenePtr webp = load(maker);
    ASSERT_TRUE(webp->images.at(0).decoded) << webp->images[0].problem;
    EXPECT_NEAR(webp->images[0].pixels.value(8, 8, 1), 128.0 / 255.0, 0.02);
    maker.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 4;
    EXPECT_MENDED(maker, "textures[0].extensions.EXT_texture_webp.source", "images[4]");
}

void expectGrey(const Scene& scene, const std::string& why) {
    EXPECT_EQ(scene.triangleCount(), 2u);
    EXPECT_FALSE(scene.materials.at(0).baseColorTexture);
    EXPECT_EQ(glm::vec3(scene.materials[0].baseColor), glm::vec3(0.5f));
    EXPECT_TRUE(warns(scene, "images[0]", why)) << why;
    EXPECT_FALSE(scene.images.at(0).problem.empty());
    EXPECT_TRUE(scene.images[0].pixels.bytes.empty());
}

TEST(GltfImages, MissingOrBrokenOnesLeaveTheModelGreyWithAWarning) {
    expectGrey(*load(textured({{"uri", "nowhere.png"}})), "no such file");
    std::vector<uint8_t> png = test::encodedImage("a.png", 2, 2, 4, kFourColours);
    expectGrey(*load(texturedByView({'j', 'u', 'n', 'k'}, "image/png")), "format is not known");
    png.resize(png.size() / 2);
    expectGrey(*load(texturedByView(png, "image/png")), "cannot be used");
    std::vector<uint8_t> jpeg =
        test::encodedImage("a.jpg", 16, 16, 3, std::vector<uint8_t>(16 * 16 * 3, 128));
    jpeg.resize(40);
    expectGrey(*load(texturedByView(jpeg, "image/jpeg")), "cannot be used");
}

TEST(GltfImages, OneBadImageLeavesTheOthers) {
    GltfMaker maker = texturedByView(test::encodedImage("a.png", 2, 2, 4, kFourColours), "image/png");
    maker.json["images"].push_back({{"uri", "nowhere.png"}});
    maker.json["textures"].push_back({{"source", 1}});
    maker.json["materials"][0]["normalTexture"] = {{"index", 1}};
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->materials[0].baseColorTexture);
    EXPECT_FALSE(scene->materials[0].normalTexture);
    EXPECT_EQ(scene->materials[0].baseColor, glm::vec4(1.0f));
}

TEST(GltfImages, StructuralFaultsCostTheImageNotTheModel) {
    const auto lost = [](const json& image, const std::string& place, const std::string& why) {
        const ScenePtr scene = load(textured(image));
        EXPECT_EQ(scene->triangleCount(), 2u);
        EXPECT_TRUE(warns(*scene, place, why)) << test::warningsOf(*scene);
        EXPECT_FALSE(scene->images.at(0).decoded);
        EXPECT_FALSE(scene->materials.at(0).baseColorTexture);
    };
    lost({{"uri", "../a.png"}}, "images[0]", "leaves the model's folder");
    lost({{"uri", "/etc/passwd"}}, "images[0]", "absolute");
    lost({{"uri", "http://example.com/a.png"}}, "images[0]", "scheme");
    lost({{"uri", "data:image/png;base64,`"}}, "images[0]", "malformed");
    lost({{"uri", 7}}, "images[0].uri", "should be a string");
    lost({{"bufferView", 99}, {"mimeType", "image/png"}}, "images[0].bufferView", "bufferViews[99]");
    lost({{"bufferView", 0}}, "images[0]", "mimeType");
    lost({{"bufferView", 0}, {"uri", "a.png"}}, "images[0]", "both");
    lost({{"name", "x"}}, "images[0]", "neither");
    lost("a.png", "images[0]", "should be an object");
}

TEST(GltfImages, AFileOutsideTheModelsFolderIsNotRead) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.path() / "a.png", test::encodedImage("a.png", 2, 2, 4, kFourColours));
    GltfMaker maker = textured({{"uri", "../a.png"}});
    test::writeFile(folder.path() / "inner/model.glb", maker.glb());
    const ScenePtr scene = loadScene(folder.path() / "inner/model.glb");
    EXPECT_FALSE(scene->images.at(0).decoded);
    EXPECT_EQ(scene->triangleCount(), 2u);
    maker.json["images"][0]["uri"] = "a.png";
    test::writeFile(folder.path() / "model.glb", maker.glb());
    EXPECT_TRUE(loadScene(folder.path() / "model.glb")->images.at(0).decoded);
}

TEST(GltfImages, AByteStrideOfItsViewDoesNotMatter) {
    GltfMaker maker = texturedByView(test::encodedImage("a.png", 2, 2, 4, kFourColours), "image/png");
    maker.json["bufferViews"][maker.json["images"][0]["bufferView"].get<size_t>()]["byteStride"] = 4;
    EXPECT_MENDED(maker, "images[0].bufferView", "byteStride");
    EXPECT_TRUE(load(maker)->images.at(0).decoded);
    maker.json["images"][0].erase("mimeType");
    EXPECT_MENDED(maker, "images[0]", "no mimeType");
    EXPECT_TRUE(load(maker)->images.at(0).decoded);
}

TEST(GltfImages, AWrongTypeIsToldAndTheContentCounts) {
    const ScenePtr scene =
        load(texturedByView(test::encodedImage("a.png", 2, 2, 4, kFourColours), "image/jpeg"));
    EXPECT_TRUE(scene->images.at(0).decoded);
    EXPECT_TRUE(warns(*scene, "images[0]", "declared as image/jpeg but holds png"));
}

TEST(GltfImages, OnlyWhatIsUsedIsDecoded) {
    GltfMaker maker = texturedByView(test::encodedImage("a.png", 2, 2, 4, kFourColours), "image/png");
    maker.json["images"].push_back(maker.json["images"][0]); // nobody's
    LoadOptions options;
    ScenePtr scene = load(maker, options);
    EXPECT_TRUE(scene->images[0].decoded);
    EXPECT_FALSE(scene->images[1].decoded);
    EXPECT_TRUE(scene->images[1].problem.empty());
    options.images.visual = false;
    scene = load(maker, options);
    EXPECT_FALSE(scene->images[0].decoded); // the hand has no use for a colour
    EXPECT_TRUE(scene->materials[0].baseColorTexture);
}

TEST(GltfImages, BombsAreRefusedBeforeTheyAreUnpacked) {
    // 16384 x 16384 one-channel 16-bit zeros are half a gigabyte in a PNG of some hundred kilobytes: unpack
    // two rows only.
    GltfMaker maker = texturedByView(
        test::encodedImage("a.png", 16384, 1, 1, std::vector<uint16_t>(16384, 0)), "image/png");
    auto& bytes = maker.bytes;
    const size_t at = maker.json["bufferViews"].back()["byteOffset"];
    // IHDR's height is at byte 20 of a PNG, its checksum at 29; 16384 rows of 4 channels of 16 bits.
    bytes[at + 22] = 0x40;
    bytes[at + 23] = 0x00;
    bytes[at + 25] = 6;
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = at + 12; i < at + 29; ++i) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; ++k)
            crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    for (size_t k = 0; k < 4; ++k)
        bytes[at + 29 + k] = static_cast<uint8_t>(~crc >> (24 - 8 * k));
    expectGrey(*load(maker), "more memory than is allowed");
}

} // namespace
} // namespace touchstone::gltf_images_test
