#pragma once
// The window's panels on a virtual display.

#define GLFW_INCLUDE_NONE
#include "renderer/window_target.h"
#include "tests/screenshot/panel_figures.h"
#include "tests/support/lavapipe.h"
#include "tests/support/virtual_display.h"
#include "workbench/screen/style.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace touchstone::test {

class PanelWindow : public ::testing::Test, protected PanelFigures {
  protected:
    void SetUp() override {
        useLavapipe();
        display_ = std::make_unique<VirtualDisplay>(screen_);
        ASSERT_TRUE(glfwInit());
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        window_ = glfwCreateWindow(size_.x, size_.y, "panels", nullptr, nullptr);
        ASSERT_NE(window_, nullptr);
        glfwSetCursorPos(window_, 0.5 * size_.x, 0.417 * size_.y); // over the picture: nothing is hovered
        gpu_ = createGpuForWindow(window_, {});
        target_ = std::make_unique<WindowTarget>(*gpu_, window_, [this] { applyStyle(input_.scale); });
        target_->keepPanels(true, 0.0); // all in every frame
    }
    void TearDown() override {
        target_.reset();
        gpu_.reset();
        if (window_ != nullptr)
            glfwDestroyWindow(window_);
        glfwTerminate();
    }

    /// Draws a frame; `more` after the panels.
    void frame(const std::function<void(Widgets&)>& more = {}) {
        glfwPollEvents();
        if (!target_->beginFrame())
            return;
        rects_ = drawPanels(input_, state_);
        Widgets widgets(input_.scale);
        if (more)
            more(widgets);
        rects_.merge(widgets.take());
        target_->endFrame(nullptr, {});
    }
    /// The window after some frames, with which ImGui's sizes have come to rest.
    PixelData window(const std::function<void(Widgets&)>& more = {}) {
        constexpr int kFrames = 4;
        for (int i = 0; i < kFrames; ++i)
            frame(more);
        target_->requestCapture();
        for (int i = 0; i < 100; ++i) {
            frame(more);
            if (std::optional<PixelData> pixels = target_->takeCapture())
                return *std::move(pixels);
        }
        return {};
    }

    const char* screen_ = "1280x800x24"; ///< of the virtual display
    glm::ivec2 size_{1100, 720};         ///< of the window
    std::unique_ptr<VirtualDisplay> display_;
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Gpu> gpu_;
    std::unique_ptr<WindowTarget> target_;
};

} // namespace touchstone::test
