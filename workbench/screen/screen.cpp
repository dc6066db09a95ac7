#include "workbench/screen/screen.h"

#include "workbench/screen/style.h"

#include <cstdio>

namespace touchstone {

namespace {

GpuOptions withLog(GpuOptions options) {
    if (options.log == nullptr)
        options.log = std::make_shared<ValidationLog>();
    return options;
}

} // namespace

Screen::Screen(Window& window, const GpuOptions& options)
    : window_(window), options_(withLog(options)), scale_(window.layoutScale()),
      gpu_(createGpuForWindow(window.handle(), options_)),
      target_(*gpu_, window.handle(), [this] { applyStyle(scale_); }),
      renderer_(std::make_unique<SceneRenderer>(*gpu_)) {}

Screen::~Screen() {
    drop(); // the validation layer may report on this
    for (const std::string& message : options_.log->messages())
        std::fprintf(stderr, "touchstone: validation: %s\n", message.c_str());
}

void Screen::drop() {
    renderer_.reset();
    target_.leaveDevice();
    gpu_.reset();
}

void Screen::renew(const DeviceLost& lost, double now) {
    std::string problem = lost.problem();
    for (;;) {
        drop();
        if (!losses_.mayReplace(now))
            throw Error("Vulkan", lost.place(),
                        "the graphics device was lost again and again (three times within ten seconds): " +
                            problem,
                        lost.remedy());
        try {
            gpu_ = createGpuForWindow(window_.handle(), options_);
            target_.takeDevice(*gpu_);
            renderer_ = std::make_unique<SceneRenderer>(*gpu_);
            return;
        } catch (const Error& error) {
            problem = error.problem();
        }
    }
}

void Screen::restyle(float scale) {
    if (scale == scale_)
        return;
    scale_ = scale;
    target_.leaveDevice(); // with the font's picture
    applyStyle(scale_);
    target_.takeDevice(*gpu_);
}

double Screen::busy() const {
    return renderer_->statistics().gpuSeconds + target_.statistics().gpuSeconds;
}

} // namespace touchstone
