#include "haptics/scene/scene_sculptor.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/mesh_to_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

[[noreturn]] void refuseStep(const std::string& problem, const char* remedy) {
    throw Error("sculpting", "", problem, remedy);
}

const FieldShape* fieldOf(const HapticObject& object) {
    return dynamic_cast<const FieldShape*>(object.shape.get());
}

} // namespace

SceneSculptor::SceneSculptor(std::shared_ptr<const HapticScene> scene) : scene_(std::move(scene)) {}

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
    return fieldOf(*scene_->objects[object])->sharedGrid();
}

Similarity SceneSculptor::sceneFromObject(size_t object) const {
    return scene_->workspaceFromScene.inverseTimes(scene_->objects[object]->workspaceFromObject);
}

Sculptor& SceneSculptor::sculptorOf(size_t object) {
    return sculptors_.try_emplace(object, field(object)).first->second;
}

std::shared_ptr<const FieldGrid> SceneSculptor::stampNamed(const std::string& name) {
    if (const auto made = stamps_.find(name); made != stamps_.end())
        return made->second;
    for (const auto& object : scene_->objects) {
        if (object->name != name || object->empty())
            continue;
        const FieldShape* const shape = fieldOf(*object);
        const std::shared_ptr<const FieldGrid> stamp =
            shape != nullptr ? shape->sharedGrid() : fieldOfMesh(*object, FieldRequest{});
        return stamps_.emplace(name, stamp).first->second;
    }
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
    if (!step.stamp.empty())
        dab.stamp = stampNamed(step.stamp);
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

SculptReport SceneSculptor::apply(const SculptStep& step) {
    SculptReport report;
    if (step.action != SculptAction::Stroke) {
        const bool undoes = step.action == SculptAction::Undo;
        std::vector<Made>&from = undoes ? done_ : undone_, &to = undoes ? undone_ : done_;
        if (from.empty())
            return report;
        const Made made = from.back();
        from.pop_back();
        to.push_back(made);
        Sculptor& sculptor = sculptorOf(made.object);
        (void)(undoes ? sculptor.undo() : sculptor.redo());
        renew(made.object);
        report.removed = undoes ? -made.removed : made.removed;
        return report;
    }
    const size_t object = objectNamed(step.object);
    const std::vector<Dab> dabs = dabsOf(step, object);
    Sculptor& sculptor = sculptorOf(object);
    sculptor.beginStroke();
    undone_.clear();
    for (const Dab& dab : dabs) {
        const DabReport one = sculptor.apply(dab);
        report.removed += one.removed;
        report.bricks += one.bricks;
    }
    report.dabs = dabs.size();
    const double scale = sceneFromObject(object).scale;
    report.removed *= scale * scale * scale;
    if (report.bricks > 0) {
        done_.push_back({object, report.removed});
        renew(object);
    }
    return report;
}

/// Another scene with the object's new field.
void SceneSculptor::renew(size_t object) {
    const std::shared_ptr<HapticScene> scene = copyOf(*scene_);
    scene->warnings = scene_->warnings;
    auto reshaped = std::make_shared<HapticObject>();
    const HapticObject& old = *scene_->objects[object];
    reshaped->name = old.name;
    reshaped->instance = old.instance;
    reshaped->material = old.material;
    reshaped->workspaceFromObject = old.workspaceFromObject;
    reshaped->objectFromMesh = old.objectFromMesh;
    reshaped->closed = true;
    reshaped->anySmooth = old.anySmooth;
    reshaped->oneSided = old.oneSided;
    reshaped->shape = std::make_shared<FieldShape>(sculptorOf(object).grid());
    reshaped->boundingRadius = reshaped->shape->boundingRadius();
    reshaped->diagonal = 2.0 * reshaped->boundingRadius;
    scene->boundingRadii[object] = reshaped->boundingRadius;
    scene->restSpheres[object] = boundingSphere(*reshaped, reshaped->workspaceFromObject);
    scene->objects[object] = std::move(reshaped);
    scene_ = scene;
}

uint64_t SceneSculptor::hash() const {
    Hash64 hash;
    for (const auto& object : scene_->objects)
        if (const FieldShape* const shape = fieldOf(*object))
            hash.add(shape->identity());
    return hash.value();
}

} // namespace touchstone
