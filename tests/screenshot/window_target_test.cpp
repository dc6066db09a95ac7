// The window's end of the renderer, in a real window of a virtual display.

#include <chrono>
#include <memory>
#include <thread>

#define GLFW_INCLUDE_NONE
#include "renderer/window_target.h"
#include "tests/screenshot/scenes.h"
#include "tests/support/lavapipe.h"
#include "tests/support/virtual_display.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

namespace touchstone::test {
namespace {

constexpr glm::ivec3 kPanelColor(20, 200, 40); ///< of the ImGui rectangle, bytes
constexpr double kNever = 1e9;                 ///< s; a period that no test outlives

/// The parameter: panels are kept, or all is drawn in every frame, as on a GPU.
class WindowTargetTest : public ::testing::TestWithParam<bool> {
  protected:
    void SetUp() override {
        useLavapipe();
        display_ = std::make_unique<VirtualDisplay>();
        ASSERT_TRUE(glfwInit());
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        window_ = glfwCreateWindow(640, 360, "test", nullptr, nullptr);
        ASSERT_NE(window_, nullptr);
        gpu_ = device();
        ASSERT_TRUE(gpu_->validationActive()) << gpu_->validationNote();
        target_ = std::make_unique<WindowTarget>(*gpu_, window_);
        target_->keepPanels(GetParam());
        scene_ = torusScene(64, 24);
        renderer_ = std::make_unique<SceneRenderer>(*gpu_);
        renderer_->setScene(scene_);
    }

    void TearDown() override {
        renderer_.reset();
        target_.reset();
        gpu_.reset();
        if (window_ != nullptr)
            glfwDestroyWindow(window_);
        glfwTerminate();
        for (const std::string& message : log_->messages())
            ADD_FAILURE() << message;
    }

    std::unique_ptr<Gpu> device() {
        GpuOptions options;
        options.validation = true;
        options.log = log_;
        return createGpuForWindow(window_, options);
    }
    /// Whether or not the one before has been left already; the renderer is gone.
    void takeAnotherDevice() {
        target_->leaveDevice();
        gpu_.reset();
        gpu_ = device();
        target_->takeDevice(*gpu_);
    }

    /// One frame: the scene in the right part of the window, a coloured rectangle of ImGui's in the left.
    bool frame(glm::ivec2 sceneSize = {320, 180}, glm::ivec3 panel = kPanelColor) {
        glfwPollEvents();
        if (!target_->beginFrame())
            return false;
        const glm::ivec2 size = target_->size();
        ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(0.0f, 0.0f),
                                                      ImVec2(100.0f, static_cast<float>(size.y)),
                                                      IM_COL32(panel.x, panel.y, panel.z, 255));
        const double aspect = static_cast<double>(size.x - 100) / size.y;
        renderer_->render(viewOf(cameraFor(*scene_, aspect), {}, aspect), Overlay{}, sceneSize.x,
                          sceneSize.y);
        target_->endFrame(renderer_.get(), {.main = {100, 0, size.x - 100, size.y}, .magnifier = {}});
        return true;
    }

