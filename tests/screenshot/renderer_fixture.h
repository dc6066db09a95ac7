#pragma once

#include "renderer/scene_renderer.h"
#include "tests/screenshot/scenes.h"
#include "tests/support/lavapipe.h"

#include <gtest/gtest.h>

#include <memory>

namespace touchstone::test {

/// One headless device for a suite, with validation; any message of the layer fails the suite's last test.
class RendererFixture : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        useLavapipe();
        log_ = std::make_shared<ValidationLog>();
        GpuOptions options;
        options.validation = true;
        options.log = log_;
        gpu_ = Gpu::headless(options);
        renderer_ = std::make_unique<SceneRenderer>(*gpu_);
    }
    static void TearDownTestSuite() {
        renderer_.reset();
        gpu_.reset();
        EXPECT_TRUE(log_->messages().empty()) << "at the end of the device: " << log_->messages().front();
        log_.reset();
    }
    void SetUp() override {
        ASSERT_TRUE(gpu_->validationActive()) << gpu_->validationNote();
        seen_ = log_->messages().size();
    }
    void TearDown() override {
        const std::vector<std::string> messages = log_->messages();
        for (size_t i = seen_; i < messages.size(); ++i)
            ADD_FAILURE() << messages[i];
    }

    static constexpr int kWidth = 320, kHeight = 180;

    static PixelData draw(const ScenePtr& scene, const View& view, const Overlay& overlay = {},
                          int width = kWidth, int height = kHeight) {
        renderer_->setScene(scene);
        renderer_->render(view, overlay, width, height);
        return renderer_->readPixels();
    }

    static View viewFor(const Scene& scene) {
        constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
        return viewOf(cameraFor(scene, kAspect), {}, kAspect);
    }

    static glm::ivec3 at(const PixelData& pixels, int x, int y) {
        const size_t place =
            size_t{4} * (static_cast<size_t>(y) * static_cast<size_t>(pixels.width) + static_cast<size_t>(x));
        const auto byte = [&](size_t c) { return std::to_integer<int>(pixels.bytes[place + c]); };
        return {byte(0), byte(1), byte(2)};
    }

    static inline std::shared_ptr<ValidationLog> log_;
    static inline std::unique_ptr<Gpu> gpu_;
    static inline std::unique_ptr<SceneRenderer> renderer_;
    size_t seen_ = 0;
};

} // namespace touchstone::test
