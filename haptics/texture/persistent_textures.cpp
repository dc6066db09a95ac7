#include "haptics/texture/persistent_textures.h"

#include <algorithm>

namespace touchstone {

void PersistentTextures::applyQueued() noexcept {
    const auto most = static_cast<uint32_t>(TexelMap::kMaxReached / std::max<size_t>(count_, 1));
    for (size_t i = 0; i < count_; ++i)
        strokes_[i].most = most;
    applied_ = count_;
    count_ = 0;
    apply(strokes());
}

void PersistentTextures::apply(std::span<const BrushStroke> strokes) noexcept {
    for (const BrushStroke& stroke : strokes)
        if (PersistentTexture* const texture = at(static_cast<int>(stroke.object)))
            texture->apply(stroke);
}

void PersistentTextures::keepStrokes() {
    if (ring_ == nullptr)
        ring_ = std::make_unique<RecordRing<BrushStroke>>(kKept);
}

void PersistentTextures::publishStrokes(uint64_t tick) noexcept {
    if (applied_ == 0 || ring_ == nullptr)
        return;
    for (size_t i = 0; i < applied_; ++i)
        strokes_[i].tick = tick;
    ring_->push(strokes());
}

void PersistentTextures::reset() {
    for (const auto& texture : textures_)
        if (texture != nullptr)
            texture->reset();
    count_ = applied_ = 0;
}

std::shared_ptr<PersistentTextures> PersistentTextures::fresh() const {
    std::vector<std::unique_ptr<PersistentTexture>> textures(textures_.size());
    for (size_t k = 0; k < textures.size(); ++k)
        if (textures_[k] != nullptr)
            textures[k] = std::make_unique<PersistentTexture>(textures_[k]->map(), textures_[k]->size());
    return std::make_shared<PersistentTextures>(std::move(textures));
}

} // namespace touchstone
