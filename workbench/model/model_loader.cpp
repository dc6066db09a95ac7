#include "workbench/model/model_loader.h"

#include "devices/stroke/stroke_library.h"
#include "engine/core/error.h"
#include "engine/import/volume_file/volume_edits.h"
#include "renderer/scene_renderer.h"

#include <sys/resource.h>

#include <utility>

namespace touchstone {

namespace {
constexpr int kNiceness = 10; ///< on few cores the window has priority
}

ModelLoader::~ModelLoader() {
    abandon();
    if (worker_.joinable())
        worker_.join();
}

void ModelLoader::abandon() {
    cancelled_.store(true, std::memory_order_relaxed);
    next_.reset();
}

void ModelLoader::start(const std::filesystem::path& path, const SceneChoice& choice) {
    path_ = path;
    if (!worker_.joinable())
        return begin({path, choice});
    abandon();
    next_ = Request{path, choice};
}

std::shared_ptr<const StrokePath> tourOver(const Scene& scene, const Similarity& workspaceFromScene) {
    try {
        return std::make_shared<StrokePath>(layStroke(scene, workspaceFromScene, {}));
    } catch (const Error&) {
        return nullptr;
    }
}

void ModelLoader::begin(const Request& request) {
    cancelled_.store(false, std::memory_order_relaxed);
    finished_.store(false, std::memory_order_relaxed);
    fraction_.store(0.0, std::memory_order_relaxed);
    result_.reset();
    failure_ = nullptr;
    worker_ = std::thread([this, request, device = device_] {
        // For this thread and those that it starts; if refused, loading competes with rendering.
        (void)::setpriority(PRIO_PROCESS, 0, kNiceness);
        LoadOptions options;
        options.cancel = &cancelled_;
        options.progress = [this](double fraction, const char* what) {
            fraction_.store(fraction, std::memory_order_relaxed);
            activity_.store(what, std::memory_order_relaxed);
        };
        try {
            // For a million triangles on two cores; the simplification is by far the longest.
            const Progress whole(&options.progress, &cancelled_);
            LoadOptions loading = options;
            loading.iso = request.choice.iso;
            loading.volume = request.choice.volume;
            loading.animation = request.choice.animation;
            if (request.choice.loose)
                loading.edits = withLoose({});
            loading.progress = [&](double fraction, const char* what) {
                whole.report(0.25 * fraction, what);
            };
            LoadedModel loaded{loadModel(request.path, Fit::Workspace, loading), nullptr, {}, nullptr};
            if (loaded.model.scene->touchable()) {
                constexpr double kTimePerTriangle = 1e-7; // s
                const EstimatedProgress estimate(
                    whole.part(0.25, 0.29), "laying the stroke",
                    kTimePerTriangle * static_cast<double>(loaded.model.scene->triangleCount()));
                loaded.path = tourOver(*loaded.model.scene, loaded.model.workspaceFromScene);
            }
            whole.step(0.29, "knowing the model again");
            loaded.identity = identify(*loaded.model.haptic, *loaded.model.scene, Fit::Workspace);
            PrepareOptions prepare{.cancel = &cancelled_, .progress = whole.part(0.3, 1.0)};
            if (request.choice.volume != nullptr)
                prepare.coarsest = 0; // another surface of a volume that is shown: no time to simplify it
            loaded.prepared = prepareScene(loaded.model.scene, prepare);
            if (!device.empty() && !cancelled_.load(std::memory_order_relaxed))
                compileAhead(device, loaded.prepared);
            result_ = std::move(loaded);
        } catch (...) {
            failure_ = std::current_exception();
        }
        finished_.store(true, std::memory_order_release);
    });
}

std::optional<LoadedModel> ModelLoader::take() {
    if (!worker_.joinable() || !finished_.load(std::memory_order_acquire))
        return std::nullopt;
    worker_.join();
    if (cancelled_.load(std::memory_order_relaxed)) {
        failure_ = nullptr;
        result_.reset();
        if (const std::optional<Request> next = std::exchange(next_, std::nullopt))
            begin(*next);
        return std::nullopt;
    }
    if (failure_)
        std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(result_, std::nullopt);
}

std::string ModelLoader::activity() const {
    return activity_.load(std::memory_order_relaxed);
}

} // namespace touchstone
