#include "haptics/shape/field/sculpt/restore_distance.h"

#include "haptics/shape/field/sculpt/closest_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

constexpr double kSteep = 0.1; // from 1: the gradient of a distance, away from its kinks
constexpr double kRoom = 1.5;  // voxels: a nearest place is known to a voxel

/// The same order within the window and at its border.
template <class Visit>
void eachNeighbour(const FieldWindow& window, const glm::ivec3& node, const Visit& visit) {
    if (glm::all(glm::greaterThan(node, glm::ivec3(0))) && glm::all(glm::lessThan(node, window.size - 1))) {
        const auto own = static_cast<ptrdiff_t>(window.index(node));
        const ptrdiff_t sy = window.step(1), sz = window.step(2);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                    if (x != 0 || y != 0 || z != 0)
                        visit(node + glm::ivec3(x, y, z), static_cast<size_t>(own + x + y * sy + z * sz));
        return;
    }
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (const glm::ivec3 at = node + glm::ivec3(x, y, z);
                    (x != 0 || y != 0 || z != 0) && window.contains(at))
                    visit(at, window.index(at));
}

} // namespace

std::vector<NodeBox> DistanceRestorer::run(FieldWindow& window, const SculptZone& zone,
                                           const DistanceReach& reach, ExactSide exact) {
    exact_ = exact;
    window_ = &window;
    zone_ = zone;
    reach_ = reach;
    const size_t count = window.value.size();
    state_.assign(count, Node::None);
    pointOf_.resize(count);
    distance_.resize(count);
    window.eachActiveRow([&](const glm::ivec3&, size_t index, int nodes) {
        std::fill_n(&state_[index], nodes, Node::Kept);
        std::fill_n(&pointOf_[index], nodes, kNone);
    });
    points_.clear();
    touched_.clear();
    queue_ = {};
    if (!findNear())
        return {};
    open();
    seedKept();
    march();
    return finish();
}

void DistanceRestorer::give(size_t node, const glm::dvec3& point) {
    if (pointOf_[node] == kNone) {
        pointOf_[node] = static_cast<uint32_t>(points_.size());
        points_.push_back(point);
    } else {
        points_[pointOf_[node]] = point;
    }
    const float distance = state_[node] == Node::Kept ? keptDistance(node) : distance_[node];
    queue_.push({distance, static_cast<uint32_t>(node)});
}

/// The nodes at the surface in and around the zone. A value that is the distance already, as where a ball was
/// taken out, stays: the surface does not creep however often it is worked at. False where nothing changed.
bool DistanceRestorer::findNear() {
    constexpr double kSame = 0.03; // voxels, and 2 % of the distance
    FieldWindow& window = *window_;
    const ClosestPoints surface(window);
    const glm::ivec3 low = zone_.low(2.0, 0), high = zone_.high(window, 2.0, 0);
    const auto differs = [&](size_t node) { return window.value[node] != window.before[node]; };
    bool any = false;
    std::vector<std::pair<size_t, glm::dvec3>> found;
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const glm::ivec3 node(x, y, z);
                const size_t index = window.index(node);
                any = any || differs(index);
                if (surface.near(node))
                    found.emplace_back(index, surface.fromNear(node));
            }
    if (!any)
        return false;
    for (const auto& [index, point] : found) {
        const glm::ivec3 node = window.nodeAt(index);
        bool changed = differs(index);
        eachNeighbour(window, node,
                      [&](const glm::ivec3&, size_t other) { changed = changed || differs(other); });
        const double own = std::abs(static_cast<double>(window.value[index])) / window.voxel;
        const double measured = glm::distance(glm::dvec3(node), point);
        const bool keep = !changed || isExact(index) || std::abs(own - measured) <= kSame + 0.02 * measured;
        state_[index] = Node::Near;
        distance_[index] = static_cast<float>(keep ? own : measured);
        if (!keep)
            touched_.push_back(static_cast<uint32_t>(index));
        if (!isExact(index))
            give(index, point);
    }
    return true;
}

/// Forgets the distances of nodes in the zone, and of those whose nearest place may be in it: f g away
/// against the gradient g where that is a unit vector, anywhere at f from the node where it is not.
void DistanceRestorer::open() {
    FieldWindow& window = *window_;
    const ClosestPoints surface(window);
    const double reach = zone_.radius + kRoom;
    const auto mayChange = [&](const glm::ivec3& node, size_t index) {
        const double f = static_cast<double>(window.before[index]) / window.voxel, own = std::abs(f);
        const glm::dvec3 way = glm::dvec3(node) - zone_.centre;
        const double squared = glm::dot(way, way);
        if (squared <= reach * reach)
            return true;
        // Most nodes end here: no root.
        if (own >= limit(negative(index)) * (1.0 - 1e-6) || squared > (own + reach) * (own + reach))
            return false;
        const glm::dvec3 slope = surface.gradientBefore(node);
        const double steep = glm::length(slope);
        return std::abs(steep - 1.0) > kSteep ||
               glm::distance(glm::dvec3(node) - f * slope / steep, zone_.centre) <= reach;
    };
    window.eachActiveRow([&](const glm::ivec3& first, size_t begin, int count) {
        for (int i = 0; i < count; ++i) {
            const size_t index = begin + static_cast<size_t>(i);
            if (state_[index] == Node::Near || isExact(index) ||
                !mayChange(first + glm::ivec3(i, 0, 0), index))
                continue;
            state_[index] = Node::Open;
            distance_[index] = static_cast<float>(limit(negative(index)));
            touched_.push_back(static_cast<uint32_t>(index));
        }
    });
}

