#include "renderer/overlay_geometry.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kSides = 24;          ///< of round shapes
constexpr double kHeadLength = 5.0; ///< of an arrow, in shaft radii
constexpr double kHeadRadius = 2.4;

class ShapeBuilder {
  public:
    explicit ShapeBuilder(ShapeMeshes& meshes) : meshes_(meshes) {}

    void begin(OverlayShape shape) {
        shape_ = static_cast<size_t>(shape);
        meshes_.ranges[shape_].firstIndex = static_cast<uint32_t>(meshes_.indices.size());
    }
    void end() {
        auto& range = meshes_.ranges[shape_];
        range.indexCount = static_cast<uint32_t>(meshes_.indices.size()) - range.firstIndex;
    }
    uint16_t vertex(const glm::dvec3& position, const glm::dvec3& normal) {
        meshes_.vertices.push_back({glm::vec3(position), glm::vec3(glm::normalize(normal))});
        return static_cast<uint16_t>(meshes_.vertices.size() - 1);
    }
    void triangle(int a, int b, int c) {
        for (const int i : {a, b, c})
            meshes_.indices.push_back(static_cast<uint16_t>(i));
    }
    /// A band of quads between two rings of kSides + 1 vertices; `lower` is the lower one, seen from outside.
    void band(int lower, int upper) {
        for (int i = 0; i < kSides; ++i) {
            triangle(lower + i, lower + i + 1, upper + i + 1);
            triangle(lower + i, upper + i + 1, upper + i);
        }
    }
    /// Vertices of radius r at height y; the normal is the outward direction with the slope ny.
    int ring(double y, double r, double ny) {
        int first = 0;
        for (int i = 0; i <= kSides; ++i) {
            const double angle = glm::two_pi<double>() * i / kSides;
            // From +z over +x: counter-clockwise seen from above, so that bands face outwards.
            const glm::dvec3 out(std::sin(angle), 0.0, std::cos(angle));
            const int index = vertex(r * out + glm::dvec3(0.0, y, 0.0),
                                     out * (1.0 - std::abs(ny)) + glm::dvec3(0.0, ny, 0.0));
            if (i == 0)
                first = index;
        }
        return first;
    }
    void cap(double y, double ny) {
        const int centre = vertex({0.0, y, 0.0}, {0.0, ny, 0.0});
        const int edge = ring(y, 1.0, ny);
        for (int i = 0; i < kSides; ++i)
            ny > 0.0 ? triangle(centre, edge + i, edge + i + 1) : triangle(centre, edge + i + 1, edge + i);
    }

  private:
    ShapeMeshes& meshes_;
    size_t shape_ = 0;
};

