#include "haptics/texture/texel_map.h"

#include "haptics/shape/mesh/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace touchstone {

namespace {

/// Texels that all triangles together may cross for each texel of the texture.
constexpr double kMaxRepeats = 64.0;
/// Samples that may be looked at for the one that a part of the surface belongs to, in all and for each
/// texel: half a second, and three for a million texels that repeat ten times. (A generated file of 375
/// triangles, where thousands of parts met in each texel, took 29 s.)
constexpr uint64_t kLooks = 20'000'000, kLooksPerTexel = 200;

/// A corner of a triangle, or of a part of it, in the texture: `at` in texels, centres at whole numbers.
struct Corner {
    glm::dvec2 at{0.0};
    glm::dvec3 place{0.0};
};
/// A triangle cut by the four sides of a square has at most seven corners.
struct Polygon {
    std::array<Corner, 8> corners;
    size_t count = 0;
    void add(const Corner& corner) {
        if (count < corners.size())
            corners[count++] = corner;
    }
};

Corner between(const Corner& a, const Corner& b, double part) {
    return {a.at + part * (b.at - a.at), a.place + part * (b.place - a.place)};
}

/// The part of `whole` where sign (at[axis] - limit) >= 0.
void cut(const Polygon& whole, glm::length_t axis, double limit, double sign, Polygon& part) {
    part.count = 0;
    for (size_t i = 0; i < whole.count; ++i) {
        const Corner &a = whole.corners[i], &b = whole.corners[(i + 1) % whole.count];
        const double da = sign * (a.at[axis] - limit), db = sign * (b.at[axis] - limit);
        if (da >= 0.0)
            part.add(a);
        if ((da >= 0.0) != (db >= 0.0))
            part.add(between(a, b, da / (da - db)));
    }
}

uint32_t wrapped(double cell, uint32_t side) {
    const double in = cell - std::floor(cell / side) * side;
    return std::min(static_cast<uint32_t>(std::max(in, 0.0)), side - 1);
}

} // namespace

/// Goes over the triangles and sums up what each texel has of them.
class TexelMapBuilder {
  public:
    TexelMapBuilder(const HapticObject& object, uint32_t width, uint32_t height)
        : object_(object), width_(width), height_(height), first_(size_t{width} * height, kNone),
          last_(first_), mostLooks_(kLooks + kLooksPerTexel * width * height) {}

    std::shared_ptr<const TexelMap> build(const Progress& progress) {
        const size_t count = object_.triangleCount();
        double crossed = 0.0;
        for (size_t t = 0; t < count; ++t)
            crossed += crossedBy(trianglePolygon(t));
        if (!(crossed <= kMaxRepeats * width_ * height_ + 1e6))
            return nullptr;
        for (size_t t = 0; t < count; ++t) {
            if (t % 1024 == 0)
                progress.step(static_cast<double>(t) / static_cast<double>(count), "placing texels");
            add(trianglePolygon(t));
            if (looks_ > mostLooks_)
                return nullptr;
        }
        return finished();
    }

  private:
    static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    /// Sums over the parts of the surface that a texel has in one place.
    struct Sum {
        glm::dvec3 place{0.0}; ///< times area
        double area = 0.0;
        glm::dvec3 normal{
            0.0}; ///< times area; doubles, since floats of a sliver's area have no direction left
        uint32_t texel = 0, next = kNone;
    };