    /// X answers requests when it likes: draws until `done`, at most a minute.
    template <class Done>
    bool drawUntil(Done&& done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (std::chrono::steady_clock::now() < end) {
            frame();
            if (done())
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    PixelData capture() {
        target_->requestCapture();
        std::optional<PixelData> pixels;
        drawUntil([&] { return (pixels = target_->takeCapture()).has_value(); });
        return pixels.value_or(PixelData{});
    }

    static glm::ivec3 at(const PixelData& pixels, int x, int y) {
        const size_t place =
            size_t{4} * (static_cast<size_t>(y) * static_cast<size_t>(pixels.width) + static_cast<size_t>(x));
        const auto byte = [&](size_t c) { return std::to_integer<int>(pixels.bytes[place + c]); };
        return {byte(0), byte(1), byte(2)};
    }

    std::shared_ptr<ValidationLog> log_ = std::make_shared<ValidationLog>();
    std::unique_ptr<VirtualDisplay> display_;
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Gpu> gpu_;
    std::unique_ptr<WindowTarget> target_;
    std::shared_ptr<Scene> scene_;
    std::unique_ptr<SceneRenderer> renderer_;
};

TEST_P(WindowTargetTest, ShowsPanelAndSceneByteForByte) {
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(frame());
    // Scene image and its place in the window have the same size: no filtering between them.
    const auto sameSize = [&] { return frame({540, 360}); };
    ASSERT_TRUE(sameSize());
    target_->requestCapture();
    ASSERT_TRUE(sameSize());
    const std::optional<PixelData> shown = target_->takeCapture();
    ASSERT_TRUE(shown.has_value());
    const PixelData drawn = renderer_->readPixels();
    ASSERT_EQ(shown->width, 640);
    ASSERT_EQ(shown->height, 360);
    EXPECT_EQ(at(*shown, 50, 180), kPanelColor) << "ImGui's colours arrive unchanged";
    int different = 0;
    for (int y = 0; y < 360; ++y)
        for (int x = 0; x < 540; ++x)
            different += at(*shown, 100 + x, y) != at(drawn, x, y);
    EXPECT_EQ(different, 0) << "the scene's bytes arrive unchanged";
    EXPECT_NE(at(drawn, 270, 180), at(drawn, 5, 5)) << "there is something to see";
}

TEST_P(WindowTargetTest, FollowsAResizeThatOnlyTheFramebufferSizeTells) {
    ASSERT_TRUE(frame());
    const uint64_t made = target_->statistics().swapchainsMade;
    glfwSetWindowSize(window_, 900, 500);
    ASSERT_TRUE(drawUntil([&] { return target_->size() == glm::ivec2(900, 500); }));
    EXPECT_GT(target_->statistics().swapchainsMade, made);
    const PixelData shown = capture();
    ASSERT_EQ(shown.width, 900);
    ASSERT_EQ(shown.height, 500);
    EXPECT_EQ(at(shown, 50, 490), kPanelColor) << "the whole of the new area is drawn";
    const uint64_t after = target_->statistics().swapchainsMade;
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(frame());
    EXPECT_EQ(target_->statistics().swapchainsMade, after) << "no swapchain is made without need";
    for (int i = 0; i < 20; ++i) {
        glfwSetWindowSize(window_, 400 + 20 * i, 300 + 10 * i);
        frame({160 + 8 * i, 90 + 8 * i});
    }
    EXPECT_TRUE(drawUntil([&] { return target_->size() == glm::ivec2(780, 490); }));
}

TEST_P(WindowTargetTest, DrawsNothingWhileMinimisedAndComesBack) {
    ASSERT_TRUE(frame());
    glfwHideWindow(window_);
    glfwIconifyWindow(window_);
    // Without a window manager nobody may answer the request; what counts is that frames go on or pause
    // cleanly.
    for (int i = 0; i < 10; ++i)
        frame();
    glfwShowWindow(window_);
    glfwRestoreWindow(window_);
    const uint64_t before = target_->statistics().framesPresented;
    EXPECT_TRUE(drawUntil([&] { return target_->statistics().framesPresented > before + 3; }));
}

TEST_P(WindowTargetTest, PanelsAreDrawnOnceInTheirPeriodAndThePictureInEveryFrame) {
    target_->keepPanels(GetParam(), kNever);
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(frame());
    if (!GetParam()) {
        EXPECT_EQ(target_->statistics().wholeFrames, target_->statistics().framesPresented);
        return;
    }
    // Another panel and another model.
    const glm::ivec3 other(200, 20, 90);
    renderer_->setScene(nullptr);
    target_->requestCapture();
    const uint64_t before = target_->statistics().wholeFrames;
    ASSERT_TRUE(frame({540, 360}, other));
    EXPECT_EQ(target_->statistics().wholeFrames, before);
    const PixelData shown = target_->takeCapture().value();
    EXPECT_EQ(at(shown, 50, 180), kPanelColor) << "not drawn again";
    EXPECT_EQ(at(shown, 99, 180), kPanelColor);
    int different = 0;
    const PixelData drawn = renderer_->readPixels();
    for (int x = 0; x < 540; ++x)
        different += at(shown, 100 + x, 180) != at(drawn, x, 180);
    EXPECT_EQ(different, 0) << "the picture is";
    target_->keepPanels(true, 0.0);
    target_->requestCapture();
    ASSERT_TRUE(frame({540, 360}, other));
    EXPECT_EQ(at(target_->takeCapture().value(), 50, 180), other) << "when the period is over";
    EXPECT_EQ(target_->statistics().wholeFrames, before + 1);
}

TEST_P(WindowTargetTest, PanelsAreDrawnAtOnceAfterAnyKey) {
    target_->keepPanels(true, kNever);
    const auto wholeOf = [&](int frames) {
        const uint64_t before = target_->statistics().wholeFrames;
        for (int i = 0; i < frames; ++i)
            EXPECT_TRUE(frame());
        return target_->statistics().wholeFrames - before;
    };
    wholeOf(5);
    ASSERT_EQ(wholeOf(3), 0u);
    const auto press = [](bool down) {
#if IMGUI_VERSION_NUM >= 18700
        ImGui::GetIO().AddKeyEvent(ImGuiKey_F, down);
#else
        ImGui::GetIO().KeysDown[GLFW_KEY_F] = down;
#endif
    };
    press(true);
    EXPECT_EQ(wholeOf(1), 1u) << "in this frame";
    EXPECT_EQ(wholeOf(2), 2u) << "and the next, which tell what came of it";
    EXPECT_EQ(wholeOf(3), 0u) << "not as long as it is held";
    press(false);
    EXPECT_EQ(wholeOf(1), 1u) << "let go";
}

TEST_P(WindowTargetTest, GoesOnWithAnotherDevice) {
    ASSERT_TRUE(frame());
    const uint64_t before = target_->statistics().framesPresented;
    ASSERT_TRUE(target_->beginFrame());
    renderer_.reset();
    target_->leaveDevice(); // in the middle of a frame
    takeAnotherDevice();
    renderer_ = std::make_unique<SceneRenderer>(*gpu_);
    renderer_->setScene(scene_);
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(frame());
    EXPECT_EQ(target_->statistics().framesPresented, before + 5);
    EXPECT_EQ(at(capture(), 50, 180), kPanelColor);
}

/// Red and green are the place in the picture, blue tells which.
PixelData smallPicture(int which) {
    PixelData picture{WindowTarget::kPictureWidth, WindowTarget::kPictureHeight, 4, ComponentType::U8, {}};
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            for (const int value : {x, y, which, 255})
                picture.bytes.push_back(static_cast<std::byte>(value));
    return picture;
}

TEST_P(WindowTargetTest, SmallPicturesAreShownByteForByteOnEveryDevice) {
    target_->keepPanels(GetParam(), 0.0);
    constexpr size_t kLast = WindowTarget::kPictures - 1;
    const glm::ivec2 corner{10, 20};
    // Two of them in an ImGui window, which cuts off half of the second, and a rectangle over the first.
    const auto pictured = [&] {
        glfwPollEvents();
        if (!target_->beginFrame())
            return false;
        ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
        ImGui::SetNextWindowSize(ImVec2(330.0f, 200.0f));
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
        ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
        ImGui::Begin("pictures", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::PopStyleVar(2);
        const glm::vec2 from(corner), size(WindowTarget::kPictureWidth, WindowTarget::kPictureHeight);
        target_->showPicture(0, from, from + size);
        ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(10.0f, 20.0f), ImVec2(30.0f, 40.0f),
                                                  IM_COL32(20, 200, 40, 255));
        target_->showPicture(kLast, from + glm::vec2(size.x + 10.0f, 0.0f),
                             from + glm::vec2(2.0f * size.x + 10.0f, size.y));
        target_->showPicture(5, from, from + size); // never set
        ImGui::End();
        target_->endFrame(nullptr, {});
        return true;
    };
    const auto expectPictures = [&](int first, const char* when) {
        for (int i = 0; i < 3; ++i)
            ASSERT_TRUE(pictured());
        target_->requestCapture();
        ASSERT_TRUE(pictured());
        const std::optional<PixelData> shown = target_->takeCapture();
        ASSERT_TRUE(shown.has_value());
        EXPECT_EQ(at(*shown, 15, 25), kPanelColor) << when << ": what comes later lies over it";
        int different = 0;
        for (int y = 0; y < WindowTarget::kPictureHeight; ++y)
            for (int x = 0; x < WindowTarget::kPictureWidth; ++x) {
                if (x >= 20 || y >= 20)
                    different += at(*shown, corner.x + x, corner.y + y) != glm::ivec3(x, y, first);
                const int second = corner.x + WindowTarget::kPictureWidth + 10 + x;
                if (second < 330)
                    different += at(*shown, second, corner.y + y) != glm::ivec3(x, y, 200);
                else
                    EXPECT_NE(at(*shown, second, corner.y + y).z, 200) << when << ": beyond the window";
            }
        EXPECT_EQ(different, 0) << when;
    };
    target_->setPicture(0, smallPicture(100));
    target_->setPicture(kLast, smallPicture(200));
    expectPictures(100, "at first");
    target_->setPicture(0, smallPicture(150));
    expectPictures(150, "another one in its place");
    EXPECT_THROW(target_->setPicture(0, PixelData{}), std::invalid_argument);
    EXPECT_THROW(target_->setPicture(WindowTarget::kPictures, smallPicture(0)), std::out_of_range);

    renderer_.reset();
    takeAnotherDevice();
    expectPictures(150, "on another device");
}

TEST_P(WindowTargetTest, CaptureIsOnlyThereWhenAsked) {
    ASSERT_TRUE(frame());
    EXPECT_FALSE(target_->takeCapture().has_value());
    EXPECT_GT(capture().width, 0);
    EXPECT_FALSE(target_->takeCapture().has_value());
}

TEST_P(WindowTargetTest, SceneMayBeMissing) {
    ASSERT_TRUE(target_->beginFrame());
    target_->endFrame(nullptr, {});
    EXPECT_TRUE(frame());
}

TEST_P(WindowTargetTest, ScenesAndModesChangeBetweenFrames) {
    ASSERT_TRUE(frame());
    renderer_->setScene(nullptr);
    ASSERT_TRUE(frame());
    renderer_->setScene(torusScene(24, 12));
    ASSERT_TRUE(frame({64, 64}));
    ASSERT_TRUE(frame({512, 256}));
}

INSTANTIATE_TEST_SUITE_P(Panels, WindowTargetTest, testing::Bool(),
                         [](const auto& kept) { return std::string(kept.param ? "Kept" : "InEveryFrame"); });

} // namespace
} // namespace touchstone::test
