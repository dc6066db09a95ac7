#pragma once
// Sculpts the fields of a compiled scene. Not for the servo thread.

#include "engine/volume/volume_mesh.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/sculpt/live_tool.h"
#include "haptics/shape/field/sculpt/sculpt_journal.h"
#include "haptics/shape/field/sculpt/sculptor.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

/// The field of an object that has one (HapticScene::objects), and its place in the scene's frame.
[[nodiscard]] std::shared_ptr<const FieldGrid> fieldOfObject(const HapticScene& scene, size_t object);
/// Null where it is not painted.
[[nodiscard]] std::shared_ptr<const FieldColors> colorsOfObject(const HapticScene& scene, size_t object);
[[nodiscard]] Similarity sceneFromObject(const HapticScene& scene, size_t object);

struct SculptReport {
    double removed = 0.0; ///< m^3, scene frame; negative where the solid grew, as by undo of a cut
    size_t dabs = 0, bricks = 0;
};

/// Holds a Sculptor for each object that was sculpted. Every scene that it gave stays as it was.
class SceneSculptor {
  public:
    explicit SceneSculptor(std::shared_ptr<const HapticScene> scene);

    /// A stroke is laid in dabs a quarter of the radius apart (those of Drag: as far as the tool moved), at
    /// least half a voxel. Throws Error, before anything is changed: no such object, one that is felt as a
    /// mesh, a stroke of more than kMostDabs, what Sculptor::check refuses.
    SculptReport apply(const SculptStep& step);

    /// One entry of a live journal; `scene` stays as it was until `settle`. Dabs between two Begins are one
    /// step of undo. Throws Error, before anything is changed, as the other one.
    SculptReport apply(const SculptEntry& entry);
    /// The Restore of `object`, with Sculptor::restore's `meanwhile`: it may apply Previews and `settle`.
    SculptReport restore(int32_t object, const std::function<void()>& meanwhile = {});
    /// A Dab that may be applied as Shape and Restore.
    [[nodiscard]] bool canShape(const SculptEntry& entry) const;
    /// As a Shape its distances are restored with those of the last ones.
    [[nodiscard]] bool joins(const SculptEntry& entry) const;
    /// The object whose distances a Restore has to restore; empty where there is none.
    [[nodiscard]] std::optional<int32_t> owesDistances() const;
    /// The entries that steps came to since the last call: applied to another SceneSculptor of the scene they
    /// give the same fields.
    [[nodiscard]] std::vector<SculptEntry> takeEntries() { return std::exchange(entries_, {}); }
    /// After entries: makes the scene that they lead to.
    void settle();

    /// The scene as it is now: the same objects, materials and plan, but for the sculpted shapes.
    [[nodiscard]] const std::shared_ptr<const HapticScene>& scene() const { return scene_; }
    /// The objects that were sculpted so far (HapticScene::objects), in order.
    [[nodiscard]] std::vector<int> sculpted() const;
    /// FieldGrid::brickNumber of an object's bricks that have changed since the last call.
    [[nodiscard]] std::vector<uint32_t> takeChangedBricks(int object);
    [[nodiscard]] size_t undoSteps() const { return done_.size(); }
    [[nodiscard]] size_t redoSteps() const { return undone_.size(); }
    /// Of all that the fields and their histories hold.
    [[nodiscard]] uint64_t memoryBytes() const;
    /// The same edits on another scene of the same geometry, whose materials may differ: its fields become
    /// the sculpted ones.
    void moveTo(std::shared_ptr<const HapticScene> scene);

    /// Of the fields and colours of all objects; the same journal gives the same value.
    [[nodiscard]] uint64_t hash() const;

    /// The object of a step's name: its index in HapticScene::objects. Throws Error.
    [[nodiscard]] size_t objectNamed(const std::string& name) const;
    [[nodiscard]] std::shared_ptr<const FieldGrid> field(size_t object) const;
    [[nodiscard]] Similarity sceneFromObject(size_t object) const;

  private:
    [[nodiscard]] Sculptor& sculptorOf(size_t object);
    [[nodiscard]] std::vector<Dab> dabsOf(const SculptStep& step, size_t object);
    [[nodiscard]] size_t stampNamed(const std::string& name) const;
    [[nodiscard]] std::shared_ptr<const FieldGrid> stampOf(size_t object);
    [[nodiscard]] double removedBy(bool undoes);
    [[nodiscard]] size_t checkedObject(int32_t object) const;
    void renew(size_t object);

    static constexpr size_t kMostDabs = 100'000;
    std::shared_ptr<const HapticScene> root_; // as before any edit
    std::shared_ptr<const HapticScene> scene_;
    std::map<size_t, Sculptor> sculptors_;
    std::map<size_t, std::shared_ptr<const FieldGrid>> stamps_;
    std::set<size_t> unsettled_;
    bool begins_ = true, strokeIsEmpty_ = true; // since the last Begin: no dab, none that changed anything
    struct Made {
        size_t object;
        double removed; ///< m^3
    };
    std::vector<SculptEntry> entries_;
    std::vector<Made> done_, undone_; ///< strokes, for undo over all objects
};

} // namespace touchstone
