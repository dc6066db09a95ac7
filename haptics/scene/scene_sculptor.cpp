#include "haptics/scene/scene_sculptor.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "haptics/scene/shape_object.h"
#include "haptics/shape/field/cut_field.h"
#include "haptics/shape/field/field_colors.h"
#include "haptics/shape/field/mesh_to_field.h"
#include "haptics/shape/field/sculpt/tool_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

[[noreturn]] void refuseStep(const std::string& problem, const char* remedy) {
    throw Error("sculpting", "", problem, remedy);
}

const FieldShape* fieldOf(const HapticObject& object) {
    return wholeField(object.shape.get());
}

/// Without a stamp.
Dab dabOf(const SculptEntry& entry) {
    return {.tool = entry.tool,
            .centre = entry.centre,
            .motion = entry.motion,
            .radius = entry.radius,
            .strength = entry.strength,
            .falloff = entry.falloff,
            .color = entry.color};
}

} // namespace

std::shared_ptr<const FieldColors> colorsOfObject(const HapticScene& scene, size_t object) {
    return fieldOf(*scene.objects[object])->colors();
}

std::shared_ptr<const FieldGrid> fieldOfObject(const HapticScene& scene, size_t object) {
    return fieldOf(*scene.objects[object])->sharedGrid();
}

Similarity sceneFromObject(const HapticScene& scene, size_t object) {
    return scene.workspaceFromScene.inverseTimes(scene.objects[object]->workspaceFromObject);
}

SceneSculptor::SceneSculptor(std::shared_ptr<const HapticScene> scene)
    : root_(scene), scene_(std::move(scene)) {}

size_t SceneSculptor::objectNamed(const std::string& name) const {
    std::string names;
    for (size_t k = 0; k < scene_->objects.size(); ++k) {
        const HapticObject& object = *scene_->objects[k];
        const bool isField = fieldOf(object) != nullptr;
        if (name.empty() ? isField : object.name == name) {
            if (!isField)
                refuseStep(name + " is felt as a mesh",
                           "give its material the representation implicit (touchstone edit)");
            return k;
        }
        names += (names.empty() ? "" : ", ") + object.name;
    }
    if (name.empty())
        refuseStep("no object of the scene is felt as a field",
                   "open a volume, or give a material the representation implicit (touchstone edit)");
    refuseStep("the scene has no object " + name + ": it has " + names, "name one of them");
}

std::shared_ptr<const FieldGrid> SceneSculptor::field(size_t object) const {
    return fieldOfObject(*scene_, object);
}

Similarity SceneSculptor::sceneFromObject(size_t object) const {
    return touchstone::sceneFromObject(*scene_, object);
}

Sculptor& SceneSculptor::sculptorOf(size_t object) {
    return sculptors_.try_emplace(object, field(object)).first->second;
}

/// The shape that the object had before it was sculpted. That of now depends on when edits were settled, so a
/// replay would stamp another one.
std::shared_ptr<const FieldGrid> SceneSculptor::stampOf(size_t object) {
    if (const auto made = stamps_.find(object); made != stamps_.end())
        return made->second;
    const HapticObject& shape = *root_->objects[object];
    const FieldShape* const field = fieldOf(shape);
    return stamps_
        .emplace(object, field != nullptr ? field->sharedGrid() : fieldOfMesh(shape, FieldRequest{}))
        .first->second;
}

size_t SceneSculptor::stampNamed(const std::string& name) const {
    for (size_t k = 0; k < scene_->objects.size(); ++k)
        if (scene_->objects[k]->name == name && !scene_->objects[k]->empty())
            return k;
    refuseStep("the scene has no object " + name + " to stamp with", "name one of its objects");
}

