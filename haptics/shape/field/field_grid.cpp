#include "haptics/shape/field/field_grid.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"

#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace touchstone {

namespace {

constexpr float kVaries = std::numeric_limits<float>::quiet_NaN();

[[noreturn]] void refuse(const std::string& problem, const char* remedy) {
    throw Error("distance field", "", problem, remedy);
}

void checkLayout(const FieldLayout& layout) {
    const glm::ivec3& n = layout.cells;
    if (n.x <= 0 || n.y <= 0 || n.z <= 0)
        refuse("has no cell", "give it at least one cell on each axis");
    const uint64_t cells =
        static_cast<uint64_t>(n.x) * static_cast<uint64_t>(n.y) * static_cast<uint64_t>(n.z);
    if (std::max({n.x, n.y, n.z}) > FieldGrid::kMostOnAxis || cells >= FieldGrid::kMostCells)
        refuse("has " + std::to_string(cells) + " cells, of which 4294967295 fit", "use larger voxels");
    if (!(layout.voxel > 0.0) || !std::isfinite(layout.voxel) ||
        !std::isfinite(layout.origin.x + layout.origin.y + layout.origin.z))
        refuse("has a voxel size or a place that is not a finite positive number", "check its file");
}

bool inside(const glm::ivec3& node, const glm::ivec3& cells) {
    return node.x <= cells.x && node.y <= cells.y && node.z <= cells.z;
}

} // namespace

FieldGrid::FieldGrid(const FieldLayout& layout, double inside, double outside, const FillBrick& fill)
    : layout_(layout), inside_(inside), outside_(outside) {
    checkLayout(layout);
    if (!(inside > 0.0) || !(outside > 0.0) || !std::isfinite(inside + outside))
        refuse("reaches no finite distance from the surface", "give both sides a positive one");
    bricks_ = (layout.cells + (kBrick - 1)) / kBrick;
    table_.reserve(static_cast<size_t>(bricks_.x) * static_cast<size_t>(bricks_.y) *
                   static_cast<size_t>(bricks_.z));
    steepest_.reserve(table_.capacity());
    std::vector<float> nodes(kBrickNodes);
    for (int z = 0; z < bricks_.z; ++z)
        for (int y = 0; y < bricks_.y; ++y)
            for (int x = 0; x < bricks_.x; ++x)
                fillBrick({x, y, z}, fill, nodes);
    setLipschitz();
    Hash64 hash;
    hash.add(layout.voxel);
    for (int axis = 0; axis < 3; ++axis) {
        hash.add(layout.origin[axis]);
        hash.add(layout.cells[axis]);
    }
    for (const Brick& brick : table_)
        hash.add(brick.nodes == nullptr ? brick.flat : -0.0f);
    for (int z = 0; z < bricks_.z; ++z)
        for (int y = 0; y < bricks_.y; ++y)
            for (int x = 0; x < bricks_.x; ++x) {
                if (brickOf({x, y, z}).nodes == nullptr)
                    continue;
                copyBrick({x, y, z}, std::span<float, kBrickNodes>(nodes));
                for (const float value : nodes)
                    hash.add(value);
            }
    hash_ = hash.value();
}

