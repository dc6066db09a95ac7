#pragma once
// The persistent textures of a scene's objects: the state that a world has of them, and copies of it that
// follow the servo's by its strokes.

#include "engine/exchange/record_ring.h"
#include "haptics/texture/persistent_texture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace touchstone {

/// One texture for each object of a scene that has one. Construct off the servo (it allocates). Programs
/// queue strokes while a tick runs; they all take effect at its end, so that no hand feels what another one
/// changes in the same tick. One thread at a time, but for `popStroke`.
class PersistentTextures {
  public:
    /// By object of a HapticScene; null where it has none (scene/scene_programs.h).
    explicit PersistentTextures(std::vector<std::unique_ptr<PersistentTexture>> textures)
        : textures_(std::move(textures)) {}

    /// Of HapticScene::objects[object]; null where it has none.
    [[nodiscard]] const PersistentTexture* at(int object) const noexcept {
        const auto index = static_cast<size_t>(object);
        return index < textures_.size() ? textures_[index].get() : nullptr;
    }
    [[nodiscard]] PersistentTexture* at(int object) noexcept {
        return const_cast<PersistentTexture*>(std::as_const(*this).at(object));
    }
    [[nodiscard]] size_t objects() const { return textures_.size(); }

    // Writer (servo), in the tick: no allocation, bounded.
    void queue(const BrushStroke& stroke) noexcept {
        if (count_ < strokes_.size())
            strokes_[count_++] = stroke;
    }
    void applyQueued() noexcept;
    /// Those of the last `applyQueued`.
    [[nodiscard]] std::span<const BrushStroke> strokes() const noexcept {
        return std::span(strokes_).first(applied_);
    }
    /// A copy: strokes of another one's `strokes`, in their order.
    void apply(std::span<const BrushStroke> strokes) noexcept;

    /// Off the servo, before it gets them: strokes can be popped by one other thread.
    void keepStrokes();
    /// Servo, after each tick: its strokes. Where the other thread has not asked for so long that they are
    /// dropped, the textures follow by themselves, one tile a tick.
    void publishStrokes(uint64_t tick) noexcept;
    /// The other thread: in order. What has been dropped for want of room can be seen in `droppedStrokes`.
    [[nodiscard]] bool popStroke(BrushStroke& stroke) noexcept {
        return ring_ != nullptr && ring_->pop(stroke);
    }
    [[nodiscard]] uint64_t droppedStrokes() const noexcept { return ring_ != nullptr ? ring_->dropped() : 0; }
    /// A copy: tiles that `servo` has sent since it dropped strokes, as they were after ticks before this
    /// one. The thread that pops its strokes, before it applies those of that tick and of later ones.
    void takeTiles(PersistentTextures& servo, uint64_t before);
    /// A copy: strokes were dropped, and not all tiles have come since.
    [[nodiscard]] bool lacks(const PersistentTextures& servo) const noexcept {
        return servo.droppedStrokes() != made_;
    }

    /// Every texture as at first.
    void reset();
    /// Others of the same kind, as at first. Any thread.
    [[nodiscard]] std::shared_ptr<PersistentTextures> fresh() const;

  private:
    static constexpr size_t kMaxStrokes = 12; ///< of a tick: of each contact of each hand
    static constexpr size_t kKept = 1 << 14, kTilesKept = 64;
    /// A tile as it was after a tick, in the order of objects and tiles.
    struct SentTile {
        uint64_t tick = 0;
        uint64_t dropped = 0; ///< `droppedStrokes` then
        uint32_t object = 0, tile = 0;
        bool first = false, last = false; ///< of all
        std::array<float, size_t{PersistentTexture::kTile} * PersistentTexture::kTile> values{};
    };
    void sendTile(uint64_t tick) noexcept;
    void put(const SentTile& sent);

    std::vector<std::unique_ptr<PersistentTexture>> textures_; ///< by object; null entries
    std::array<BrushStroke, kMaxStrokes> strokes_{};
    size_t count_ = 0, applied_ = 0;
    std::unique_ptr<RecordRing<BrushStroke>> ring_;
    std::unique_ptr<RecordRing<SentTile>> tiles_;
    bool sending_ = false;
    size_t sendObject_ = 0; ///< what is sent next
    uint32_t sendTile_ = 0;
    std::unique_ptr<SentTile> sent_; ///< of the servo; of a copy the last one popped
    // Of a copy:
    bool waits_ = false;    ///< what was popped is of a later tick
    bool together_ = false; ///< the tiles since the first one fit together
    uint64_t fitting_ = 0;  ///< SentTile::dropped of them
    uint64_t made_ = 0;     ///< droppedStrokes that tiles have made up for
};

} // namespace touchstone
