#include "engine/load/async_load.h"

#include <exception>
#include <utility>

namespace touchstone {

AsyncLoad::AsyncLoad(std::filesystem::path path, LoadOptions options)
    : path_(std::move(path)), worker_([this, kept = std::move(options)] { work(kept); }) {}

AsyncLoad::~AsyncLoad() {
    cancel();
    if (worker_.joinable())
        worker_.join();
}

void AsyncLoad::work(LoadOptions options) noexcept {
    options.cancel = &cancel_;
    options.progress = [this](double fraction, const char* what) {
        fraction_.store(fraction, std::memory_order_relaxed);
        what_.store(what, std::memory_order_relaxed);
    };
    try {
        scene_ = loadScene(path_, options);
    } catch (...) {
        problem_ = std::current_exception();
    }
    finished_.store(true, std::memory_order_release);
}

AsyncLoad::Progress AsyncLoad::progress() const noexcept {
    return {fraction_.load(std::memory_order_relaxed), what_.load(std::memory_order_relaxed)};
}

bool AsyncLoad::finished() const noexcept {
    return finished_.load(std::memory_order_acquire);
}

void AsyncLoad::cancel() noexcept {
    cancel_.store(true, std::memory_order_relaxed);
}

ScenePtr AsyncLoad::take() {
    if (worker_.joinable())
        worker_.join();
    if (problem_)
        std::rethrow_exception(std::exchange(problem_, nullptr));
    return std::exchange(scene_, nullptr);
}

} // namespace touchstone
