#include "haptics/shape/field/sculpt/restore_distance.h"

#include "haptics/shape/field/sculpt/closest_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace touchstone {

namespace {

constexpr double kSteep = 0.1; // from 1: the gradient of a distance, away from its kinks
constexpr double kRoom = 1.5;  // voxels: a nearest place is known to a voxel

/// All neighbours lie in the window.
bool hasAllNeighbours(const FieldWindow& window, const glm::ivec3& node) {
    return glm::all(glm::greaterThan(node, glm::ivec3(0))) && glm::all(glm::lessThan(node, window.size - 1));
}

/// The same order within the window and at its border. Within it, leaves out the rows of three nodes of which
/// matters(index of the first one) is false.
template <class Visit, class Matters>
void eachNeighbour(const FieldWindow& window, const glm::ivec3& node, const Visit& visit,
                   const Matters& matters) {
    if (hasAllNeighbours(window, node)) {
        const auto own = static_cast<ptrdiff_t>(window.index(node));
        const ptrdiff_t sy = window.step(1), sz = window.step(2);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y) {
                const auto row = static_cast<size_t>(own - 1 + y * sy + z * sz);
                for (int x = -1; x <= 1 && matters(row); ++x)
                    if (x != 0 || y != 0 || z != 0)
                        visit(node + glm::ivec3(x, y, z), row + static_cast<size_t>(x + 1));
            }
        return;
    }
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (const glm::ivec3 at = node + glm::ivec3(x, y, z);
                    (x != 0 || y != 0 || z != 0) && window.contains(at))
                    visit(at, window.index(at));
}

template <class Visit>
void eachNeighbour(const FieldWindow& window, const glm::ivec3& node, const Visit& visit) {
    eachNeighbour(window, node, visit, [](size_t) { return true; });
}

double squaredDistance(const glm::ivec3& node, const glm::dvec3& point) {
    const glm::dvec3 way = glm::dvec3(node) - point;
    return glm::dot(way, way);
}

} // namespace

std::vector<NodeBox> DistanceRestorer::run(FieldWindow& window, const SculptZone& zone,
                                           const DistanceReach& reach, ExactSide exact,
                                           const std::function<void()>& meanwhile) {
    meanwhile_ = &meanwhile;
    exact_ = exact;
    window_ = &window;
    zone_ = zone;
    reach_ = reach;
    begin();
    pause();
    if (!findNear())
        return {};
    pause();
    open();
    seedKept();
    march();
    pause();
    return finish();
}

void DistanceRestorer::pause() {
    if (*meanwhile_)
        (*meanwhile_)();
}

void DistanceRestorer::begin() {
    const FieldWindow& window = *window_;
    const size_t count = window.value.size();
    state_.resize(count + 1); // handOn and seedKept read one beyond
    pointOf_.resize(count);
    distance_.resize(count + 1);
    const auto voxel = static_cast<float>(window.voxel);
    window.eachActiveRow([&](const glm::ivec3&, size_t index, int nodes) {
        std::fill_n(&state_[index], nodes, Node::Kept);
        const float* const value = &window.value[index];
        float* const most = &distance_[index];
        for (int i = 0; i < nodes; ++i)
            most[i] = std::abs(value[i]) / voxel - kNearer;
    });
    for (const NodeBox& box : window.around)
        window.eachRow(box, [&](const glm::ivec3&, size_t index, int nodes) {
            std::fill_n(&state_[index], nodes, Node::None);
        });
    points_.clear();
    touched_.clear();
    queue_.clear();
}

void DistanceRestorer::give(size_t node, float distance, const glm::dvec3& point) {
    if (state_[node] == Node::Given || state_[node] == Node::Reached) {
        points_[pointOf_[node]] = point;
    } else {
        pointOf_[node] = static_cast<uint32_t>(points_.size());
        points_.push_back(point);
    }
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
            give(index, distance_[index], point);
    }
    return true;
}

