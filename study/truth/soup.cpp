#include "study/truth/soup.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace touchstone::truth {

namespace {

constexpr uint32_t kLeaf = 8;
/// Boxes are computed in the same long double as the triangles; this is far above its rounding.
constexpr long double kBoxMargin = 1e-16L;

/// The distance to a triangle is convex along a line. The tangents at both ends bound it from below; where
/// they cannot exclude a value below `enough`, the interval of the minimum is reduced by ternary search.
long double clearanceOf(const Corners& corners, const LVec3& p, const LVec3& move, long double enough) {
    const BruteContact start = distanceFrom(corners, p), end = distanceFrom(corners, p + move);
    const long double ends = std::min(start.distance, end.distance);
    const long double fall = glm::dot(start.normal, move), rise = glm::dot(end.normal, move);
    if (fall >= 0.0L || rise <= 0.0L) // monotonic
        return ends;
    // Intersection of the tangents.
    const long double t = (end.distance - rise - start.distance) / (fall - rise);
    const long double bound = start.distance + fall * std::clamp(t, 0.0L, 1.0L);
    if (bound >= enough)
        return bound;
    long double low = 0.0L, high = 1.0L, least = ends;
    for (int i = 0; i < 120; ++i) {
        const long double a = low + (high - low) / 3.0L, b = high - (high - low) / 3.0L;
        const long double atA = distanceFrom(corners, p + a * move).distance,
                          atB = distanceFrom(corners, p + b * move).distance;
        least = std::min({least, atA, atB});
        (atA < atB ? high : low) = atA < atB ? b : a;
    }
    return least;
}

} // namespace

LSimilarity::LSimilarity(const Similarity& s)
    : scale(static_cast<long double>(s.scale)), rotation(glm::normalize(glm::qua<long double>(s.rotation))),
      translation(s.translation) {}

LVec3 LSimilarity::point(const LVec3& p) const {
    return scale * (rotation * p) + translation;
}

LVec3 LSimilarity::inversePoint(const LVec3& p) const {
    return (glm::conjugate(rotation) * (p - translation)) / scale;
}

long double Soup::Box::distance(const LVec3& p) const {
    return glm::length(glm::max(glm::max(low - p, p - high), LVec3(0.0L)));
}

Soup::Soup(const HapticScene& scene, int frame) {
    // In the frame's own origin: far from the workspace's, even long double would lose digits.
    LSimilarity fromFrame(scene.objects[static_cast<size_t>(frame)]->workspaceFromObject);
    const LVec3 origin = fromFrame.translation;
    fromFrame.translation = LVec3(0.0L);
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const HapticObject& object = *scene.objects[k];
        LSimilarity fromObject(object.workspaceFromObject);
        fromObject.translation -= origin;
        const auto base = static_cast<uint32_t>(vertices_.size());
        for (size_t v = 0; v + 1 < object.vertices.size(); ++v) { // the last one is Embree's padding
            const LVec3 p(object.vertices[v]);
            // The frame's own object is copied bitwise.
            vertices_.push_back(static_cast<int>(k) == frame ? p
                                                             : fromFrame.inversePoint(fromObject.point(p)));
        }
        for (const uint32_t index : object.indices)
            indices_.push_back(base + index);
        oneSided_.resize(triangleCount(), object.oneSided ? static_cast<int>(k) : -1);
    }
    std::vector<LVec3> centres(triangleCount());
    for (size_t t = 0; t < centres.size(); ++t) {
        const Corners c = corners(t);
        centres[t] = (c.a + c.b + c.c) / 3.0L;
        if (counts(t))
            order_.push_back(static_cast<uint32_t>(t));
    }
    if (!order_.empty())
        build(0, static_cast<uint32_t>(order_.size()), centres);
}

uint32_t Soup::build(uint32_t first, uint32_t count, const std::vector<LVec3>& centres) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    node.first = first;
    node.count = count;
    Box middle;
    for (uint32_t i = first; i < first + count; ++i) {
        const Corners c = corners(order_[i]);
        for (const LVec3& p : {c.a, c.b, c.c}) {
            node.box.low = glm::min(node.box.low, p);
            node.box.high = glm::max(node.box.high, p);
        }
        middle.low = glm::min(middle.low, centres[order_[i]]);
        middle.high = glm::max(middle.high, centres[order_[i]]);
    }
    if (count > kLeaf) {
        const LVec3 extent = middle.high - middle.low;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (extent[k] > extent[axis])
                axis = k;
        const auto from = order_.begin() + first;
        std::nth_element(from, from + count / 2, from + count,
                         [&](uint32_t s, uint32_t t) { return centres[s][axis] < centres[t][axis]; });
        node.left = build(first, count / 2, centres);
        node.right = build(first + count / 2, count - count / 2, centres);
    }
    nodes_[index] = node;
    return index;
}

Corners Soup::corners(size_t t) const {
    return {vertices_[indices_[3 * t]], vertices_[indices_[3 * t + 1]], vertices_[indices_[3 * t + 2]]};
}

bool Soup::counts(size_t t) const {
    const uint32_t* i = &indices_[3 * t];
    return i[0] != i[1] && i[1] != i[2] && i[2] != i[0];
}

std::vector<size_t> Soup::near(const LVec3& p, long double reach) const {
    std::vector<size_t> found;
    std::vector<uint32_t> open;
    if (!nodes_.empty())
        open.push_back(0);
    const long double limit = reach * (1.0L + kBoxMargin) + kBoxMargin * (1.0L + glm::length(p));
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        if (node.box.distance(p) > limit)
            continue;
        if (node.left != 0) {
            open.push_back(node.left);
            open.push_back(node.right);
            continue;
        }
        for (uint32_t i = node.first; i < node.first + node.count; ++i)
            found.push_back(order_[i]);
    }
    return found;
}

std::vector<BruteContact> Soup::within(const LVec3& p, long double reach) const {
    std::vector<BruteContact> contacts;
    for (const size_t t : near(p, reach)) {
        BruteContact contact = distanceFrom(corners(t), p);
        contact.triangle = t;
        if (contact.distance <= reach)
            contacts.push_back(contact);
    }
    return contacts;
}

BruteContact Soup::nearest(const LVec3& p) const {
    BruteContact best;
    best.distance = INFINITY;
    std::vector<uint32_t> open;
    if (!nodes_.empty())
        open.push_back(0);
    const long double margin = kBoxMargin * (1.0L + glm::length(p));
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        if (node.box.distance(p) > best.distance * (1.0L + kBoxMargin) + margin)
            continue;
        if (node.left != 0) {
            const bool leftFirst = nodes_[node.left].box.distance(p) < nodes_[node.right].box.distance(p);
            open.push_back(leftFirst ? node.right : node.left);
            open.push_back(leftFirst ? node.left : node.right);
            continue;
        }
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
            BruteContact contact = distanceFrom(corners(order_[i]), p);
            contact.triangle = order_[i];
            if (contact.distance < best.distance)
                best = contact;
        }
    }
    return best;
}

long double Soup::clearance(const LVec3& p, const LVec3& q, long double enough) const {
    const LVec3 move = q - p;
    long double least = INFINITY;
    for (const size_t t : near(0.5L * (p + q), 0.5L * glm::length(move) + enough))
        least = std::min(least, clearanceOf(corners(t), p, move, enough));
    return least;
}

} // namespace touchstone::truth
