#include "renderer/picture_key.h"

#include <algorithm>

namespace touchstone {

PictureKey pictureKey(const View& view, const glm::ivec2& size, uint64_t content) {
    PictureKey key{.view = view, .size = size, .content = content};
    key.view.probe = {};
    key.view.allowedError = 0.0;
    return key;
}

bool MovingInstances::update(std::span<const glm::dmat4> poses, std::span<const uint64_t> revisions) {
    lastRevisions_.resize(poses.size(), 0);
    if (poses.size() != last_.size()) {
        last_.assign(poses.begin(), poses.end());
        std::ranges::copy(revisions.first(std::min(revisions.size(), poses.size())), lastRevisions_.begin());
        moves_.assign(poses.size(), false);
        movesNow_ = moves_;
        return true;
    }
    bool begins = false;
    for (size_t i = 0; i < poses.size(); ++i) {
        const uint64_t revision = i < revisions.size() ? revisions[i] : 0;
        movesNow_[i] = poses[i] != last_[i] || revision != lastRevisions_[i];
        lastRevisions_[i] = revision;
        begins |= movesNow_[i] && !moves_[i];
        last_[i] = poses[i];
    }
    return begins;
}

} // namespace touchstone