    Polygon trianglePolygon(size_t t) const {
        Polygon polygon;
        const Triangle triangle = triangleOf(object_, static_cast<uint32_t>(t));
        const std::array<glm::dvec3, 3> places{triangle.a, triangle.b, triangle.c};
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec2 uv(object_.uv[0][object_.sourceIndices[3 * t + k]]);
            polygon.add({uv * glm::dvec2(width_, height_) - 0.5, places[k]});
        }
        return polygon;
    }

    static double crossedBy(const Polygon& triangle) {
        const glm::dvec2 a = triangle.corners[1].at - triangle.corners[0].at,
                         b = triangle.corners[2].at - triangle.corners[0].at;
        const double area = 0.5 * std::abs(a.x * b.y - a.y * b.x);
        return area + 2.0 * (glm::length(a) + glm::length(b)) + 1.0;
    }

    /// Cuts the triangle into the squares between texels' centres.
    void add(const Polygon& triangle) {
        const std::array<Corner, 8>& c = triangle.corners;
        const glm::dvec3 across = glm::cross(c[1].place - c[0].place, c[2].place - c[0].place);
        const double area = 0.5 * glm::length(across);
        const glm::dvec2 a = c[1].at - c[0].at, b = c[2].at - c[0].at;
        const double inTexture = 0.5 * std::abs(a.x * b.y - a.y * b.x);
        if (!(area > 0.0) || !std::isfinite(inTexture))
            return;
        normal_ = across / (2.0 * area);
        if (!(inTexture > 1e-9)) { // a line or a point of the texture: all of it at the centre
            const Corner centre{(c[0].at + c[1].at + c[2].at) / 3.0,
                                (c[0].place + c[1].place + c[2].place) / 3.0};
            near_ = std::sqrt(area);
            spread(centre, glm::floor(centre.at), area);
            return;
        }
        density_ = area / inTexture;
        near_ = 4.0 * std::sqrt(std::max(density_, lengthPerTexel(triangle)));
        const auto [low, high] = std::minmax({c[0].at.y, c[1].at.y, c[2].at.y});
        Polygon above, row;
        for (double y = std::floor(low); y <= high && looks_ <= mostLooks_; y += 1.0) {
            cut(triangle, 1, y, 1.0, above);
            cut(above, 1, y + 1.0, -1.0, row);
            if (row.count >= 3)
                addRow(row, y);
        }
    }

    void addRow(const Polygon& row, double y) {
        double low = row.corners[0].at.x, high = low;
        for (size_t i = 1; i < row.count; ++i) {
            low = std::min(low, row.corners[i].at.x);
            high = std::max(high, row.corners[i].at.x);
        }
        Polygon beyond, square;
        for (double x = std::floor(low); x <= high && looks_ <= mostLooks_; x += 1.0) {
            cut(row, 0, x, 1.0, beyond);
            cut(beyond, 0, x + 1.0, -1.0, square);
            for (size_t i = 2; i < square.count; ++i)
                addTriangle(square.corners[0], square.corners[i - 1], square.corners[i], {x, y});
        }
    }

    /// A triangle inside of one square: hats are of second degree there, for which the middles of the sides
    /// are an exact rule.
    void addTriangle(const Corner& a, const Corner& b, const Corner& c, const glm::dvec2& square) {
        const glm::dvec2 u = b.at - a.at, v = c.at - a.at;
        const double part = density_ * 0.5 * std::abs(u.x * v.y - u.y * v.x) / 3.0;
        if (!(part > 0.0))
            return;
        for (const Corner& at : {between(a, b, 0.5), between(b, c, 0.5), between(c, a, 0.5)})
            spread(at, square, part);
    }

    /// `area` at one place among the four texels around it.
    void spread(const Corner& at, const glm::dvec2& square, double area) {
        const glm::dvec2 f = glm::clamp(at.at - square, 0.0, 1.0);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const double weight = (i == 0 ? 1.0 - f.x : f.x) * (j == 0 ? 1.0 - f.y : f.y);
                if (weight > 0.0)
                    addTo(wrapped(square.x + i, width_), wrapped(square.y + j, height_), at.place,
                          area * weight);
            }
    }

    void addTo(uint32_t x, uint32_t y, const glm::dvec3& place, double area) {
        const uint32_t texel = y * width_ + x;
        // Mostly the sample that the last part of the same triangle went to.
        if (last_[texel] != kNone && isOf(sums_[last_[texel]], place)) {
            addTo(sums_[last_[texel]], place, area);
            return;
        }
        uint32_t* link = &first_[texel];
        for (; *link != kNone; ++looks_) {
            Sum& sum = sums_[*link];
            if (isOf(sum, place)) {
                last_[texel] = *link;
                addTo(sum, place, area);
                return;
            }
            link = &sum.next;
        }
        last_[texel] = *link = static_cast<uint32_t>(sums_.size());
        Sum& made = sums_.emplace_back();
        made.texel = texel;
        addTo(made, place, area);
    }
    /// The same side of the same part of the surface?
    bool isOf(const Sum& sum, const glm::dvec3& place) const {
        return glm::dot(sum.normal, normal_) > 0.0 && glm::distance(sum.place / sum.area, place) < near_;
    }
    void addTo(Sum& sum, const glm::dvec3& place, double area) {
        sum.place += area * place;
        sum.normal += area * normal_;
        sum.area += area;
    }

    /// Square of the longest way over the surface along one texel.
    static double lengthPerTexel(const Polygon& triangle) {
        double longest = 0.0;
        for (size_t k = 0; k < 3; ++k) {
            const Corner &a = triangle.corners[k], &b = triangle.corners[(k + 1) % 3];
            const double texels = std::max(glm::distance(a.at, b.at), 1.0),
                         way = glm::distance(a.place, b.place);
            longest = std::max(longest, way * way / (texels * texels));
        }
        return longest;
    }

    std::shared_ptr<const TexelMap> finished() {
        std::erase_if(sums_, [](const Sum& sum) { return !(sum.area > 0.0); });
        const std::shared_ptr<TexelMap> map(new TexelMap);
        map->width_ = width_;
        map->height_ = height_;
        map->areas_.assign(size_t{width_} * height_, 0.0f);
        for (Sum& sum : sums_) {
            sum.place /= sum.area;
            map->areas_[sum.texel] += static_cast<float>(sum.area);
        }
        for (const float area : map->areas_)
            map->area_ += static_cast<double>(area);
        const auto used = std::ranges::count_if(map->areas_, [](float area) { return area > 0.0f; });
        map->spacing_ = used > 0 ? std::sqrt(map->area_ / static_cast<double>(used)) : 0.0;
        sort(*map, 0, 0, sums_.size());
        for (const Sum& sum : sums_) {
            map->x_.push_back(static_cast<float>(sum.place.x));
            map->y_.push_back(static_cast<float>(sum.place.y));
            map->z_.push_back(static_cast<float>(sum.place.z));
            map->normal_.push_back(bytesOf(sum.normal / sum.area));
            map->texel_.push_back(sum.texel);
        }
        return map;
    }

    /// `mean` is at least 1 / sqrt(samples) long, since each that was added looks to its side.
    static std::array<int8_t, 3> bytesOf(const glm::dvec3& mean) {
        std::array<int8_t, 3> bytes{};
        const double length = glm::length(mean);
        for (int axis = 0; length > 0.0 && axis < 3; ++axis)
            bytes[static_cast<size_t>(axis)] =
                static_cast<int8_t>(std::lround(127.0 * std::clamp(mean[axis] / length, -1.0, 1.0)));
        return bytes;
    }

    /// Halves the samples along the longer side of their box, down to leaves.
    void sort(TexelMap& map, size_t node, size_t begin, size_t end) {
        if (node >= map.boxes_.size())
            map.boxes_.resize(node + 1);
        glm::dvec3 min(std::numeric_limits<double>::infinity()), max = -min;
        for (size_t i = begin; i < end; ++i) {
            min = glm::min(min, sums_[i].place);
            max = glm::max(max, sums_[i].place);
        }
        constexpr float kRounding = 1e-6f; // of floats in a frame whose longest side is 1
        map.boxes_[node] = {glm::vec3(min) - kRounding, glm::vec3(max) + kRounding};
        if (end - begin <= TexelMap::kLeaf)
            return;
        const glm::dvec3 size = max - min;
        const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const size_t middle = begin + (end - begin) / 2;
        const auto at = [&](size_t i) { return sums_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [axis](const Sum& a, const Sum& b) {
            return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis] : a.texel < b.texel;
        });
        sort(map, 2 * node + 1, begin, middle);
        sort(map, 2 * node + 2, middle, end);
    }

    const HapticObject& object_;
    uint32_t width_, height_;
    std::vector<uint32_t> first_, last_; // by texel: its first sum, that which was added to last
    std::vector<Sum> sums_;
    uint64_t looks_ = 0, mostLooks_;
    // Of the triangle that is added:
    glm::dvec3 normal_{0.0};
    double density_ = 0.0, near_ = 0.0;
};

