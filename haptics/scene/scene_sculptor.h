#pragma once
// Sculpts the fields of a compiled scene. Not for the servo thread.

#include "engine/volume/volume_mesh.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/sculpt/sculpt_journal.h"
#include "haptics/shape/field/sculpt/sculptor.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {

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

    /// The scene as it is now: the same objects, materials and plan, but for the sculpted shapes.
    [[nodiscard]] const std::shared_ptr<const HapticScene>& scene() const { return scene_; }
    /// Of the fields of all objects; the same journal gives the same value.
    [[nodiscard]] uint64_t hash() const;

    /// The object of a step's name: its index in HapticScene::objects. Throws Error.
    [[nodiscard]] size_t objectNamed(const std::string& name) const;
    [[nodiscard]] std::shared_ptr<const FieldGrid> field(size_t object) const;
    [[nodiscard]] Similarity sceneFromObject(size_t object) const;

  private:
    [[nodiscard]] Sculptor& sculptorOf(size_t object);
    [[nodiscard]] std::vector<Dab> dabsOf(const SculptStep& step, size_t object);
    [[nodiscard]] std::shared_ptr<const FieldGrid> stampNamed(const std::string& name);
    void renew(size_t object);

    static constexpr size_t kMostDabs = 100'000;
    std::shared_ptr<const HapticScene> scene_;
    std::map<size_t, Sculptor> sculptors_;
    std::map<std::string, std::shared_ptr<const FieldGrid>> stamps_;
    struct Made {
        size_t object;
        double removed; ///< m^3
    };
    std::vector<Made> done_, undone_; ///< strokes, for undo over all objects
};

} // namespace touchstone
