#include "workbench/hand/stroke_controller.h"

#include <chrono>
#include <exception>
#include <utility>

namespace touchstone {

void StrokeController::show(ScenePtr scene, const Similarity& workspaceFromScene,
                            std::shared_ptr<const StrokePath> tour) {
    scene_ = std::move(scene);
    workspaceFromScene_ = workspaceFromScene;
    tour_ = std::move(tour);
    touched_.reset();
    problem_.clear();
    ++model_;
    laid_ = StrokeRequest{}; // the tour came with the model
}

std::shared_ptr<const StrokePath> StrokeController::update(const StrokeRequest& wanted,
                                                           const glm::dvec3& front, bool strokes) {
    const bool before = std::exchange(stroked_, strokes);
    chosen_ = strokes && (chosen_ || !before);
    if (worker_.valid()) {
        if (worker_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
            return nullptr;
        try {
            std::shared_ptr<const StrokePath> path = worker_.get();
            if (laying_ == model_) // else another model was shown meanwhile
                return path;
        } catch (const std::exception& error) {
            if (laying_ == model_)
                problem_ = error.what();
        }
        return nullptr;
    }
    const bool begins = std::exchange(chosen_, false);
    if (tour_ == nullptr || !strokes)
        return nullptr;
    StrokeRequest request = wanted;
    const bool same =
        laid_ && laid_->name == wanted.name && laid_->speed == wanted.speed && laid_->depth == wanted.depth;
    const bool elsewhere = begins && wanted.name != "tour" && laid_ && laid_->place != touched_;
    if (same && !elsewhere)
        return nullptr;
    request.place = touched_;
    request.front = wanted.name == "tour" ? StrokeRequest{}.front : front;
    laid_ = request;
    problem_.clear();
    if (request == StrokeRequest{.place = request.place})
        return tour_;
    laying_ = model_;
    worker_ = std::async(std::launch::async, [scene = scene_, fit = workspaceFromScene_, request] {
        return std::shared_ptr<const StrokePath>(
            std::make_shared<StrokePath>(layStroke(*scene, fit, request)));
    });
    return nullptr;
}

std::string StrokeController::notice() const {
    return worker_.valid() ? "finding the way" : problem_;
}

} // namespace touchstone
