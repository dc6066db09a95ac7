#include "renderer/picture_key.h"

namespace touchstone {

PictureKey pictureKey(const View& view, const glm::ivec2& size, uint64_t content) {
    PictureKey key{.view = view, .size = size, .content = content};
    key.view.probe = {};
    key.view.allowedError = 0.0;
    return key;
}

bool MovingInstances::update(std::span<const glm::dmat4> poses) {
    if (poses.size() != last_.size()) {
        last_.assign(poses.begin(), poses.end());
        moves_.assign(poses.size(), false);
        movesNow_ = moves_;
        return true;
    }
    bool begins = false;
    for (size_t i = 0; i < poses.size(); ++i) {
        movesNow_[i] = poses[i] != last_[i];
        begins |= movesNow_[i] && !moves_[i];
        last_[i] = poses[i];
    }
    return begins;
}

} // namespace touchstone