void FieldGrid::fillBrick(const glm::ivec3& brick, const FillBrick& fill, std::vector<float>& nodes) {
    const glm::ivec3 first = kBrick * brick;
    fill(first, nodes);
    if (!touchstone::inside(first + kBrick, layout_.cells))
        eachBrickNode([&](const glm::ivec3& at) {
            if (!touchstone::inside(first + at, layout_.cells))
                nodes[brickNode(at)] = static_cast<float>(outside_); // beyond the grid: read by no cell
        });
    const auto deepest = static_cast<float>(-inside_), farthest = static_cast<float>(outside_);
    float least = INFINITY, most = -INFINITY, sum = 0.0f;
    for (float& value : nodes) {
        sum += 0.0f * value; // not a number where one is not finite
        value = std::min(std::max(value, deepest), farthest);
        least = std::min(least, value);
        most = std::max(most, value);
    }
    if (sum != sum)
        refuse("has a node that is no finite number", "check its file");
    if (glm::any(glm::equal(first, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(first + kBrick, layout_.cells)))
        checkBorder(first, nodes);
    const BrickMeasure measure = measureBrick(first, glm::min(glm::ivec3(kBrick), layout_.cells - first),
                                              std::span<const float, kBrickNodes>(nodes));
    include(measure);
    const bool flat = least == most;
    table_.push_back(flat ? Brick{nullptr, least, 0} : kept(brick, nodes));
    steepest_.push_back(flat ? 0.0f : measure.steepest);
}

FieldGrid::FieldGrid(std::shared_ptr<const FieldGrid> base, std::vector<BrickEdit> edits)
    : layout_(base->layout_), inside_(base->inside_), outside_(base->outside_), bricks_(base->bricks_),
      table_(base->table_), steepest_(base->steepest_), base_(std::move(base)), edits_(std::move(edits)),
      low_(base_->low_), high_(base_->high_), hash_(base_->hash_) {
    Hash64 hash;
    hash.add(base_->hash_);
    for (const BrickEdit& edit : edits_) {
        const EditedBrick& brick = *edit.brick;
        const bool flat = brick.flat == brick.flat;
        table_[edit.number] =
            flat ? Brick{nullptr, brick.flat, 0} : Brick{brick.nodes.data(), kVaries, kNodes};
        steepest_[edit.number] = flat ? 0.0f : brick.measure.steepest;
        include(brick.measure);
        hash.add(edit.number);
        hash.add(brick.hash);
    }
    setLipschitz();
    if (!edits_.empty())
        hash_ = hash.value();
}

/// The next bricks keep the last nodes, where there are next ones, or the nodes lie beyond the grid.
FieldGrid::Brick FieldGrid::kept(const glm::ivec3& brick, std::span<const float> nodes) {
    const bool last = glm::any(glm::equal(kBrick * (brick + 1), layout_.cells));
    const int side = last ? kNodes : kBrick;
    const size_t count = static_cast<size_t>(side) * static_cast<size_t>(side) * static_cast<size_t>(side);
    if (used_ + count > kChunk) {
        chunks_.push_back(std::make_unique<float[]>(kChunk));
        used_ = 0;
    }
    float* const place = chunks_.back().get() + used_;
    used_ += count;
    float* to = place;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            to = std::copy_n(nodes.data() + brickNode({0, y, z}), side, to);
    return {place, kVaries, static_cast<uint32_t>(side)};
}

void FieldGrid::checkBorder(const glm::ivec3& first, std::span<const float> nodes) const {
    eachBrickNode([&](const glm::ivec3& at) {
        const glm::ivec3 node = first + at;
        if (!touchstone::inside(node, layout_.cells))
            return;
        const bool border = node.x == 0 || node.y == 0 || node.z == 0 || node.x == layout_.cells.x ||
                            node.y == layout_.cells.y || node.z == layout_.cells.z;
        if (border && !(nodes[brickNode(at)] > 0.0f))
            refuse("reaches the border of its grid", "leave a voxel of free space on every side");
    });
}

void FieldGrid::include(const BrickMeasure& measure) {
    if (measure.low.x > measure.high.x)
        return;
    low_ = glm::min(low_, layout_.origin + layout_.voxel * glm::dvec3(measure.low));
    high_ = glm::max(high_, layout_.origin + layout_.voxel * glm::dvec3(measure.high));
}

void FieldGrid::setLipschitz() {
    float steepest = 0.0f;
    for (const float of : steepest_)
        steepest = std::max(steepest, of);
    constexpr double kRounded = 1.0 + 1e-6; // the sum is of floats
    lipschitz_ = kRounded * std::sqrt(static_cast<double>(steepest)) / layout_.voxel;
}

size_t FieldGrid::memoryBytes() const noexcept {
    return sizeof *this + table_.capacity() * sizeof(Brick) + steepest_.capacity() * sizeof(float) +
           chunks_.size() * kChunk * sizeof(float) +
           edits_.size() * (sizeof(BrickEdit) + sizeof(EditedBrick)) +
           (base_ != nullptr ? base_->memoryBytes() : 0);
}

uint32_t FieldGrid::brickNumber(const glm::ivec3& brick) const noexcept {
    return static_cast<uint32_t>(brick.x) +
           static_cast<uint32_t>(bricks_.x) *
               (static_cast<uint32_t>(brick.y) +
                static_cast<uint32_t>(bricks_.y) * static_cast<uint32_t>(brick.z));
}

const FieldGrid::Brick& FieldGrid::brickOf(const glm::ivec3& brick) const noexcept {
    return table_[brickNumber(brick)];
}

/// A node of a brick, counted from its first one; outside() beyond the grid.
float FieldGrid::valueIn(glm::ivec3 brick, glm::ivec3 at) const noexcept {
    const Brick& own = brickOf(brick);
    if (own.nodes == nullptr)
        return own.flat;
    for (int axis = 0; axis < 3 && own.side == kBrick; ++axis)
        if (at[axis] == kBrick) {
            at[axis] = 0;
            ++brick[axis];
        }
    if (glm::any(glm::greaterThanEqual(brick, bricks_)))
        return static_cast<float>(outside_);
    return brickOf(brick).value(glm::uvec3(at));
}

void FieldGrid::copyBrick(const glm::ivec3& brick, std::span<float, kBrickNodes> nodes) const noexcept {
    const Brick& own = brickOf(brick);
    if (own.nodes == nullptr) {
        std::ranges::fill(nodes, own.flat);
        return;
    }
    if (own.side == kNodes) {
        std::copy_n(own.nodes, kBrickNodes, nodes.begin());
        return;
    }
    if (glm::all(glm::lessThan(brick + 1, bricks_))) {
        for (int k = 0; k < 8; ++k) {
            const glm::ivec3 step(k & 1, k >> 1 & 1, k >> 2);
            brickOf(brick + step)
                .copy(glm::ivec3(0), kBrick - (kBrick - 1) * step, &nodes[brickNode(kBrick * step)], kNodes,
                      kNodes * kNodes);
        }
        return;
    }
    float* to = nodes.data();
    for (int z = 0; z < kNodes; ++z)
        for (int y = 0; y < kNodes; ++y) {
            int x = 0;
            if (y < kBrick && z < kBrick) {
                to = std::copy_n(own.nodes + kBrick * (y + kBrick * z), kBrick, to);
                x = kBrick;
            }
            for (; x < kNodes; ++x)
                *to++ = valueIn(brick, {x, y, z});
        }
}

void FieldGrid::copyNodes(const glm::ivec3& first, const glm::ivec3& size,
                          std::span<float> values) const noexcept {
    const auto row = static_cast<size_t>(size.x);
    copyNodes(first, size, values.data(), row, row * static_cast<size_t>(size.y));
}

void FieldGrid::copyNodes(const glm::ivec3& first, const glm::ivec3& size, float* values, size_t row,
                          size_t layer) const noexcept {
    const glm::ivec3 low = glm::min(first / kBrick, bricks_ - 1);
    const glm::ivec3 high = glm::min((first + size - 1) / kBrick, bricks_ - 1);
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = high.x; x >= low.x; --x) {
                const glm::ivec3 brick(x, y, z), start = kBrick * brick;
                const glm::ivec3 from = glm::max(first - start, glm::ivec3(0));
                glm::ivec3 end = first + size - start;
                if (x < high.x) // overwrites what the next brick gave
                    end.x = std::min(end.x, brickOf(brick).inRow());
                if (y < high.y)
                    end.y = kBrick;
                if (z < high.z)
                    end.z = kBrick;
                const glm::uvec3 to(start + from - first);
                brickOf(brick).copy(from, end, values + to.x + row * to.y + layer * to.z, row, layer);
            }
}

