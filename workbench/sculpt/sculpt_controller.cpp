#include "workbench/sculpt/sculpt_controller.h"

#include "workbench/files/sculpted_file.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace touchstone {

namespace {

bool isField(const HapticScene& scene, int object) {
    if (object < 0 || static_cast<size_t>(object) >= scene.objects.size())
        return false;
    const Shape* const shape = scene.objects[static_cast<size_t>(object)]->shape.get();
    return shape != nullptr && shape->potential() != nullptr;
}

int firstField(const HapticScene& scene) {
    for (int k = 0; k < static_cast<int>(scene.objects.size()); ++k)
        if (isField(scene, k))
            return k;
    return -1;
}

} // namespace

void SculptController::show(const Model& model, bool another) {
    felt_ = model.haptic;
    drawn_ = model.scene;
    if (!another)
        return;
    object_ = felt_ != nullptr ? firstField(*felt_) : -1;
    sculpted_ = false;
    notice_.clear();
    surface_.forget();
    if (felt_ == nullptr || drawn_ == nullptr)
        return;
    for (const int object : texturedFields(*felt_, *drawn_))
        surface_.changed(*felt_, object, drawn_.get(), {});
}

void SculptController::sceneSculpted(const SculptedScene& scene) {
    if (scene.root != session_.scene().number)
        return; // of a model that is shown no more
    felt_ = scene.haptic;
    picker_.show(scene.haptic, scene.source);
    sculpted_ = true;
    for (const SculptedScene::Field& field : scene.changed)
        surface_.changed(*felt_, field.object, drawn_.get(), field.bricks);
}

void SculptController::take(const TickRecord& record, const HapticSettings&) {
    if (felt_ != nullptr && record.hand == 0 && record.output.contacts > 0 &&
        isField(*felt_, record.output.object))
        object_ = record.output.object;
}

int SculptController::stampNamed(const std::string& name) const {
    for (size_t k = 0; felt_ != nullptr && k < felt_->objects.size(); ++k)
        if (!felt_->objects[k]->empty() && (name.empty() || felt_->objects[k]->name == name))
            return static_cast<int>(k);
    return -1;
}

void SculptController::update(SculptChoice& choice, bool live) {
    LiveSculptor& sculptor = session_.sculptor();
    LiveTool tool;
    tool.active = choice.on && live && object_ >= 0;
    if (tool.active) {
        tool.held = choice.held;
        tool.tool = toolOf(choice);
        tool.object = object_;
        tool.stamp = stampNamed(choice.stamp);
        tool.radius = choice.radius;
        tool.strength = choice.strength;
        tool.falloff = choice.falloff;
        tool.color = paintOf(choice);
        surface_.prepare(*felt_, object_, drawn_.get());
    }
    sculptor.setTool(tool);
    if (std::exchange(choice.undo, false) && sculpted_)
        sculptor.undo();
    if (std::exchange(choice.redo, false) && sculpted_)
        sculptor.redo();
}

void SculptController::draw(SceneRenderer& renderer) {
    surface_.draw(renderer);
}

void SculptController::saveAs(const std::filesystem::path& file) {
    if (felt_ == nullptr || object_ < 0)
        return;
    if (felt_->objects[static_cast<size_t>(object_)]->empty()) {
        notice_ = "the sculpted object is hidden: show it, then save it";
        return;
    }
    try {
        (void)writeSculpted(file, *felt_, static_cast<size_t>(object_));
        notice_ = "saved as " + file.filename().string();
    } catch (const std::exception& error) {
        notice_ = error.what();
    }
}

SculptStatus SculptController::status() const {
    SculptStatus status{
        .possible = object_ >= 0, .stamps = {}, .figures = session_.sculptor().figures(), .notice = notice_};
    for (size_t k = 0; felt_ != nullptr && k < felt_->objects.size(); ++k)
        if (!felt_->objects[k]->empty())
            status.stamps.push_back(felt_->objects[k]->name);
    return status;
}

} // namespace touchstone
