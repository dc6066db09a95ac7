#include "workbench/screen/field_slice.h"

#include "engine/math/similarity.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/cut_field.h"
#include "renderer/overlay.h"
#include "workbench/figures/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace touchstone {

namespace {

constexpr glm::vec4 kSurfaceColor{1.0f, 1.0f, 1.0f, 1.0f}, kOutsideColor{1.0f, 0.45f, 0.05f, 0.9f},
    kInsideColor{0.1f, 0.45f, 1.0f, 0.9f}, kArrowColor{0.15f, 0.8f, 0.25f, 1.0f};

struct SlicedField {
    const FieldShape* shape;
    Similarity sceneFromObject;
};

std::vector<SlicedField> fieldsOf(const HapticScene& scene) {
    std::vector<SlicedField> fields;
    for (const auto& object : scene.objects)
        if (const FieldShape* const shape = wholeField(object->shape.get()))
            fields.push_back({shape, scene.workspaceFromScene.inverseTimes(object->workspaceFromObject)});
    return fields;
}

/// Of the grid's solid part, and as far outside as it tells distances; scene frame.
Bounds reachOf(const SlicedField& field) {
    const FieldGrid& grid = field.shape->grid();
    Bounds bounds;
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 corner(k & 1, k >> 1 & 1, k >> 2);
        const glm::dvec3 low = grid.low() - grid.outside(), high = grid.high() + grid.outside();
        bounds.include(field.sceneFromObject.point(glm::mix(low, high, corner)));
    }
    return bounds;
}

/// 1, 2 or 5 times a power of ten, at least `least`.
double isolineSpacing(double least) {
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least * (1.0 - 1e-9))
            return factor * power;
    return 10.0 * power;
}

/// The values of a field on a square lattice in the slice.
class SliceLattice {
  public:
    SliceLattice(const SlicedField& field, int axis, double place) : field_(field), axis_(axis) {
        const Bounds reach = reachOf(field);
        low_ = reach.low;
        low_[axis] = place;
        const glm::dvec3 extent = reach.extent();
        u_ = (axis + 1) % 3, v_ = (axis + 2) % 3;
        step_ = std::max(extent[u_], extent[v_]) / kSliceCells;
        nu_ = static_cast<int>(std::ceil(extent[u_] / step_));
        nv_ = static_cast<int>(std::ceil(extent[v_] / step_));
        values_.reserve(static_cast<size_t>((nu_ + 1) * (nv_ + 1)));
        for (int j = 0; j <= nv_; ++j)
            for (int i = 0; i <= nu_; ++i)
                values_.push_back(field.sceneFromObject.scale *
                                  field.shape->value(field.sceneFromObject.inversePoint(placeOf(i, j))));
    }

    /// The isoline of a level, m: marching squares. A saddle is divided by the mean of its corners.
    template <class Segment>
    void isoline(double level, const Segment& segment) const {
        for (int j = 0; j < nv_; ++j)
            for (int i = 0; i < nu_; ++i)
                square(i, j, level, segment);
    }
    template <class Visit>
    void eachArrowNode(const Visit& visit) const {
        for (int j = kArrowCells / 2; j <= nv_; j += kArrowCells)
            for (int i = kArrowCells / 2; i <= nu_; i += kArrowCells)
                visit(placeOf(i, j), at(i, j));
    }
    [[nodiscard]] double step() const { return step_; }

  private:
    [[nodiscard]] glm::dvec3 placeOf(double i, double j) const {
        glm::dvec3 place = low_;
        place[u_] += i * step_;
        place[v_] += j * step_;
        return place;
    }
    [[nodiscard]] double at(int i, int j) const { return values_[static_cast<size_t>(j * (nu_ + 1) + i)]; }

    template <class Segment>
    void square(int i, int j, double level, const Segment& segment) const {
        constexpr std::array<glm::ivec2, 4> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        std::array<double, 4> value{};
        std::array<glm::dvec3, 4> crossing{};
        int count = 0;
        for (size_t k = 0; k < 4; ++k)
            value[k] = at(i + kCorners[k].x, j + kCorners[k].y) - level;
        for (size_t k = 0; k < 4; ++k) {
            const double a = value[k], b = value[(k + 1) % 4];
            if ((a < 0.0) == (b < 0.0))
                continue;
            const glm::dvec2 from(kCorners[k]), to(kCorners[(k + 1) % 4]),
                on = glm::mix(from, to, a / (a - b));
            crossing[static_cast<size_t>(count++)] = placeOf(i + on.x, j + on.y);
        }
        if (count == 2) {
            segment(crossing[0], crossing[1]);
        } else if (count == 4) {
            const bool middleIsInside = value[0] + value[1] + value[2] + value[3] < 0.0;
            const bool joins = (value[0] < 0.0) == middleIsInside; // corner 0 with corner 2
            segment(crossing[0], crossing[joins ? 1 : 3]);
            segment(crossing[2], crossing[joins ? 3 : 1]);
        }
    }