void FieldGrid::copyRows(const glm::ivec3& brick, const glm::ivec2& from, const glm::ivec2& end,
                         float* values, size_t row, size_t layer) const noexcept {
    const Brick& own = brickOf(brick);
    own.copy({0, from.x, from.y}, {own.inRow(), end.x, end.y}, values, row, layer);
}

void FieldGrid::Brick::copy(const glm::ivec3& from, const glm::ivec3& end, float* values, size_t row,
                            size_t layer) const noexcept {
    const int count = end.x - from.x;
    for (int z = from.z; z < end.z; ++z, values += layer) {
        float* to = values;
        for (int y = from.y; y < end.y; ++y, to += row) {
            if (nodes == nullptr) {
                std::fill_n(to, count, flat);
                continue;
            }
            const float* const own = nodes + place(glm::uvec3(from.x, y, z));
            if (count < kBrick) {
                for (int x = 0; x < count; ++x)
                    to[x] = own[x];
                continue;
            }
            std::memcpy(to, own, kBrick * sizeof(float)); // no call, as the length is known
            if (count > kBrick)
                to[kBrick] = own[kBrick];
        }
    }
}

glm::ivec3 FieldGrid::cellAt(const glm::dvec3& grid) const noexcept {
    glm::ivec3 cell;
    for (int axis = 0; axis < 3;
         ++axis) { // comparisons that NaN fails: cell 0 (fmax is a call of the library)
        const double last = layout_.cells[axis] - 1, place = grid[axis] > 0.0 ? grid[axis] : 0.0;
        cell[axis] = static_cast<int>(place < last ? place : last);
    }
    return cell;
}

