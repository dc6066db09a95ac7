#include "tests/unit/workbench/gui_context.h"
#include "workbench/screen/gui_pixels.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <stdexcept>

namespace touchstone::gui_pixels_test {
namespace {

PixelData grey(int width, int height, int value) {
    PixelData picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 4;
    for (int i = 0; i < width * height; ++i)
        for (const int channel : {value, value, value, 255})
            picture.bytes.push_back(static_cast<std::byte>(channel));
    return picture;
}

int at(const PixelData& picture, int x, int y, int channel) {
    return std::to_integer<int>(picture.bytes[static_cast<size_t>(4 * (y * picture.width + x) + channel)]);
}

/// Two triangles make a rectangle: each pixel is blended once, none outside.
TEST(GuiPixels, ARectangleCoversItsPixelsOnce) {
    PixelData picture = grey(40, 30, 100);
    drawGui(picture, 1.0f, [] {
        ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(5, 7), ImVec2(33, 21),
                                                      IM_COL32(200, 0, 100, 128));
    });
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const bool inside = x >= 5 && x < 33 && y >= 7 && y < 21;
            EXPECT_NEAR(at(picture, x, y, 0), inside ? 150 : 100, 1) << x << " " << y;
            EXPECT_NEAR(at(picture, x, y, 1), inside ? 50 : 100, 1) << x << " " << y;
            EXPECT_EQ(at(picture, x, y, 3), 255);
        }
}

TEST(GuiPixels, WhatReachesOutsideIsCut) {
    PixelData picture = grey(8, 8, 0);
    drawGui(picture, 1.0f, [] {
        ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(-50, -50), ImVec2(4, 400),
                                                      IM_COL32(255, 255, 255, 255));
    });
    EXPECT_EQ(at(picture, 0, 0, 0), 255);
    EXPECT_EQ(at(picture, 3, 7, 0), 255);
    EXPECT_EQ(at(picture, 4, 0, 0), 0);
}

/// Text has the size of its scale: its ink grows with the square.
TEST(GuiPixels, TextIsMadeForItsScale) {
    const auto ink = [](float scale) {
        PixelData picture = grey(static_cast<int>(120 * scale), static_cast<int>(40 * scale), 0);
        drawGui(picture, scale, [&] {
            ImGui::GetBackgroundDrawList()->AddText(ImVec2(4 * scale, 4 * scale),
                                                    IM_COL32(255, 255, 255, 255), "tilt 30");
        });
        double sum = 0.0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                sum += at(picture, x, y, 0) / 255.0;
        return sum;
    };
    const double small = ink(1.0f), large = ink(4.0f);
    EXPECT_GT(small, 30.0);
    EXPECT_NEAR(large / small, 16.0, 3.0);
}

/// In the middle of another context's frame, which then ends as it began.
TEST(GuiPixels, LeavesTheCurrentContextInItsFrame) {
    const test::GuiContext window(ImVec2(100, 100));
    ImGui::NewFrame();
    ImGui::Begin("a window");
    PixelData picture = grey(8, 8, 0);
    drawGui(picture, 1.0f, [] {});
    EXPECT_EQ(ImGui::GetCurrentContext(), window.get());
    EXPECT_EQ(picture.bytes, grey(8, 8, 0).bytes);
    ImGui::End();
    ImGui::Render();
    EXPECT_THROW(drawGui(picture, 1.0f, [] { throw std::runtime_error("broken"); }), std::runtime_error);
    EXPECT_EQ(ImGui::GetCurrentContext(), window.get());
}

} // namespace
} // namespace touchstone::gui_pixels_test
