#pragma once
// What a kept picture depends on. Plain data and arithmetic.

#include "renderer/view.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// All that the picture of the resting objects depends on, compared by value: what is not in here may change
/// from frame to frame and is drawn over it. A new member of View counts by itself.
struct PictureKey {
    View view;            ///< without probe (its shadow is cast afterwards) and allowed error (the full mesh)
    glm::ivec2 size{0};   ///< pixels
    uint64_t content = 0; ///< counts scenes, environments and colours of materials

    bool operator==(const PictureKey&) const = default;
};

[[nodiscard]] PictureKey pictureKey(const View& view, const glm::ivec2& size, uint64_t content);

/// Which instances have moved since the kept picture was begun: they are no part of it. One that stops stays
/// so until the picture is begun again.
class MovingInstances {
  public:
    /// Poses of the next frame. True when an instance that rested moves: the picture shows it in its old
    /// place. Another number of poses: all rest.
    /// `revisions`: of the instances' vertices, which move an instance as its pose does; empty: none changes.
    [[nodiscard]] bool update(std::span<const glm::dmat4> poses, std::span<const uint64_t> revisions = {});
    /// The picture is begun: what did not move into this frame rests.
    void begin() { moves_ = movesNow_; }
    /// The poses are those of another scene: all rest.
    void forget() { last_.clear(); }
    [[nodiscard]] bool moves(size_t instance) const { return instance < moves_.size() && moves_[instance]; }

  private:
    std::vector<glm::dmat4> last_;
    std::vector<uint64_t> lastRevisions_;
    std::vector<bool> moves_, movesNow_;
};

} // namespace touchstone
