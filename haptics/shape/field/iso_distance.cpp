#include "haptics/shape/field/iso_distance.h"

#include "engine/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <utility>

namespace touchstone {

namespace {

constexpr int kBrick = 8; // nodes a side
constexpr const char* kWorking = "building the distance field";

/// One bit a node; a brick's row is a byte.
class NodeBits {
  public:
    explicit NodeBits(const glm::ivec3& nodes)
        : width_(static_cast<size_t>((nodes.x + kBrick - 1) / kBrick)), height_(static_cast<size_t>(nodes.y)),
          bytes_(width_ * height_ * static_cast<size_t>(nodes.z)) {}
    [[nodiscard]] uint8_t& row(int brickX, int y, int z) { return bytes_[index(brickX, y, z)]; }
    [[nodiscard]] uint8_t row(int brickX, int y, int z) const { return bytes_[index(brickX, y, z)]; }
    void set(int x, int y, int z) {
        row(x / kBrick, y, z) = static_cast<uint8_t>(row(x / kBrick, y, z) | 1u << (x % kBrick));
    }

  private:
    [[nodiscard]] size_t index(int brickX, int y, int z) const {
        return static_cast<size_t>(brickX) +
               width_ * (static_cast<size_t>(y) + height_ * static_cast<size_t>(z));
    }
    size_t width_, height_;
    std::vector<uint8_t> bytes_;
};

struct NearNode {
    uint32_t node;
    float distance;
};

/// Distances of the nodes next to the surface.
class NearSurface {
  public:
    explicit NearSurface(const NodeValues& grid)
        : grid_(grid), sy_(grid.nodes.x), sz_(static_cast<ptrdiff_t>(grid.nodes.x) * grid.nodes.y) {}

    /// Of one layer, in order. A node is near where another sign stands among its 26 neighbours.
    [[nodiscard]] std::vector<NearNode> layer(int z) const {
        std::vector<NearNode> found;
        std::vector<uint8_t> inside(static_cast<size_t>(grid_.nodes.x)); // of nine rows
        for (int y = 1; y + 1 < grid_.nodes.y; ++y) {
            std::ranges::fill(inside, uint8_t{0});
            for (int dz = -1; dz <= 1; ++dz)
                for (int dy = -1; dy <= 1; ++dy) {
                    const float* const row = at(0, y + dy, z + dz);
                    for (size_t x = 0; x < inside.size(); ++x)
                        inside[x] = static_cast<uint8_t>(inside[x] + (row[x] < 0.0f ? 1 : 0));
                }
            for (size_t x = 1; x + 1 < inside.size(); ++x)
                if (const int all = inside[x - 1] + inside[x] + inside[x + 1]; all != 0 && all != 27) {
                    const float* const node = at(static_cast<int>(x), y, z);
                    found.push_back({static_cast<uint32_t>(node - grid_.value.data()),
                                     static_cast<float>(distance({x, y, z}, node))});
                }
        }
        return found;
    }

  private:
    [[nodiscard]] const float* at(int x, int y, int z) const {
        return grid_.value.data() + x + y * sy_ + z * sz_;
    }

    [[nodiscard]] double interpolated(const glm::dvec3& place) const {
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(place)), glm::ivec3(0), grid_.nodes - 2);
        const glm::dvec3 u = place - glm::dvec3(cell);
        const float* const v = at(cell.x, cell.y, cell.z);
        const auto along = [&](ptrdiff_t from) {
            return (1.0 - u.x) * static_cast<double>(v[from]) + u.x * static_cast<double>(v[from + 1]);
        };
        const double near = (1.0 - u.y) * along(0) + u.y * along(sy_);
        const double far = (1.0 - u.y) * along(sz_) + u.y * along(sy_ + sz_);
        return (1.0 - u.z) * near + u.z * far;
    }

    [[nodiscard]] double distance(const glm::dvec3& place, const float* node) const {
        const auto value = static_cast<double>(*node);
        const bool inside = value < 0.0;
        double nearest = INFINITY;
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    if (const auto other = static_cast<double>(node[dx + dy * sy_ + dz * sz_]);
                        (other < 0.0) != inside)
                        nearest =
                            std::min(nearest, std::sqrt(static_cast<double>(dx * dx + dy * dy + dz * dz)) *
                                                  value / (value - other));
        const auto slope = [&](ptrdiff_t step) {
            return static_cast<double>(node[step]) - static_cast<double>(node[-step]);
        };
        const glm::dvec3 gradient(slope(1), slope(sy_), slope(sz_));
        const double steep = glm::length(gradient);
        return steep > 0.0 ? std::min(nearest, along(place, gradient * ((inside ? 1.0 : -1.0) / steep),
                                                     inside, nearest))
                           : nearest;
    }