/// A bit for each node of a row that `open` may open, and for few others: the eight nodes of a brick's row
/// are tested at once, as floats with room for their rounding.
uint32_t DistanceRestorer::mayOpen(const glm::ivec3& first, size_t index, int count) const {
    const uint32_t all = (1u << count) - 1u;
    if (count < kBrickCells)
        return all;
    constexpr float kRounded = 1.0f + 1e-5f;
    const Eight before = eightAt(&window_->before[index]), own = larger(before, -before);
    const Eight value = eightAt(&window_->value[index]);
    const auto reach = static_cast<float>(zone_.radius + kRoom);
    const glm::vec3 way(glm::dvec3(first) - zone_.centre);
    const Eight x = way.x + kLane;
    const Eight squared = x * x + (way.y * way.y + way.z * way.z);
    const Eight far = own * static_cast<float>(1.0 / window_->voxel) + reach;
    // As floats not below these, values are not below the limit of `open`, either.
    const Eight inside = Eight{} + static_cast<float>(reach_.inside * (1.0 - 5e-7));
    const Eight outside = Eight{} + static_cast<float>(reach_.outside * (1.0 - 5e-7));
    const uint32_t beyond = lanes(squared > kRounded * reach * reach);
    uint32_t stays =
        beyond & (lanes(own >= (value < 0.0f ? inside : outside)) | lanes(squared > kRounded * far * far));
    if (exact_ != ExactSide::None) {
        const uint32_t negative = lanes(value < 0.0f);
        stays |= exact_ == ExactSide::Inside ? negative : ~negative & ((1u << kBrickCells) - 1u);
    }
    const bool isInner =
        glm::all(glm::greaterThan(first, glm::ivec3(0))) &&
        glm::all(glm::lessThan(first + glm::ivec3(kBrickCells - 1, 0, 0), window_->size - 1));
    if (isInner && (all & ~stays) != 0)
        stays |=
            beyond & restsElsewhere(index, squared, before * static_cast<float>(1.0 / window_->voxel), way);
    return all & ~stays;
}

