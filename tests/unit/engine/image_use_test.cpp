// Images that no effect needs are never decoded: every decode is counted where it is made.

#include "engine/import/file/image_decode.h"
#include "tests/support/encoded_image.h"
#include "tests/unit/engine/load_support.h"

#include <set>

namespace touchstone::image_use_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;

enum Role { Base, Roughness, Normal, Occlusion, Emissive, Height, Friction, Stiffness, Damping, Nobodys };
constexpr int kRoles = 10;

/// A square whose material has an image for everything.
GltfMaker everyMap() {
    GltfMaker maker = GltfMaker::square();
    const std::vector<uint8_t> png =
        test::encodedImage("a.png", 2, 2, 3, std::vector<uint8_t>(12, uint8_t{128}));
    const auto map = [](int index) { return json{{"index", index}}; };
    for (int i = 0; i < kRoles; ++i) {
        maker.append("images",
                     {{"bufferView", maker.addView(png.data(), png.size())}, {"mimeType", "image/png"}});
        maker.append("textures", {{"source", i}});
    }
    json haptic = {{"heightTexture", map(Height)},
                   {"frictionTexture", map(Friction)},
                   {"stiffnessTexture", map(Stiffness)},
                   {"dampingTexture", map(Damping)}};
    haptic["heightTexture"]["scale"] = 0.001;
    maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
    maker.json["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", map(Base)}, {"metallicRoughnessTexture", map(Roughness)}}},
         {"normalTexture", map(Normal)},
         {"occlusionTexture", map(Occlusion)},
         {"emissiveTexture", map(Emissive)},
         {"extensions", {{"TOUCHSTONE_materials_haptic", haptic}}}}};
    maker.primitive()["material"] = 0;
    return maker;
}

json& haptic(GltfMaker& maker) {
    return maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"];
}

/// The images that a load decodes: as many as the decoder counted, each once.
std::set<int> decodedBy(const GltfMaker& maker, bool eye, bool hand) {
    LoadOptions options;
    options.images = {.visual = eye, .haptic = hand};
    const uint64_t before = imageDecodes();
    const ScenePtr scene = load(maker, options);
    const uint64_t count = imageDecodes() - before;
    std::set<int> decoded;
    for (size_t i = 0; i < scene->images.size(); ++i) {
        EXPECT_EQ(scene->images[i].problem, "");
        EXPECT_EQ(scene->images[i].decoded, !scene->images[i].pixels.bytes.empty());
        EXPECT_EQ(scene->images[i].width, 2) << "the header is read in any case";
        if (scene->images[i].decoded)
            decoded.insert(static_cast<int>(i));
    }
    EXPECT_EQ(count, decoded.size());
    return decoded;
}

using Images = std::set<int>;

TEST(ImageUse, EyeAndHandDecodeTheirOwnAndNobodyTheRest) {
    const GltfMaker maker = everyMap();
    EXPECT_EQ(decodedBy(maker, false, false), Images{});
    EXPECT_EQ(decodedBy(maker, true, false), (Images{Base, Roughness, Normal, Occlusion, Emissive}));
    EXPECT_EQ(decodedBy(maker, false, true),
              (Images{Roughness, Normal, Height, Friction, Stiffness, Damping}));
    EXPECT_EQ(decodedBy(maker, true, true),
              (Images{Base, Roughness, Normal, Occlusion, Emissive, Height, Friction, Stiffness, Damping}));
}

TEST(ImageUse, AnEffectThatIsOffNeedsNoImage) {
    GltfMaker maker = everyMap();
    haptic(maker)["staticFriction"] = 0.5;
    haptic(maker)["dynamicFriction"] = 0.4;
    EXPECT_EQ(decodedBy(maker, false, true), (Images{Normal, Height, Friction, Stiffness, Damping}))
        << "stated friction is not derived from roughness";
    haptic(maker)["normalTextureInfluence"] = 0.0;
    EXPECT_EQ(decodedBy(maker, false, true), (Images{Height, Friction, Stiffness, Damping}));
    haptic(maker)["normalTextureInfluence"] = 0.5;
    maker.json["materials"][0]["normalTexture"]["scale"] = 0.0;
    EXPECT_EQ(decodedBy(maker, false, true), (Images{Height, Friction, Stiffness, Damping}));
    haptic(maker)["heightTexture"]["scale"] = 0.0;
    EXPECT_EQ(decodedBy(maker, false, true), (Images{Friction, Stiffness, Damping}));
    haptic(maker).erase("frictionTexture");
    haptic(maker).erase("stiffnessTexture");
    haptic(maker).erase("dampingTexture");
    EXPECT_EQ(decodedBy(maker, false, true), Images{});
}

TEST(ImageUse, AMapThatCannotBeFeltIsNotDecoded) {
    GltfMaker maker = everyMap();
    haptic(maker)["heightTexture"]["texCoord"] = 1; // which the square has not
    EXPECT_EQ(decodedBy(maker, false, true), (Images{Roughness, Normal, Friction, Stiffness, Damping}));
    maker.primitive()["attributes"].erase("TEXCOORD_0");
    EXPECT_EQ(decodedBy(maker, false, true), Images{Roughness});
    GltfMaker unplaced = everyMap();
    unplaced.json["nodes"][0].erase("mesh");
    EXPECT_EQ(decodedBy(unplaced, true, true), Images{}) << "no triangle has the material";
}

TEST(ImageUse, WhatTwoMaterialsShareIsDecodedOnce) {
    GltfMaker maker = everyMap();
    maker.json["materials"].push_back(maker.json["materials"][0]);
    json second = maker.primitive();
    second["material"] = 1;
    maker.json["meshes"][0]["primitives"].push_back(second);
    EXPECT_EQ(decodedBy(maker, false, true),
              (Images{Roughness, Normal, Height, Friction, Stiffness, Damping}));
}

} // namespace
} // namespace touchstone::image_use_test
