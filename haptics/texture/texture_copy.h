#pragma once
// The persistent textures of a servo as another thread has them: by repeating its strokes, which gives the
// same bits.

#include "haptics/texture/persistent_textures.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

/// One thread, the only one that pops the servo's strokes.
class TextureCopy {
  public:
    /// From here on those of `servo` (PersistentTextures::keepStrokes), which the servo has had from its
    /// first tick on; null: none. The same as before: goes on.
    void follow(const std::shared_ptr<PersistentTextures>& servo);
    /// Applies all strokes of before `tick`, and returns those of `tick`, which the next call applies.
    std::span<const BrushStroke> next(uint64_t tick);
    /// The state before the tick that `next` was last called with; null: none, or the servo dropped strokes
    /// since this thread had not asked for so long.
    [[nodiscard]] const PersistentTextures* state() const { return lost_ ? nullptr : copy_.get(); }

  private:
    std::shared_ptr<PersistentTextures> servo_, copy_;
    std::vector<BrushStroke> strokes_;   ///< of the last tick
    std::optional<BrushStroke> waiting_; ///< popped, of a later one
    bool lost_ = false;
};

} // namespace touchstone