/// Kept nodes beside open ones hand on where their own nearest places are; so do those beyond the active
/// bricks, which take nothing themselves.
void DistanceRestorer::seedKept() {
    FieldWindow& window = *window_;
    const ClosestPoints surface(window);
    for (size_t i = 0, count = touched_.size(); i < count; ++i) {
        const uint32_t node = touched_[i];
        if (state_[node] != Node::Open && state_[node] != Node::Reached)
            continue;
        const glm::ivec3 place = window.nodeAt(node);
        eachNeighbour(window, place, [&](const glm::ivec3& at, size_t other) {
            const bool beyond = state_[other] == Node::None;
            if (!beyond && (state_[other] != Node::Kept || pointOf_[other] != kNone))
                return;
            const bool inside = negative(other);
            const double f = static_cast<double>(window.value[other]) / window.voxel;
            const glm::dvec3 slope = surface.gradientBefore(at);
            const double steep = glm::length(slope);
            if (std::abs(f) >= limit(inside) * (1.0 - 1e-6) || std::abs(steep - 1.0) > kSteep)
                return;
            // A place that is not on the surface would be handed on, and is nearer than any that is.
            const std::optional<glm::dvec3> point = surface.onSurface(glm::dvec3(at) - f * slope / steep);
            if (!point) {
                // A bound, by the triangle inequality.
                if (negative(node) == inside)
                    distance_[node] = std::min(
                        distance_[node],
                        static_cast<float>(std::abs(f) + glm::distance(glm::dvec3(at), glm::dvec3(place))));
                return;
            }
            if (!beyond)
                give(other, *point);
            else if (negative(node) == inside)
                offer(node, place, *point);
        });
    }
}

bool DistanceRestorer::inReach(const glm::dvec3& point) const {
    const glm::dvec3 way = point - zone_.centre;
    return glm::dot(way, way) <= (zone_.radius + kRoom) * (zone_.radius + kRoom);
}

void DistanceRestorer::offer(size_t to, const glm::ivec3& at, const glm::dvec3& point) {
    const bool isKept = state_[to] == Node::Kept;
    if (isKept && !inReach(point))
        return; // the surface has not changed there
    const float most = isKept ? keptDistance(to) - kNearer : distance_[to];
    const glm::dvec3 way = glm::dvec3(at) - point;
    // Most neighbours have a nearer place already: no root, with room for its rounding.
    if (glm::dot(way, way) > 1.000001 * static_cast<double>(most) * static_cast<double>(most) ||
        !(most > 0.0f))
        return;
    // As floats: a double below a float that it rounds to would be offered for ever.
    const auto offered = static_cast<float>(glm::distance(glm::dvec3(at), point));
    if (!(offered < most))
        return;
    if (isKept)
        touched_.push_back(static_cast<uint32_t>(to));
    state_[to] = Node::Reached;
    distance_[to] = offered;
    give(to, point);
}

/// Its nearest place, once no other node will hand on a nearer one.
glm::dvec3 DistanceRestorer::settled(size_t node) {
    glm::dvec3& point = points_[pointOf_[node]];
    if (state_[node] == Node::Reached) {
        const glm::dvec3 at(window_->nodeAt(node));
        point = ClosestPoints(*window_).slid(at, point);
        distance_[node] = static_cast<float>(glm::distance(at, point));
    }
    return point;
}

void DistanceRestorer::march() {
    while (!queue_.empty()) {
        const Entry entry = queue_.top();
        queue_.pop();
        if (state_[entry.node] != Node::Kept && entry.distance > distance_[entry.node])
            continue; // a nearer place was found since
        const bool inside = negative(entry.node);
        const glm::dvec3 point = settled(entry.node);
        eachNeighbour(*window_, window_->nodeAt(entry.node), [&](const glm::ivec3& at, size_t other) {
            if (state_[other] != Node::Near && state_[other] != Node::None && negative(other) == inside &&
                !isExact(other))
                offer(other, at, point);
        });
    }
}

std::vector<NodeBox> DistanceRestorer::finish() {
    FieldWindow& window = *window_;
    for (const uint32_t node : touched_) {
        const bool inside = negative(node);
        const auto voxels = static_cast<double>(distance_[node]);
        const double distance =
            voxels < limit(inside) * (1.0 - 1e-6) ? voxels * window.voxel : reachOf(inside);
        window.value[node] = static_cast<float>(inside ? -distance : distance);
    }
    return changedNodes(window);
}

} // namespace touchstone