void buildSphere(ShapeBuilder& builder) {
    constexpr int kStacks = kSides / 2;
    builder.begin(OverlayShape::Sphere);
    int below = -1;
    for (int stack = 0; stack <= kStacks; ++stack) {
        const double latitude = glm::pi<double>() * (static_cast<double>(stack) / kStacks - 0.5);
        int first = 0;
        for (int i = 0; i <= kSides; ++i) {
            const double angle = glm::two_pi<double>() * i / kSides;
            const glm::dvec3 p(std::cos(latitude) * std::sin(angle), std::sin(latitude),
                               std::cos(latitude) * std::cos(angle));
            const int index = builder.vertex(p, p);
            if (i == 0)
                first = index;
        }
        if (below >= 0)
            builder.band(below, first);
        below = first;
    }
    builder.end();
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// One shape with its distance from the eye.
struct Item {
    OverlayShape shape;
    ShapeInstance instance;
    double distance;
};

class ShapeLayout {
  public:
    explicit ShapeLayout(const glm::dvec3& eye) : eye_(eye) {}

    /// Columns x, y, z of the map and its origin, workspace.
    void add(OverlayShape shape, const glm::dmat3& axes, const glm::dvec3& origin, const glm::vec4& color) {
        const glm::dvec3 t = origin - eye_;
        Item item{shape, {}, glm::length(t)};
        for (int row = 0; row < 3; ++row)
            item.instance.eyeFromShape[static_cast<size_t>(row)] =
                glm::vec4(glm::dvec4(axes[0][row], axes[1][row], axes[2][row], t[row]));
        item.instance.color = color;
        (color.w < 1.0f ? translucent_ : opaque_).push_back(item);
    }

    OverlayDraw finish() {
        std::stable_sort(opaque_.begin(), opaque_.end(),
                         [](const Item& a, const Item& b) { return a.shape < b.shape; });
        std::stable_sort(translucent_.begin(), translucent_.end(),
                         [](const Item& a, const Item& b) { return a.distance > b.distance; });
        OverlayDraw draw;
        for (const bool translucent : {false, true})
            for (const Item& item : translucent ? translucent_ : opaque_) {
                if (draw.batches.empty() || draw.batches.back().shape != item.shape ||
                    draw.batches.back().translucent != translucent)
                    draw.batches.push_back(
                        {item.shape, translucent, static_cast<uint32_t>(draw.shapes.size()), 0});
                ++draw.batches.back().count;
                draw.shapes.push_back(item.instance);
            }
        return draw;
    }

  private:
    glm::dvec3 eye_;
    std::vector<Item> opaque_, translucent_;
};

/// A right-handed frame with y along `axis` (unit).
glm::dmat3 frameAlong(const glm::dvec3& axis) {
    const glm::dvec3 other = std::abs(axis.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 z = glm::normalize(glm::cross(other, axis));
    return {glm::cross(axis, z), axis, z};
}

void addArrow(ShapeLayout& layout, const Overlay::Arrow& arrow) {
    const glm::dvec3 along = arrow.to - arrow.from;
    const double length = glm::length(along);
    if (!finite(arrow.from) || !finite(arrow.to) || !(arrow.radius > 0.0) || !(length > 0.0))
        return;
    const double shrink = std::min(1.0, length / (kHeadLength * arrow.radius));
    const double head = kHeadLength * arrow.radius * shrink, headRadius = kHeadRadius * arrow.radius * shrink;
    const glm::dmat3 frame = frameAlong(along / length);
    const auto scaled = [&](double radius, double height) {
        return glm::dmat3(frame[0] * radius, frame[1] * height, frame[2] * radius);
    };
    if (shrink >= 1.0 && length > head)
        layout.add(OverlayShape::Cylinder, scaled(arrow.radius, length - head), arrow.from, arrow.color);
    layout.add(OverlayShape::Cone, scaled(headRadius, head), arrow.to - head * frame[1], arrow.color);
}

} // namespace

ShapeMeshes makeShapeMeshes() {
    ShapeMeshes meshes;
    ShapeBuilder builder(meshes);
    buildSphere(builder);
    builder.begin(OverlayShape::Cylinder);
    {
        const int lower = builder.ring(0.0, 1.0, 0.0);
        const int upper = builder.ring(1.0, 1.0, 0.0);
        builder.band(lower, upper);
    }
    builder.cap(0.0, -1.0);
    builder.cap(1.0, 1.0);
    builder.end();
    builder.begin(OverlayShape::Cone);
    {
        const int lower = builder.ring(0.0, 1.0, 0.5);
        const int tip = builder.ring(1.0, 0.0, 0.5);
        builder.band(lower, tip);
    }
    builder.cap(0.0, -1.0);
    builder.end();
    builder.begin(OverlayShape::Disc);
    builder.cap(0.0, 1.0);
    builder.end();
    return meshes;
}

OverlayDraw layOut(const Overlay& overlay, const glm::dvec3& eye) {
    ShapeLayout layout(eye);
    for (const Overlay::Sphere& sphere : overlay.spheres)
        if (finite(sphere.centre) && sphere.radius > 0.0)
            layout.add(OverlayShape::Sphere, glm::dmat3(sphere.radius), sphere.centre, sphere.color);
    for (const Overlay::Arrow& arrow : overlay.arrows)
        addArrow(layout, arrow);
    for (const Overlay::Disc& disc : overlay.discs) {
        const double length = glm::length(disc.normal);
        if (!finite(disc.centre) || !(disc.radius > 0.0) || !(length > 0.0))
            continue;
        const glm::dmat3 frame = frameAlong(disc.normal / length);
        layout.add(OverlayShape::Disc, disc.radius * frame, disc.centre, disc.color);
    }
    OverlayDraw draw = layout.finish();
    const auto addLines = [&](const std::vector<Overlay::Line>& lines) {
        for (const Overlay::Line& line : lines)
            if (finite(line.from) && finite(line.to))
                draw.lines.push_back({glm::vec4(glm::vec3(line.from - eye), line.width),
                                      glm::vec4(glm::vec3(line.to - eye), 0.0f), line.color});
    };
    addLines(overlay.lines);
    draw.shownHidden = static_cast<uint32_t>(draw.lines.size());
    addLines(overlay.grid);
    return draw;
}

} // namespace touchstone
