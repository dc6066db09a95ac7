#include "haptics/texture/persistent_textures.h"

#include <algorithm>
#include <cstddef>

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
    if (ring_ != nullptr)
        return;
    ring_ = std::make_unique<RecordRing<BrushStroke>>(kKept);
    tiles_ = std::make_unique<RecordRing<SentTile>>(kTilesKept);
    sent_ = std::make_unique<SentTile>();
}

void PersistentTextures::publishStrokes(uint64_t tick) noexcept {
    if (ring_ == nullptr)
        return;
    if (applied_ > 0) {
        for (size_t i = 0; i < applied_; ++i)
            strokes_[i].tick = tick;
        const uint64_t dropped = ring_->dropped();
        ring_->push(strokes());
        if (ring_->dropped() != dropped) { // from the first tile on
            sending_ = true;
            sendObject_ = 0;
            sendTile_ = 0;
        }
    }
    if (sending_)
        sendTile(tick);
}

/// Copies one tile. What is sent holds the strokes of this tick, and those of later ticks are in the ring
/// unless they are dropped, too, which begins anew.
void PersistentTextures::sendTile(uint64_t tick) noexcept {
    const auto next = [&] {
        while (sendObject_ < textures_.size() &&
               (textures_[sendObject_] == nullptr || sendTile_ >= textures_[sendObject_]->tiles())) {
            ++sendObject_;
            sendTile_ = 0;
        }
    };
    const size_t object = sendObject_;
    const uint32_t tile = sendTile_;
    const bool first = object == 0 && tile == 0;
    next();
    if (sendObject_ >= textures_.size()) {
        sending_ = false;
        return;
    }
    const PersistentTexture& texture = *textures_[sendObject_];
    const PersistentTexture::Place place = texture.placeOf(sendTile_);
    const std::span<const float> values = texture.values();
    for (uint32_t y = 0; y < place.height; ++y)
        std::ranges::copy(values.subspan(size_t{place.y + y} * texture.size().width + place.x, place.width),
                          sent_->values.begin() + static_cast<std::ptrdiff_t>(size_t{y} * place.width));
    sent_->tick = tick;
    sent_->dropped = ring_->dropped();
    sent_->object = static_cast<uint32_t>(sendObject_);
    sent_->tile = sendTile_;
    sent_->first = first;
    ++sendTile_;
    next();
    sent_->last = sendObject_ >= textures_.size();
    const uint64_t dropped = tiles_->dropped();
    tiles_->push(*sent_);
    if (tiles_->dropped() != dropped) { // no room: the same one again
        sendObject_ = object;
        sendTile_ = tile;
    } else if (sent_->last) {
        sending_ = false;
    }
}

void PersistentTextures::takeTiles(PersistentTextures& servo, uint64_t before) {
    if (servo.tiles_ == nullptr || (!waits_ && !lacks(servo)))
        return;
    if (sent_ == nullptr)
        sent_ = std::make_unique<SentTile>();
    while (waits_ || servo.tiles_->pop(*sent_)) {
        waits_ = sent_->tick >= before;
        if (waits_)
            return;
        put(*sent_);
        together_ = sent_->first || (together_ && sent_->dropped == fitting_);
        fitting_ = sent_->dropped;
        if (sent_->last && together_)
            made_ = fitting_;
    }
}

void PersistentTextures::put(const SentTile& sent) {
    PersistentTexture* const texture = at(static_cast<int>(sent.object));
    if (texture == nullptr || sent.tile >= texture->tiles())
        return;
    const PersistentTexture::Place place = texture->placeOf(sent.tile);
    (void)texture->setTile(sent.tile, std::span(sent.values).first(size_t{place.width} * place.height));
    if (sent.last)
        for (const auto& each : textures_)
            if (each != nullptr)
                each->settle();
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
            textures[k] = std::make_unique<PersistentTexture>(textures_[k]->map(), textures_[k]->size(),
                                                              textures_[k]->start());
    return std::make_shared<PersistentTextures>(std::move(textures));
}

} // namespace touchstone