    /// The first change of sign along a unit direction; `most` where there is none before it.
    [[nodiscard]] double along(const glm::dvec3& place, const glm::dvec3& direction, bool inside,
                               double most) const {
        constexpr double kStep = 0.5;
        constexpr int kHalvings = 24;
        for (double begin = 0.0; begin < most; begin += kStep) {
            double end = std::min(begin + kStep, most);
            if ((interpolated(place + end * direction) < 0.0) == inside)
                continue;
            double from = begin;
            for (int i = 0; i < kHalvings; ++i) {
                const double middle = 0.5 * (from + end);
                ((interpolated(place + middle * direction) < 0.0) == inside ? from : end) = middle;
            }
            return 0.5 * (from + end);
        }
        return most;
    }

    const NodeValues& grid_;
    ptrdiff_t sy_, sz_;
};

/// The eight sweeps of one side. Its nodes have neighbours of the other side only where they are frozen, so
/// two sides may be swept at once.
class SideSweep {
  public:
    SideSweep(NodeValues& grid, const NodeBits& inside, const NodeBits& frozen, bool isInside, double most)
        : grid_(grid), inside_(inside), frozen_(frozen), isInside_(isInside), most_(static_cast<float>(most)),
          sy_(grid.nodes.x), sz_(static_cast<ptrdiff_t>(grid.nodes.x) * grid.nodes.y),
          bricks_((grid.nodes + (kBrick - 1)) / kBrick),
          reached_(static_cast<size_t>(bricks_.x) * static_cast<size_t>(bricks_.y) *
                   static_cast<size_t>(bricks_.z)) {}

    void run(const Progress& progress) {
        for (int z = 0; z < bricks_.z; ++z)
            for (int y = 0; y < bricks_.y; ++y)
                for (int x = 0; x < bricks_.x; ++x)
                    reached_[index({x, y, z})] = startsIn({x, y, z}) ? 1 : 0;
        for (int direction = 0; direction < 8; ++direction) {
            progress.step(direction / 8.0, kWorking);
            sweep({(direction & 1) != 0 ? -1 : 1, (direction & 2) != 0 ? -1 : 1,
                   (direction & 4) != 0 ? -1 : 1});
        }
    }

  private:
    [[nodiscard]] size_t index(const glm::ivec3& brick) const {
        return static_cast<size_t>(brick.x) +
               static_cast<size_t>(bricks_.x) *
                   (static_cast<size_t>(brick.y) +
                    static_cast<size_t>(bricks_.y) * static_cast<size_t>(brick.z));
    }
    [[nodiscard]] uint8_t side(int x, int y, int z) const {
        const uint8_t bits = inside_.row(x, y, z);
        return isInside_ ? bits : static_cast<uint8_t>(~bits);
    }
    [[nodiscard]] bool startsIn(const glm::ivec3& brick) const {
        const glm::ivec3 first = kBrick * brick, end = glm::min(first + kBrick, grid_.nodes);
        for (int z = first.z; z < end.z; ++z)
            for (int y = first.y; y < end.y; ++y)
                if ((side(brick.x, y, z) & frozen_.row(brick.x, y, z)) != 0)
                    return true;
        return false;
    }
    [[nodiscard]] bool mayChange(const glm::ivec3& brick) const {
        if (reached_[index(brick)] != 0)
            return true;
        for (int axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                glm::ivec3 other = brick;
                other[axis] += step;
                if (other[axis] >= 0 && other[axis] < bricks_[axis] && reached_[index(other)] != 0)
                    return true;
            }
        return false;
    }
    void sweep(const glm::ivec3& step) {
        const auto first = [&](int axis) { return step[axis] > 0 ? 0 : bricks_[axis] - 1; };
        const auto within = [&](const glm::ivec3& brick, int axis) {
            return brick[axis] >= 0 && brick[axis] < bricks_[axis];
        };
        glm::ivec3 brick;
        for (brick.z = first(2); within(brick, 2); brick.z += step.z)
            for (brick.y = first(1); within(brick, 1); brick.y += step.y)
                for (brick.x = first(0); within(brick, 0); brick.x += step.x)
                    if (mayChange(brick) && sweepBrick(brick, step))
                        reached_[index(brick)] = 1;
    }
    bool sweepBrick(const glm::ivec3& brick, const glm::ivec3& step) {
        const glm::ivec3 low = kBrick * brick, high = glm::min(low + kBrick, grid_.nodes) - 1;
        bool changed = false;
        for (int z = step.z > 0 ? low.z : high.z; z >= low.z && z <= high.z; z += step.z)
            for (int y = step.y > 0 ? low.y : high.y; y >= low.y && y <= high.y; y += step.y) {
                const unsigned free = side(brick.x, y, z) & static_cast<uint8_t>(~frozen_.row(brick.x, y, z));
                if (free == 0)
                    continue;
                float* const row = grid_.value.data() + low.x + y * sy_ + z * sz_;
                const int width = high.x - low.x;
                for (int x = step.x > 0 ? 0 : width; x >= 0 && x <= width; x += step.x)
                    if ((free >> x & 1u) != 0)
                        changed = lower(row + x) || changed;
            }
        return changed;
    }
    /// The node's distance from its neighbours', where that is less.
    bool lower(float* node) const {
        float a = std::min(node[-1], node[1]), b = std::min(node[-sy_], node[sy_]),
              c = std::min(node[-sz_], node[sz_]);
        if (a > b)
            std::swap(a, b);
        if (b > c)
            std::swap(b, c);
        if (a > b)
            std::swap(a, b);
        const float now = std::min(*node, most_);
        if (a >= now)
            return false;
        b -= a;
        c -= a;
        float further = 1.0f; // beyond a
        if (further > b) {
            further = 0.5f * (b + std::sqrt(2.0f - b * b));
            if (further > c) {
                const float sum = b + c;
                further = (sum + std::sqrt(std::max(0.0f, sum * sum - 3.0f * (b * b + c * c - 1.0f)))) / 3.0f;
            }
        }
        if (!(a + further < now))
            return false;
        *node = a + further;
        return true;
    }

