#pragma once

#include "devices/stroke/stroke_path.h"
#include "haptics/recording/scene_identity.h"
#include "renderer/prepared_scene.h"
#include "workbench/model/model.h"

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace touchstone {

/// The simulated hand's tour; null where it finds no place to press: the model may still be touched.
[[nodiscard]] std::shared_ptr<const StrokePath> tourOver(const Scene& scene,
                                                         const Similarity& workspaceFromScene);

/// A model with the stroke of the simulated hand (null where there is nothing to touch).
struct LoadedModel {
    Model model;
    std::shared_ptr<const StrokePath> path;
    SceneIdentity identity;                        ///< for recordings
    std::shared_ptr<const PreparedScene> prepared; ///< for the renderer
};

/// Of a volume: LoadOptions::iso and LoadOptions::volume; of any scene LoadOptions::animation.
struct SceneChoice {
    std::optional<double> iso{};
    std::shared_ptr<const Volume> volume{};
    std::optional<std::string> animation{};
    bool loose = false; ///< every object is a body (loosen)
};

/// Loads models on a worker thread, one at a time: a new request cancels the current one and starts when that
/// has ended. Main thread only; only the destructor waits for the worker.
class ModelLoader {
  public:
    ModelLoader() = default;
    ~ModelLoader();
    ModelLoader(const ModelLoader&) = delete;
    ModelLoader& operator=(const ModelLoader&) = delete;

    /// From now on, models' shaders are compiled by the worker, too, for this device (renderer's
    /// compileAhead).
    void compileFor(std::string device) { device_ = std::move(device); }
    void start(const std::filesystem::path& path, const SceneChoice& choice = {});

    /// Cancels loading; `loading` stays true until the worker has ended.
    void abandon();

    /// Every frame: the model once it is ready; throws the worker's Error once. Nothing for a cancelled
    /// model.
    [[nodiscard]] std::optional<LoadedModel> take();

    [[nodiscard]] bool loading() const { return worker_.joinable(); }
    /// True if there is a result to take.
    [[nodiscard]] bool finished() const {
        return worker_.joinable() && finished_.load(std::memory_order_acquire) &&
               !cancelled_.load(std::memory_order_relaxed);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] double fraction() const { return fraction_.load(std::memory_order_relaxed); } ///< 0..1
    [[nodiscard]] std::string activity() const;

  private:
    struct Request {
        std::filesystem::path path;
        SceneChoice choice;
    };
    void begin(const Request& request);

    std::string device_; // empty: shaders are compiled when they are first drawn
    std::filesystem::path path_;
    std::optional<Request> next_; // started when the worker has ended
    std::thread worker_;
    std::atomic<bool> cancelled_{false}, finished_{false};
    std::atomic<double> fraction_{0.0};
    std::atomic<const char*> activity_{""}; // string literals of the loader
    std::optional<LoadedModel> result_;     // worker until finished_
    std::exception_ptr failure_;            // worker until finished_
};

} // namespace touchstone