std::vector<Dab> SceneSculptor::dabsOf(const SculptStep& step, size_t object) {
    const Similarity scenePlace = sceneFromObject(object);
    const double voxel = field(object)->layout().voxel;
    Dab dab;
    dab.tool = step.tool;
    dab.radius = step.radius / scenePlace.scale;
    dab.strength = step.strength;
    dab.falloff = step.falloff;
    dab.color = step.color;
    if (!step.stamp.empty())
        dab.stamp = stampOf(stampNamed(step.stamp));
    const double spacing = std::max(0.25 * dab.radius, 0.5 * voxel);
    std::vector<Dab> dabs;
    glm::dvec3 before = scenePlace.inversePoint(step.points.front());
    if (step.tool != SculptTool::Drag) {
        dab.centre = before;
        dabs.push_back(dab);
    }
    for (const glm::dvec3& point : step.points) {
        const glm::dvec3 to = scenePlace.inversePoint(point);
        const double parts = std::ceil(glm::distance(before, to) / spacing);
        if (!(parts + static_cast<double>(dabs.size()) <= static_cast<double>(kMostDabs)))
            refuseStep("a stroke is longer than " + std::to_string(kMostDabs) + " dabs",
                       "divide it, or give it a larger radius");
        for (double i = 1.0; i <= parts; ++i) {
            const glm::dvec3 centre = glm::mix(before, to, i / parts);
            dab.motion = (to - before) / parts;
            dab.centre = centre;
            dabs.push_back(dab);
        }
        before = to;
    }
    for (const Dab& one : dabs)
        sculptorOf(object).check(one);
    return dabs;
}

/// Takes the last stroke back, or repeats what was taken back. Returns what it removed, m^3.
double SceneSculptor::removedBy(bool undoes) {
    std::vector<Made>&from = undoes ? done_ : undone_, &to = undoes ? undone_ : done_;
    if (from.empty())
        return 0.0;
    const Made made = from.back();
    Sculptor& sculptor = sculptorOf(made.object);
    (void)(undoes ? sculptor.undo() : sculptor.redo());
    from.pop_back();
    to.push_back(made);
    unsettled_.insert(made.object);
    return undoes ? -made.removed : made.removed;
}

size_t SceneSculptor::checkedObject(int32_t object) const {
    if (object < 0 || static_cast<size_t>(object) >= scene_->objects.size())
        refuseStep("there is no object " + std::to_string(object), "the journal is that of another scene");
    return static_cast<size_t>(object);
}

SculptReport SceneSculptor::apply(const SculptEntry& entry) {
    SculptReport report;
    if (entry.kind == SculptEntryKind::Undo || entry.kind == SculptEntryKind::Redo) {
        report.removed = removedBy(entry.kind == SculptEntryKind::Undo);
        begins_ = strokeIsEmpty_ = true; // what follows of the stroke is a step of its own
        return report;
    }
    if (entry.kind == SculptEntryKind::Restore)
        return restore(entry.object);
    const size_t object = checkedObject(entry.object);
    if (scene_->objects[object]->empty())
        return report; // it is hidden
    if (fieldOf(*scene_->objects[object]) == nullptr)
        refuseStep(scene_->objects[object]->name + " is felt as a mesh",
                   "give its material the representation implicit (touchstone edit)");
    Sculptor& sculptor = sculptorOf(object);
    if (entry.kind == SculptEntryKind::Begin) {
        begins_ = strokeIsEmpty_ = true;
        return report;
    }
    Dab dab = dabOf(entry);
    if (entry.tool == SculptTool::Stamp || entry.tool == SculptTool::Imprint)
        dab.stamp = stampOf(checkedObject(entry.stamp));
    sculptor.check(dab);
    if (entry.kind == SculptEntryKind::Preview) {
        report.bricks = sculptor.preview(dab).bricks;
        if (report.bricks > 0)
            unsettled_.insert(object);
        return report;
    }
    if (sculptor.previews()) // which end with it, whatever it changes
        unsettled_.insert(object);
    if (begins_) {
        sculptor.beginStroke();
        undone_.clear();
        begins_ = false;
    }
    const DabReport one = entry.kind == SculptEntryKind::Shape ? sculptor.shape(dab) : sculptor.apply(dab);
    const double scale = sceneFromObject(object).scale;
    report = {.removed = one.removed * scale * scale * scale, .dabs = 1, .bricks = one.bricks};
    if (one.bricks == 0)
        return report;
    unsettled_.insert(object);
    if (std::exchange(strokeIsEmpty_, false))
        done_.push_back({object, 0.0});
    done_.back().removed += report.removed;
    return report;
}

SculptReport SceneSculptor::restore(int32_t object, const std::function<void()>& meanwhile) {
    SculptReport report;
    const size_t at = checkedObject(object);
    if (const auto found = sculptors_.find(at); found != sculptors_.end()) {
        report.bricks = found->second.restore(meanwhile).bricks;
        unsettled_.insert(at);
    }
    return report;
}

bool SceneSculptor::canShape(const SculptEntry& entry) const {
    if (entry.kind != SculptEntryKind::Dab || !isWholeBall(dabOf(entry)))
        return false;
    const auto object = static_cast<size_t>(entry.object); // beyond all others where it is negative
    return object < scene_->objects.size() && fieldOf(*scene_->objects[object]) != nullptr;
}