FieldCell FieldGrid::cell(const glm::ivec3& at) const noexcept {
    constexpr auto kSide = static_cast<uint32_t>(kBrick);
    const glm::uvec3 cell(at), own = cell / kSide, in = cell % kSide;
    const glm::uvec3 pitch(1u, static_cast<uint32_t>(bricks_.x),
                           static_cast<uint32_t>(bricks_.x) * static_cast<uint32_t>(bricks_.y));
    const Brick* const brick = &table_[own.x * pitch.x + own.y * pitch.y + own.z * pitch.z];
    if (brick->nodes == nullptr) {
        FieldCell flat;
        flat.c[0] = static_cast<double>(brick->flat);
        return flat;
    }
    std::array<double, 8> node{};
    if (brick->side == kSide && (in.x == kSide - 1 || in.y == kSide - 1 || in.z == kSide - 1)) {
        // Of each axis the place of the far nodes, and the way to the brick that has them.
        glm::uvec3 far = in + 1u, step(0u);
        for (int axis = 0; axis < 3; ++axis)
            if (far[axis] == kSide) {
                far[axis] = 0;
                step[axis] = pitch[axis];
            }
        for (uint32_t row = 0; row < 4; ++row) {
            const bool y = (row & 1) != 0, z = (row & 2) != 0;
            const Brick* const has = brick + (y ? step.y : 0) + (z ? step.z : 0);
            const uint32_t v = y ? far.y : in.y, w = z ? far.z : in.z;
            node[2 * row] = static_cast<double>(has->value({in.x, v, w}));
            node[2 * row + 1] = static_cast<double>(has[step.x].value({far.x, v, w}));
        }
        return FieldCell::between(node);
    }
    const size_t side = brick->side;
    const float* const values = brick->nodes + in.x + side * (in.y + side * in.z);
    for (size_t k = 0; k < 8; ++k)
        node[k] = static_cast<double>(values[(k & 1) + (k >> 1 & 1) * side + (k >> 2) * side * side]);
    return FieldCell::between(node);
}

float FieldGrid::flatBrick(const glm::ivec3& cell) const noexcept {
    return brickOf(cell / kBrick).flat;
}

uint32_t FieldGrid::numberOf(const glm::ivec3& cell) const noexcept {
    return static_cast<uint32_t>(cell.x) +
           static_cast<uint32_t>(layout_.cells.x) *
               (static_cast<uint32_t>(cell.y) +
                static_cast<uint32_t>(layout_.cells.y) * static_cast<uint32_t>(cell.z));
}

glm::ivec3 FieldGrid::cellOf(uint32_t number) const noexcept {
    const auto nx = static_cast<uint32_t>(layout_.cells.x), ny = static_cast<uint32_t>(layout_.cells.y),
               nz = static_cast<uint32_t>(layout_.cells.z);
    return {number % nx, number / nx % ny, std::min(number / nx / ny, nz - 1)};
}

double FieldGrid::node(const glm::ivec3& at) const noexcept {
    const glm::ivec3 brick = glm::min(at, layout_.cells - 1) / kBrick;
    return static_cast<double>(valueIn(brick, at - kBrick * brick));
}

glm::dvec3 FieldGrid::nodeGradient(const glm::ivec3& at) const noexcept {
    glm::dvec3 gradient(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 before = at, after = at;
        before[axis] = std::max(at[axis] - 1, 0);
        after[axis] = std::min(at[axis] + 1, layout_.cells[axis]);
        gradient[axis] = (node(after) - node(before)) / (layout_.voxel * (after[axis] - before[axis]));
    }
    return gradient;
}

FieldGrid gridOfDistance(const FieldLayout& layout, double inside, double outside,
                         const std::function<double(const glm::dvec3&)>& distance) {
    return FieldGrid(layout, inside, outside, [&](const glm::ivec3& first, std::span<float> nodes) {
        const auto place = [&](const glm::dvec3& node) {
            return layout.origin + layout.voxel * (glm::dvec3(first) + node);
        };
        const double middle = distance(place(glm::dvec3(0.5 * FieldGrid::kBrick)));
        const double half = 0.5 * std::sqrt(3.0) * FieldGrid::kBrick * layout.voxel;
        if (middle - half > outside || middle + half < -inside) {
            std::ranges::fill(nodes, static_cast<float>(middle));
            return;
        }
        size_t i = 0;
        for (int z = 0; z < FieldGrid::kNodes; ++z)
            for (int y = 0; y < FieldGrid::kNodes; ++y)
                for (int x = 0; x < FieldGrid::kNodes; ++x)
                    nodes[i++] = static_cast<float>(distance(place({x, y, z})));
    });
}

} // namespace touchstone