    const SlicedField& field_;
    int axis_, u_ = 0, v_ = 1, nu_ = 0, nv_ = 0;
    double step_ = 0.0;
    glm::dvec3 low_{0.0};
    std::vector<double> values_;
};

void drawField(const HapticScene& scene, const SlicedField& field, int axis, float pixelScale,
               SliceFigures& figures, Overlay& overlay) {
    const SliceLattice lattice(field, axis, figures.place);
    const FieldGrid& grid = field.shape->grid();
    const double inside = field.sceneFromObject.scale * grid.inside(),
                 outside = field.sceneFromObject.scale * grid.outside();
    for (int k = -kIsolines; k <= kIsolines; ++k) {
        const double level = k * figures.spacing;
        if (level <= -inside || level >= outside)
            continue;
        const glm::vec4& color = k == 0 ? kSurfaceColor : k > 0 ? kOutsideColor : kInsideColor;
        lattice.isoline(level, [&](const glm::dvec3& from, const glm::dvec3& to) {
            overlay.lines.push_back({.from = scene.workspaceFromScene.point(from),
                                     .to = scene.workspaceFromScene.point(to),
                                     .color = color,
                                     .width = (k == 0 ? 2.5f : 1.5f) * pixelScale});
            ++figures.lines;
        });
    }
    const double length = 0.8 * kArrowCells * lattice.step();
    lattice.eachArrowNode([&](const glm::dvec3& place, double value) {
        if (value <= -inside || value >= outside)
            return;
        // Of a distance: per object unit it is 1.
        const glm::dvec3 gradient = field.shape->gradient(field.sceneFromObject.inversePoint(place));
        const glm::dvec3 to = place + length * field.sceneFromObject.direction(gradient);
        overlay.arrows.push_back({.from = scene.workspaceFromScene.point(place),
                                  .to = scene.workspaceFromScene.point(to),
                                  .radius = 0.03 * length * scene.workspaceFromScene.scale,
                                  .color = kArrowColor});
        ++figures.arrows;
    });
}

} // namespace

std::string SliceFigures::label(const FieldSlice& slice) const {
    if (!(spacing > 0.0))
        return "nothing here is felt as a field";
    return std::string("field across ") + "xyz"[slice.axis] + " at " + quantity(place, "m") +
           ", isolines every " + quantity(spacing, "m");
}

SliceFigures drawFieldSlice(const HapticScene& scene, const FieldSlice& slice, float pixelScale,
                            Overlay& overlay) {
    SliceFigures figures;
    if (slice.axis < 0 || slice.axis > 2)
        return figures;
    const std::vector<SlicedField> fields = fieldsOf(scene);
    Bounds all;
    double reach = 0.0; // m
    for (const SlicedField& field : fields) {
        const Bounds own = reachOf(field);
        all.include(own.low);
        all.include(own.high);
        const FieldGrid& grid = field.shape->grid();
        reach = std::max(reach, field.sceneFromObject.scale * std::max(grid.inside(), grid.outside()));
    }
    if (!(reach > 0.0))
        return figures;
    figures.place = glm::mix(all.low[slice.axis], all.high[slice.axis], std::clamp(slice.at, 0.0, 1.0));
    figures.spacing = isolineSpacing(reach / kIsolines);
    for (const SlicedField& field : fields)
        drawField(scene, field, slice.axis, pixelScale, figures, overlay);
    // It lies inside of what is seen.
    overlay.hiddenAlpha = std::max(overlay.hiddenAlpha, 0.85f);
    return figures;
}

void FieldSliceView::draw(const std::shared_ptr<const HapticScene>& scene, const FieldSlice& slice,
                          float pixelScale, Overlay& overlay) {
    if (scene == nullptr || slice.axis < 0) {
        scene_.reset();
        label_.clear();
        return;
    }
    if (scene_ != scene || slice_ != slice || pixelScale_ != pixelScale) {
        scene_ = scene;
        slice_ = slice;
        pixelScale_ = pixelScale;
        drawn_.clear();
        label_ = drawFieldSlice(*scene, slice, pixelScale, drawn_).label(slice);
    }
    overlay.lines.insert(overlay.lines.end(), drawn_.lines.begin(), drawn_.lines.end());
    overlay.arrows.insert(overlay.arrows.end(), drawn_.arrows.begin(), drawn_.arrows.end());
    overlay.hiddenAlpha = std::max(overlay.hiddenAlpha, drawn_.hiddenAlpha);
}

} // namespace touchstone