bool SceneSculptor::joins(const SculptEntry& entry) const {
    if (begins_ || !canShape(entry))
        return false;
    const auto found = sculptors_.find(static_cast<size_t>(entry.object));
    return found != sculptors_.end() && found->second.joins(dabOf(entry));
}

std::optional<int32_t> SceneSculptor::owesDistances() const {
    for (const auto& [object, sculptor] : sculptors_)
        if (sculptor.owesDistances())
            return static_cast<int32_t>(object);
    return std::nullopt;
}

void SceneSculptor::settle() {
    for (; !unsettled_.empty(); unsettled_.erase(unsettled_.begin()))
        if (const size_t object = *unsettled_.begin(); !scene_->objects[object]->empty())
            renew(object);
}

std::vector<int> SceneSculptor::sculpted() const {
    std::vector<int> objects;
    for (const auto& [object, sculptor] : sculptors_)
        objects.push_back(static_cast<int>(object));
    return objects;
}

std::vector<uint32_t> SceneSculptor::takeChangedBricks(int object) {
    return sculptorOf(static_cast<size_t>(object)).takeChangedBricks();
}

uint64_t SceneSculptor::memoryBytes() const {
    uint64_t bytes = 0;
    for (const auto& [object, sculptor] : sculptors_)
        bytes += sculptor.memoryBytes();
    return bytes;
}

void SceneSculptor::moveTo(std::shared_ptr<const HapticScene> scene) {
    root_ = scene;
    scene_ = std::move(scene);
    for (const auto& [object, sculptor] : sculptors_)
        if (fieldOf(*scene_->objects[object]) != nullptr) // else it is hidden
            renew(object);
}

SculptReport SceneSculptor::apply(const SculptStep& step) {
    SculptReport report;
    if (step.action != SculptAction::Stroke) {
        const bool undoes = step.action == SculptAction::Undo;
        entries_.push_back({.kind = undoes ? SculptEntryKind::Undo : SculptEntryKind::Redo});
        report = apply(entries_.back());
        settle();
        return report;
    }
    const size_t object = objectNamed(step.object);
    const std::vector<Dab> dabs = dabsOf(step, object);
    SculptEntry entry{.kind = SculptEntryKind::Begin, .object = static_cast<int32_t>(object)};
    const auto make = [&] {
        const SculptReport one = apply(entry);
        report.removed += one.removed;
        report.bricks += one.bricks;
        entries_.push_back(entry);
    };
    make();
    entry.kind = SculptEntryKind::Dab;
    if (!step.stamp.empty())
        entry.stamp = static_cast<int32_t>(stampNamed(step.stamp));
    for (const Dab& dab : dabs) {
        entry.tool = dab.tool;
        entry.centre = dab.centre;
        entry.motion = dab.motion;
        entry.radius = dab.radius;
        entry.strength = dab.strength;
        entry.falloff = dab.falloff;
        entry.color = dab.color;
        make();
    }
    report.dabs = dabs.size();
    settle();
    return report;
}

/// Another scene with the object's new field.
void SceneSculptor::renew(size_t object) {
    const std::shared_ptr<HapticScene> scene = copyOf(*scene_);
    scene->warnings = scene_->warnings;
    scene->shareNeighbourhoods(*scene_);
    const HapticObject& old = *scene_->objects[object];
    const auto field = std::make_shared<FieldShape>(sculptorOf(object).grid());
    field->setColors(sculptorOf(object).colors());
    const auto* const cut = dynamic_cast<const CutField*>(old.shape.get());
    auto reshaped = withShape(old, cut != nullptr ? std::shared_ptr<const Shape>(cut->of(field)) : field);
    scene->boundingRadii[object] = reshaped->boundingRadius;
    scene->restSpheres[object] = boundingSphere(*reshaped, reshaped->workspaceFromObject);
    scene->objects[object] = std::move(reshaped);
    scene_ = scene;
}

uint64_t SceneSculptor::hash() const {
    Hash64 hash;
    for (const auto& object : scene_->objects)
        if (const FieldShape* const shape = fieldOf(*object)) {
            hash.add(shape->identity());
            if (shape->colors() != nullptr)
                hash.add(shape->colors()->hash());
        }
    return hash.value();
}

} // namespace touchstone
