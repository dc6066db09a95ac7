#include "tests/valid_files/shape_parts.h"

#include "assets/shapes.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {
namespace {

glm::dvec3 anywhere(Draw& draw, double reach) {
    return {draw.real(-reach, reach), draw.real(-reach, reach), draw.real(-reach, reach)};
}

/// Triangles anywhere: they cross, and share no edges.
assets::Shape soup(Draw& draw) {
    assets::Shape shape;
    const size_t triangles = 1 + draw.below(30);
    for (size_t i = 0; i < 3 * triangles; ++i) {
        shape.positions.emplace_back(anywhere(draw, 0.05));
        shape.indices.push_back(static_cast<uint32_t>(i));
    }
    return shape;
}

assets::Shape closedForm(Draw& draw) {
    switch (draw.below(7)) {
    case 0:
        return assets::sphere(0.05, 8, 12);
    case 1:
        return assets::torus(0.05, 0.02, 14, 9, {2, 1});
    case 2:
        return assets::box({0.08, 0.05, 0.1}, 2);
    case 3:
        return assets::boxWithSharedCorners({0.08, 0.09, 0.1});
    case 4:
        return assets::plane(0.1, 0.08, 7, 5);
    case 5:
        return assets::prism(7, 0.04, 0.09, true, 2);
    default:
        return soup(draw);
    }
}

/// What exporters leave behind: triangles without area, by their indices, their positions or along a line.
void addDegenerate(Draw& draw, RawShape& shape) {
    for (size_t n = 1 + draw.below(6); n > 0; --n) {
        const auto a = static_cast<uint32_t>(draw.below(shape.positions.size()));
        const auto b = static_cast<uint32_t>(draw.below(shape.positions.size()));
        const auto copy = static_cast<uint32_t>(shape.positions.size());
        switch (draw.below(3)) {
        case 0:
            shape.indices.insert(shape.indices.end(), {a, b, a});
            continue;
        case 1:
            shape.positions.push_back(shape.positions[a]);
            break;
        default:
            shape.positions.push_back(glm::mix(shape.positions[a], shape.positions[b], draw.real(-1.0, 2.0)));
            break;
        }
        shape.normals.push_back(shape.normals[a]);
        shape.uv.push_back(shape.uv[b]);
        shape.indices.insert(shape.indices.end(), {a, b, copy});
    }
}

/// Triangles that are there twice, turned over, or stand on an edge that has two already.
void addNonManifold(Draw& draw, RawShape& shape) {
    for (size_t n = 1 + draw.below(6); n > 0; --n) {
        const size_t t = 3 * draw.below(shape.indices.size() / 3);
        const uint32_t a = shape.indices[t], b = shape.indices[t + 1], c = shape.indices[t + 2];
        const auto other = static_cast<uint32_t>(draw.below(shape.positions.size()));
        switch (draw.below(3)) {
        case 0:
            shape.indices.insert(shape.indices.end(), {a, b, c});
            break;
        case 1:
            shape.indices.insert(shape.indices.end(), {a, c, b});
            break;
        default:
            shape.indices.insert(shape.indices.end(), {a, b, other});
            break;
        }
    }
}

void drawCoordinates(FileDraft& draft, RawShape& shape) {
    if (draft.has(Feature::MirroredUv))
        for (glm::dvec2& uv : shape.uv)
            uv.x = std::abs(2.0 * (uv.x - std::floor(uv.x)) - 1.0);
    if (draft.has(Feature::CollapsedUv)) {
        const bool all = draft.draw.chance(0.3), line = draft.draw.chance(0.5);
        for (glm::dvec2& uv : shape.uv)
            if (all || draft.draw.chance(0.3))
                uv = line ? glm::dvec2(uv.x, 0.25) : glm::dvec2(0.5);
    }
}

} // namespace

RawShape drawShape(FileDraft& draft) {
    Draw& draw = draft.draw;
    const assets::Shape form = closedForm(draw);
    RawShape shape;
    shape.indices = form.indices;
    for (size_t v = 0; v < form.positions.size(); ++v) {
        const glm::dvec3 p(form.positions[v]);
        shape.positions.push_back(p);
        const double length = glm::length(p);
        shape.normals.push_back(!form.normals.empty() ? glm::dvec3(form.normals[v])
                                : length > 0.0        ? p / length
                                                      : glm::dvec3(0.0, 1.0, 0.0));
        shape.uv.push_back(form.uv.empty() ? glm::dvec2(0.5 + 8.0 * p.x, 0.5 - 8.0 * p.z)
                                           : glm::dvec2(form.uv[v]));
    }
    if (draft.has(Feature::Degenerate))
        addDegenerate(draw, shape);
    if (draft.has(Feature::NonManifold))
        addNonManifold(draw, shape);
    if (draft.has(Feature::UnusedVertices))
        for (size_t n = 1 + draw.below(10); n > 0; --n) {
            shape.positions.push_back(anywhere(draw, draw.chance(0.5) ? 0.05 : 1e3));
            shape.normals.emplace_back(0.0, 0.0, 1.0);
            shape.uv.emplace_back(draw.real(-2.0, 2.0), draw.real(0.0, 1.0));
        }
    drawCoordinates(draft, shape);
    double scale = 1.0;
    if (draft.has(Feature::TinyShape))
        scale *= draw.pick(std::vector{1e-3, 1e-6, 1e-12});
    if (draft.has(Feature::HugeShape))
        scale *= draw.pick(std::vector{1e3, 1e6, 1e12});
    const glm::dvec3 centre = draft.has(Feature::OffCentre)
                                  ? scale * anywhere(draw, draw.pick(std::vector{1.0, 1e3}))
                                  : glm::dvec3(0.0);
    for (glm::dvec3& p : shape.positions)
        p = scale * p + centre;
    shape.size = 0.1 * scale;
    return shape;
}

} // namespace touchstone::test
