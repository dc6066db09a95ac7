// What the renderer does when its device is lost, in a real window of a virtual display.

#include "renderer/scene_renderer.h"
#include "renderer/window_target.h"
#include "tests/screenshot/scenes.h"
#include "tests/support/device_loss.h"
#include "tests/support/lavapipe.h"
#include "tests/support/virtual_display.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

namespace touchstone::test {
namespace {

class DeviceLossTest : public ::testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        useLavapipe();
        loss_.useHere();
        display_ = std::make_unique<VirtualDisplay>();
        ASSERT_TRUE(glfwInit());
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        window_ = glfwCreateWindow(640, 360, "test", nullptr, nullptr);
        ASSERT_NE(window_, nullptr);
        takeDevice();
    }
    void TearDown() override {
        dropDevice();
        target_.reset();
        if (window_ != nullptr)
            glfwDestroyWindow(window_);
        glfwTerminate();
        for (const std::string& message : log_->messages())
            ADD_FAILURE() << message;
    }

    void takeDevice() {
        GpuOptions options;
        options.validation = true;
        options.log = log_;
        gpu_ = createGpuForWindow(window_, options);
        ASSERT_TRUE(gpu_->validationActive()) << gpu_->validationNote();
        if (target_ == nullptr)
            target_ = std::make_unique<WindowTarget>(*gpu_, window_);
        else
            target_->takeDevice(*gpu_);
        renderer_ = std::make_unique<SceneRenderer>(*gpu_);
    }
    void dropDevice() {
        renderer_.reset();
        if (target_ != nullptr)
            target_->leaveDevice();
        gpu_.reset();
    }

    void frame() {
        glfwPollEvents();
        ASSERT_TRUE(target_->beginFrame());
        ImGui::GetForegroundDrawList()->AddText(ImVec2(20.0f, 20.0f), IM_COL32_WHITE, "still here");
        const double aspect = 640.0 / 360.0;
        View view = viewOf(cameraFor(*scene_, aspect), {}, aspect);
        view.mode = mode_;
        renderer_->render(view, touchOverlay(), 320, 180);
        target_->endFrame(renderer_.get(), {.main = {0, 0, 640, 360}, .magnifier = {}});
    }

    ScratchFolder scratch_;
    DeviceLoss loss_{scratch_ / "loss"};
    std::shared_ptr<ValidationLog> log_ = std::make_shared<ValidationLog>();
    std::unique_ptr<VirtualDisplay> display_;
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Gpu> gpu_;
    std::unique_ptr<WindowTarget> target_;
    std::unique_ptr<SceneRenderer> renderer_;
    std::shared_ptr<Scene> scene_ = torusScene(64, 24);
    ViewMode mode_ = ViewMode::Shaded;
};

class DeviceLossAt : public DeviceLossTest {};

TEST_P(DeviceLossAt, IsToldAsSuchAndAnotherDeviceDrawsTheSame) {
    renderer_->setScene(scene_);
    for (int i = 0; i < 4; ++i)
        frame();
    const PixelData before = renderer_->readPixels();
    loss_.lose(GetParam(), 3);
    EXPECT_THROW(
        {
            for (int i = 0; i < 10; ++i)
                frame();
        },
        DeviceLost);
    EXPECT_TRUE(loss_.lost());
    dropDevice();
    takeDevice();
    renderer_->setScene(scene_);
    for (int i = 0; i < 4; ++i)
        frame();
    EXPECT_EQ(renderer_->readPixels().bytes, before.bytes);
}

INSTANTIATE_TEST_SUITE_P(Call, DeviceLossAt,
                         testing::Values("submit", "present", "acquire", "wait", "surface"),
                         [](const auto& call) { return std::string(call.param); });

TEST_F(DeviceLossTest, WhileASceneIsTakenIn) {
    renderer_->setScene(scene_);
    frame();
    for (const int step : {1, 2, 4, 8, 12}) {
        loss_.lose("submit", step);
        EXPECT_THROW(renderer_->setScene(featureBoard()), DeviceLost) << step;
        dropDevice();
        takeDevice();
        EXPECT_FALSE(renderer_->hasScene());
        frame();
    }
    renderer_->setScene(featureBoard());
    EXPECT_TRUE(renderer_->hasScene());
    frame();
}

TEST_F(DeviceLossTest, WhileAFalseColourViewIsMadeAndAWindowIsRead) {
    renderer_->setScene(scene_);
    frame();
    mode_ = ViewMode::Height;
    loss_.lose("submit");
    EXPECT_THROW(frame(), DeviceLost);
    dropDevice();
    takeDevice();
    renderer_->setScene(scene_);
    target_->requestCapture();
    loss_.lose("present");
    EXPECT_THROW(frame(), DeviceLost);
    dropDevice();
    takeDevice();
    renderer_->setScene(scene_);
    frame();
    frame();
}

TEST_F(DeviceLossTest, AllThatIsLeftIsToEndIt) {
    renderer_->setScene(scene_);
    frame();
    loss_.lose("submit");
    EXPECT_THROW(frame(), DeviceLost);
    EXPECT_THROW(renderer_->setScene(scene_), DeviceLost) << "it stays lost";
    EXPECT_THROW((void)renderer_->readPixels(), DeviceLost);
    renderer_->abandonScene();
    renderer_->setScene(nullptr);
    dropDevice();
}

TEST_F(DeviceLossTest, ADeviceThatCannotBeMadeIsToldAsLost) {
    dropDevice();
    loss_.lose("create");
    EXPECT_THROW((void)createGpuForWindow(window_, {}), DeviceLost);
    takeDevice();
    renderer_->setScene(scene_);
    frame();
}

} // namespace
} // namespace touchstone::test