    NodeValues& grid_;
    const NodeBits &inside_, &frozen_;
    bool isInside_;
    float most_;
    ptrdiff_t sy_, sz_;
    glm::ivec3 bricks_;
    std::vector<uint8_t> reached_;
};

/// Calls work(layer) for all layers, on two threads.
template <class Work>
void eachLayer(int layers, const Progress& progress, const Work& work) {
    // A layer counts as a block of inParallel.
    inParallel(static_cast<size_t>(layers) * kProgressWork, progress, kWorking,
               [&](size_t begin, size_t) { work(static_cast<int>(begin / kProgressWork)); });
}

void sweepBoth(SideSweep& inside, SideSweep& outside, const Progress& progress) {
    inParallel(2 * kProgressWork, progress.silent(), kWorking,
               [&](size_t begin, size_t) { (begin == 0 ? inside : outside).run(progress.silent()); });
}

bool atBorder(const glm::ivec3& at, const glm::ivec3& nodes) {
    return at.x == 0 || at.y == 0 || at.z == 0 || at.x == nodes.x - 1 || at.y == nodes.y - 1 ||
           at.z == nodes.z - 1;
}

} // namespace

bool toDistances(NodeValues& grid, double inside, double outside, uint64_t mostNear,
                 const Progress& progress) {
    const glm::ivec3 n = grid.nodes;
    const ptrdiff_t sy = n.x, sz = static_cast<ptrdiff_t>(n.x) * n.y;
    std::vector<std::vector<NearNode>> near(static_cast<size_t>(n.z));
    const NearSurface surface(grid);
    std::atomic<uint64_t> nearNodes{0};
    eachLayer(n.z, progress.part(0.0, 0.3), [&](int z) {
        if (z == 0 || z + 1 == n.z || nearNodes.load(std::memory_order_relaxed) > mostNear)
            return;
        std::vector<NearNode>& found = near[static_cast<size_t>(z)];
        found = surface.layer(z);
        nearNodes.fetch_add(found.size(), std::memory_order_relaxed);
    });
    if (nearNodes.load(std::memory_order_relaxed) > mostNear)
        return false;
    NodeBits negative(n), frozen(n);
    eachLayer(n.z, progress.part(0.3, 0.4), [&](int z) {
        for (int y = 0; y < n.y; ++y) {
            float* const row = grid.value.data() + y * sy + z * sz;
            for (int x = 0; x < n.x; ++x) {
                if (row[x] < 0.0f)
                    negative.set(x, y, z);
                if (atBorder({x, y, z}, n))
                    frozen.set(x, y, z);
                row[x] = kFarNode;
            }
        }
        for (const NearNode& node : near[static_cast<size_t>(z)]) {
            grid.value[node.node] = node.distance;
            const auto inLayer = static_cast<ptrdiff_t>(node.node) - z * sz;
            frozen.set(static_cast<int>(inLayer % sy), static_cast<int>(inLayer / sy), z);
        }
    });
    near = {};
    SideSweep within(grid, negative, frozen, true, inside), around(grid, negative, frozen, false, outside);
    progress.step(0.4, kWorking);
    sweepBoth(within, around, progress);
    eachLayer(n.z, progress.part(0.9, 1.0), [&](int z) {
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x)
                if ((negative.row(x / kBrick, y, z) >> (x % kBrick) & 1) != 0 && !atBorder({x, y, z}, n))
                    grid.value[static_cast<size_t>(x + y * sy + z * sz)] *= -1.0f;
    });
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; x += y == 0 || z == 0 || y == n.y - 1 || z == n.z - 1 ? 1 : n.x - 1) {
                const glm::ivec3 next = glm::clamp(glm::ivec3(x, y, z), glm::ivec3(1), n - 2);
                grid.value[static_cast<size_t>(x + y * sy + z * sz)] =
                    grid.value[static_cast<size_t>(next.x + next.y * sy + next.z * sz)];
            }
    return true;
}

} // namespace touchstone