std::shared_ptr<const TexelMap> TexelMap::of(const HapticObject& object, uint32_t width, uint32_t height,
                                             const Progress& progress) {
    if (object.shape != nullptr || object.uv[0].empty() || object.indices.empty() || width == 0 ||
        height == 0)
        return nullptr;
    return TexelMapBuilder(object, width, height).build(progress);
}

uint64_t TexelMap::memoryBytes() const {
    return sizeof(float) * areas_.size() +
           texel_.size() * (3 * sizeof(float) + sizeof(normal_[0]) + sizeof(uint32_t)) +
           sizeof(Box) * boxes_.size();
}

void TexelMap::reach(const glm::dvec3& point, const glm::dvec3& normal, double radius, uint32_t most,
                     Reached& reached) const noexcept {
    reached.count = 0;
    reached.full = false;
    most = std::min(most, static_cast<uint32_t>(kMaxReached));
    struct Open {
        size_t node, begin, end;
    };
    std::array<Open, 64> open; // each level leaves one node open, and halving ends after 59
    size_t count = 0;
    if (!texel_.empty())
        open[count++] = {0, 0, texel_.size()};
    const glm::vec3 p(point), n(normal);
    const float square = static_cast<float>(radius * radius), inverse = 1.0f / square;
    while (count > 0) {
        const Open at = open[--count];
        const Box& box = boxes_[at.node];
        const glm::vec3 beyond = glm::max(glm::max(box.min - p, p - box.max), 0.0f);
        if (!(glm::dot(beyond, beyond) < square))
            continue;
        if (at.end - at.begin > kLeaf) {
            const size_t middle = at.begin + (at.end - at.begin) / 2;
            open[count++] = {2 * at.node + 2, middle, at.end};
            open[count++] = {2 * at.node + 1, at.begin, middle};
            continue;
        }
        for (size_t i = at.begin; i < at.end; ++i) {
            const float x = x_[i] - p.x, y = y_[i] - p.y, z = z_[i] - p.z;
            const float r = x * x + y * y + z * z;
            const float facing = n.x * normal_[i][0] + n.y * normal_[i][1] + n.z * normal_[i][2];
            if (!(r < square) || facing < -63.5f)
                continue;
            if (reached.count == most) {
                reached.full = true;
                return;
            }
            const float left = 1.0f - r * inverse;
            reached.texel[reached.count] = texel_[i];
            reached.weight[reached.count++] = left * left;
        }
    }
}

} // namespace touchstone