/// Of nodes out of reach: whose nearest place before the dab is known, and out of reach, too. With s the
/// length of the gradient g, w the way from the zone's centre and R the reach, |w - f g / s|^2 > R^2, or s A
/// > B with A = w^2 + f^2 - R^2 and B = 2 f g w. Without a root, as A > 0: B < 0 or s^2 A^2 > B^2. The
/// rounding errors of A and B are below 1e-5 of w^2 + f^2 + R^2.
uint32_t DistanceRestorer::restsElsewhere(size_t index, Eight squared, Eight f, const glm::vec3& way) const {
    constexpr float kRounded = 1e-4f;
    constexpr auto kLeast = static_cast<float>((1.0 - kSteep) * (1.0 - kSteep)) + 1e-3f,
                   kMost = static_cast<float>((1.0 + kSteep) * (1.0 + kSteep)) - 1e-3f;
    const auto perTwo = static_cast<float>(0.5 / window_->voxel),
               reach = static_cast<float>(zone_.radius + kRoom);
    const auto slope = [&](size_t step) {
        return (eightAt(&window_->before[index + step]) - eightAt(&window_->before[index - step])) * perTwo;
    };
    const Eight x = slope(1), y = slope(static_cast<size_t>(window_->step(1))),
                z = slope(static_cast<size_t>(window_->step(2)));
    const Eight steep = x * x + y * y + z * z;
    const Eight a = (squared + f * f) * (1.0f - kRounded) - reach * reach * (1.0f + kRounded);
    const Eight b = 2.0f * f * (x * (way.x + kLane) + y * way.y + z * way.z);
    return lanes(steep > kLeast) & lanes(steep < kMost) & lanes(a > 0.0f) &
           (lanes(b < 0.0f) | lanes(a * a * steep > b * b));
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
        for (uint32_t nodes = mayOpen(first, begin, count); nodes != 0; nodes &= nodes - 1) {
            const int i = std::countr_zero(nodes);
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
    // Most rows have none. Subtracting 2 sets the highest bit of a byte below 2, as none is above 127.
    static_assert(static_cast<int>(Node::Kept) == 1 && static_cast<int>(Node::Given) == 2);
    const auto hasKept = [&](size_t row) {
        uint32_t states;
        std::memcpy(&states, &state_[row], sizeof states);
        return (((states & 0xffffffu) - 0x020202u) & 0x808080u) != 0;
    };
    for (size_t i = 0, end = touched_.size(); i < end; ++i) {
        const uint32_t node = touched_[i];
        if (state_[node] != Node::Open && state_[node] != Node::Reached)
            continue;
        count();
        const glm::ivec3 place = window.nodeAt(node);
        eachNeighbour(
            window, place,
            [&](const glm::ivec3& at, size_t other) {
                const bool beyond = state_[other] == Node::None;
                if (!beyond && state_[other] != Node::Kept)
                    return;
                const bool inside = negative(other);
                const double f = static_cast<double>(window.value[other]) / window.voxel;
                if (std::abs(f) >= limit(inside) * (1.0 - 1e-6))
                    return;
                const glm::dvec3 slope = surface.gradientBefore(at);
                const double steep = glm::length(slope);
                if (std::abs(steep - 1.0) > kSteep)
                    return;
                // A place that is not on the surface would be handed on, and is nearer than any that is.
                const std::optional<glm::dvec3> point = surface.onSurface(glm::dvec3(at) - f * slope / steep);
                if (!point) {
                    // A bound, by the triangle inequality.
                    if (negative(node) == inside)
                        distance_[node] =
                            std::min(distance_[node],
                                     static_cast<float>(std::abs(f) +
                                                        glm::distance(glm::dvec3(at), glm::dvec3(place))));
                    return;
                }
                if (!beyond) {
                    give(other, keptDistance(other), *point);
                    state_[other] = Node::Given;
                } else if (negative(node) == inside) {
                    offer(node, squaredDistance(place, *point), *point);
                }
            },
            hasKept);
    }
}

bool DistanceRestorer::inReach(const glm::dvec3& point) const {
    const glm::dvec3 way = point - zone_.centre;
    return glm::dot(way, way) <= (zone_.radius + kRoom) * (zone_.radius + kRoom);
}

/// Of a place at the root of `squared` voxels.
void DistanceRestorer::offer(size_t to, double squared, const glm::dvec3& point) {
    // As floats: a double below a float that it rounds to would be offered for ever.
    const auto offered = static_cast<float>(std::sqrt(squared));
    if (!(offered < distance_[to]))
        return;
    if (state_[to] == Node::Kept || state_[to] == Node::Given)
        touched_.push_back(static_cast<uint32_t>(to));
    give(to, offered, point);
    state_[to] = Node::Reached;
    distance_[to] = offered;
}

/// Its nearest place, once no other node will hand on a nearer one.
glm::dvec3 DistanceRestorer::settled(size_t node, const glm::ivec3& place) {
    glm::dvec3& point = points_[pointOf_[node]];
    if (state_[node] == Node::Reached) {
        const glm::dvec3 at(place);
        point = ClosestPoints(*window_).slid(at, point);
        distance_[node] = static_cast<float>(glm::distance(at, point));
    }
    return point;
}

/// Offers a node's nearest place to its neighbours on the same side.
void DistanceRestorer::handOn(const glm::ivec3& place, size_t node, const glm::dvec3& point) {
    const FieldWindow& window = *window_;
    const bool inside = negative(node), isNew = inReach(point); // else the surface has not changed there
    const auto offerTo = [&](size_t other, double squared) {
        const Node state = state_[other];
        if (state != Node::Near && state != Node::None && negative(other) == inside &&
            (isNew || state == Node::Open || state == Node::Reached))
            offer(other, squared, point);
    };
    if (!hasAllNeighbours(window, place)) {
        eachNeighbour(window, place, [&](const glm::ivec3& at, size_t other) {
            offerTo(other, squaredDistance(at, point));
        });
        return;
    }
    // The three of a row at once, squaredDistance as it is above. Most have a nearer place already: no root,
    // with room for its rounding.
    using FourFloats [[gnu::vector_size(16)]] = float;
    const glm::dvec3 at(place);
    const Four x = Four{at.x - 1.0, at.x, at.x + 1.0, INFINITY} - point.x, xx = x * x;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y) {
            const double wayY = at.y + y - point.y, wayZ = at.z + z - point.z;
            const Four squared = xx + wayY * wayY + wayZ * wayZ;
            const size_t row = node - 1 + static_cast<size_t>(y * window.step(1) + z * window.step(2));
            FourFloats distances;
            std::memcpy(&distances, &distance_[row], sizeof distances);
            const Four most = __builtin_convertvector(distances, Four);
            uint32_t nearer = lanes(squared <= 1.000001 * most * most) & 7u;
            if (y == 0 && z == 0)
                nearer &= ~2u; // itself
            for (; nearer != 0; nearer &= nearer - 1) {
                const auto i = static_cast<size_t>(std::countr_zero(nearer));
                offerTo(row + i, squared[i]);
            }
        }
}

void DistanceRestorer::march() {
    while (!queue_.empty()) {
        count();
        const NodeQueue::Entry entry = queue_.pop();
        if (state_[entry.node] != Node::Given && entry.distance > distance_[entry.node])
            continue; // a nearer place was found since
        const glm::ivec3 place = window_->nodeAt(entry.node);
        const glm::dvec3 point = settled(entry.node, place);
        if (!isExact(entry.node)) // nor are its neighbours on this side
            handOn(place, entry.node, point);
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
