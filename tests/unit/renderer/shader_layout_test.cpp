// The structs that C++ and GLSL share: offsets as the compiler of the shaders sees them, read out of the
// SPIR-V.

#include "renderer/shader_code.h"
#include "shaders/shared/scene_types.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <span>
#include <string>

namespace touchstone {
namespace {

/// Struct name -> member name -> offset in bytes; from OpName (5), OpMemberName (6) and OpMemberDecorate (72)
/// Offset (35) of the SPIR-V specification.
using Layouts = std::map<std::string, std::map<std::string, uint32_t>>;

std::string text(std::span<const uint32_t> words) {
    return {reinterpret_cast<const char*>(words.data())}; // zero-terminated within the instruction
}

Layouts layoutsOf(std::span<const uint32_t> code) {
    std::map<uint32_t, std::string> names;
    std::map<std::pair<uint32_t, uint32_t>, std::string> members;
    Layouts layouts;
    for (size_t i = 5; i < code.size();) {
        const uint32_t count = code[i] >> 16, operation = code[i] & 0xffff;
        const auto words = code.subspan(i, count);
        if (operation == 5)
            names[words[1]] = text(words.subspan(2));
        if (operation == 6)
            members[{words[1], words[2]}] = text(words.subspan(3));
        if (operation == 72 && words[3] == 35)
            layouts[names[words[1]]][members[{words[1], words[2]}]] = words[4];
        i += count;
    }
    return layouts;
}

#define EXPECT_SAME_PLACE(layouts, type, member)                                                             \
    EXPECT_EQ((layouts).at(#type).at(#member), offsetof(shared::type, member)) << #type << "::" << #member

TEST(ShaderLayout, FrameUniforms) {
    const Layouts layouts = layoutsOf(shaders::scene_frag);
    ASSERT_TRUE(layouts.count("FrameUniforms"));
    EXPECT_EQ(layouts.at("FrameUniforms").size(), 22u) << "a member that this test does not know";
    EXPECT_SAME_PLACE(layouts, FrameUniforms, clipFromEye);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, eyeFromClip);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, toLight0);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, toLight1);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, irradiance0);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, irradiance1);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, irradiance);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, irradianceSquares);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, irradianceColor);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, environment);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, horizon);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, skyRise);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, rim);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, floorFall);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, lampAxis);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, lampRadiance);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, probe);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, backgroundTop);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, backgroundBottom);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, image);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, toEye);
    EXPECT_SAME_PLACE(layouts, FrameUniforms, toViewer);
}

TEST(ShaderLayout, MaterialUniforms) {
    const Layouts layouts = layoutsOf(shaders::scene_frag);
    ASSERT_TRUE(layouts.count("MaterialUniforms"));
    EXPECT_EQ(layouts.at("MaterialUniforms").size(), 10u);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, baseColor);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, emissiveCutoff);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, factors);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, specularGlossiness);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, dielectric);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, layers);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, sheenColorThickness);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, absorption);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, uvLinear);
    EXPECT_SAME_PLACE(layouts, MaterialUniforms, uvOffset);
}

TEST(ShaderLayout, FalseColorUniforms) {
    const Layouts layouts = layoutsOf(shaders::false_color_frag);
    ASSERT_TRUE(layouts.count("FalseColorUniforms"));
    EXPECT_EQ(layouts.at("FalseColorUniforms").size(), 3u);
    EXPECT_SAME_PLACE(layouts, FalseColorUniforms, map);
    EXPECT_SAME_PLACE(layouts, FalseColorUniforms, uvLinear);
    EXPECT_SAME_PLACE(layouts, FalseColorUniforms, uvOffset);
}

TEST(ShaderLayout, ObjectConstants) {
    const Layouts layouts = layoutsOf(shaders::scene_vert);
    ASSERT_TRUE(layouts.count("ObjectConstants"));
    EXPECT_SAME_PLACE(layouts, ObjectConstants, eyeFromMesh);
    EXPECT_SAME_PLACE(layouts, ObjectConstants, normalFromMesh);
    EXPECT_SAME_PLACE(layouts, ObjectConstants, clip);
    EXPECT_LE(sizeof(shared::ObjectConstants), 128u)
        << "every Vulkan device has this much for push constants";
}

} // namespace
} // namespace touchstone
