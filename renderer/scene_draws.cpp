// Selects and orders the instances to draw.

#include "renderer/scene_renderer_impl.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

/// Rows of the affine map and of its cofactor matrix, which transforms normals even if the map is singular.
bool setConstants(const glm::dmat3& linear, const glm::dvec3& t, DrawItem& item) {
    // Columns of the cofactor matrix; det = dot of a column with its cofactor.
    glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                        glm::cross(linear[0], linear[1]));
    const double determinant = glm::dot(linear[0], cofactor[0]);
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(cofactor[column][row]));
    if (!std::isfinite(largest) || !std::isfinite(glm::dot(t, t)))
        return false;
    item.mirrored = determinant < 0.0;
    const double scale = largest > 0.0 ? (item.mirrored ? -1.0 : 1.0) / largest : 0.0;
    for (int row = 0; row < 3; ++row) {
        const auto at = static_cast<size_t>(row);
        item.constants.eyeFromMesh[at] =
            glm::vec4(glm::dvec4(linear[0][row], linear[1][row], linear[2][row], t[row]));
        item.constants.normalFromMesh[at] = glm::vec4(
            glm::dvec4(cofactor[0][row] * scale, cofactor[1][row] * scale, cofactor[2][row] * scale, 0.0));
    }
    item.constants.normalFromMesh[0].w = item.mirrored ? -1.0f : 1.0f;
    return true;
}

/// An upper bound of the largest singular value, and equal to it where axes stay orthogonal: the root of the
/// largest row sum of linear' linear, whose eigenvalues are the squared singular values.
double largestStretch(const glm::dmat3& linear) {
    double largest = 0.0;
    for (int row = 0; row < 3; ++row) {
        double sum = 0.0;
        for (int column = 0; column < 3; ++column)
            sum += std::abs(glm::dot(linear[row], linear[column]));
        largest = std::max(largest, sum);
    }
    return std::sqrt(largest);
}

/// Of the mesh's box, along the line of sight to its centre.
double halfDepth(const glm::dmat3& linear, const glm::dvec3& halfSize, const glm::dvec3& sight) {
    const double distance = glm::length(sight);
    if (!(distance > 0.0))
        return 0.0;
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        sum += std::abs(glm::dot(sight, linear[axis])) / distance * halfSize[axis];
    return sum;
}

/// The plane in the eye frame of an instance that the plane has cut in its static pose and that moved to
/// `pose` since; nullopt where the pose has no inverse: nothing is drawn of it.
std::optional<glm::vec4> clipInEye(const ClipPlane& plane, const glm::dmat4& atRest, const glm::dmat4& pose,
                                   const Similarity& workspaceFromScene, const glm::dvec3& eye) {
    glm::dvec4 inScene(plane.normal, -plane.offset);
    if (pose != atRest) {
        if (glm::determinant(glm::dmat3(pose)) == 0.0)
            return std::nullopt;
        inScene = glm::transpose(glm::inverse(pose)) * planeInMesh(plane, atRest);
    }
    // dot(n, p) + d with p = (q + eye - t) / s turned back, q in the eye frame.
    const glm::dvec3 normal = workspaceFromScene.direction(glm::dvec3(inScene)) / workspaceFromScene.scale;
    return glm::vec4(glm::dvec4(normal, inScene.w + glm::dot(normal, eye - workspaceFromScene.translation)));
}

/// Each side is sorted by its own depth, so that the contents of a glass are drawn between its far and its
/// near side.
void addBlended(DrawItem item, double distance, double halfDepth, std::vector<DrawItem>& draws) {
    if (item.bothSides) {
        item.sides = DrawItem::Sides::Far;
        item.distance = distance + halfDepth;
        draws.push_back(item);
    }
    item.sides = DrawItem::Sides::Near;
    item.distance = distance - halfDepth;
    draws.push_back(item);
}

} // namespace

void SceneRenderer::Impl::collectDraws(const View& view, const glm::dvec3& eye, vk::Extent2D extent,
                                       Part part, std::vector<DrawItem>& draws) const {
    draws.clear();
    if (!scene_)
        return;
    const Frustum seen(clipFromEye(view));
    const Scene& scene = scene_->scene();
    const uint32_t light = (view.lights[1].irradiance != glm::vec3(0.0f) ? shared::kHasSecondLight : 0u) |
                           (view.probe.radius > 0.0 ? shared::kHasProbeShadow : 0u) |
                           (environment_.source ? shared::kHasEnvironment : 0u);
    const glm::dvec3 back = glm::transpose(glm::dmat3(view.viewFromWorkspace))[2];
    const double pixelsAtUnitDepth = 0.5 * extent.height * std::abs(view.clipFromView[1][1]);
    const std::vector<bool> hidden = hiddenInstances(scene, view.part);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        if (hidden[i])
            continue;
        const GpuScene::DrawnMesh& drawn = scene_->mesh(scene.instances[i].mesh);
        const PreparedMesh& mesh = drawn.mesh;
        const bool strokes = mesh.strokes > 0;
        if (mesh.empty() || (strokes && view.mode != ViewMode::Shaded)) // lines and points have no haptics
            continue;
        const bool blended = view.mode == ViewMode::Shaded && (drawn.features & shared::kIsBlended) != 0;
        if (part != Part::All && (part == Part::Live) != (blended || moving_.moves(i)))
            continue;
        const glm::dmat3 linear = view.workspaceFromScene.scale *
                                  (glm::mat3_cast(view.workspaceFromScene.rotation) * glm::dmat3(poses[i]));
        const glm::dvec3 origin =
            view.workspaceFromScene.point(glm::dvec3(poses[i] * glm::dvec4(mesh.centre, 1.0))) - eye;
        DrawItem item;
        item.instance = static_cast<int>(i);
        item.features = drawn.features | light;
        const Material& material = scene.materials[static_cast<size_t>(
            scene.meshes[static_cast<size_t>(scene.instances[i].mesh)].material)];
        item.bothSides = material.doubleSided && !strokes;
        if (!setConstants(linear, origin, item))
            continue;
        if (view.part.clip) {
            const std::optional<glm::vec4> clip = clipInEye(*view.part.clip, scene.instances[i].sceneFromMesh,
                                                            poses[i], view.workspaceFromScene, eye);
            if (!clip)
                continue;
            item.constants.clip = *clip;
            item.features |= shared::kIsClipped;
            // A cut shows the insides, which are felt unless the material is felt from outside only, or the
            // face that is in their place.
            const bool field = !strokes && isFilled(scene, scene.instances[i]);
            const bool shell = std::ranges::binary_search(view.shells, static_cast<int>(i)) &&
                               !scene_->isReshaped(scene.instances[i].mesh);
            item.constants.normalFromMesh[2].w = field && !shell ? 1.0f : 0.0f;
            item.bothSides =
                !strokes && (field || material.doubleSided || material.haptic.sides != SideChoice::Front);
        }
        item.constants.normalFromMesh[1].w =
            static_cast<float>(std::cbrt(std::abs(glm::determinant(glm::dmat3(poses[i])))));
        const double stretch = largestStretch(linear);
        if (!strokes) {
            item.centre = origin;
            item.radius = stretch * mesh.radius;
            if (seen.misses(item.centre, item.radius))
                continue;
        }
        // All lines of sight of an orthographic view are parallel.
        const glm::dvec3 sight = view.orthographic() ? glm::dot(origin, back) * back : origin;
        // The mesh's minimum distance from the eye: there an error of one metre is this many pixels.
        const double nearest = view.orthographic() ? 1.0 : glm::length(origin) - stretch * mesh.radius;
        const double allowed = view.allowedError > 0.0 && nearest > 0.0 && stretch > 0.0
                                   ? view.allowedError * nearest / (pixelsAtUnitDepth * stretch)
                                   : 0.0;
        const DrawLevel& level = levelWithin(mesh, allowed);
        item.edge = level.meanEdge * stretch * pixelsAtUnitDepth /
                    (view.orthographic() ? 1.0 : std::max(glm::length(origin), 1e-300));
        item.firstIndex = strokes ? 0 : level.firstIndex;
        item.indexCount = strokes ? mesh.strokes : level.indexCount;
        if (blended)
            addBlended(item, glm::length(sight), halfDepth(linear, mesh.halfSize, sight), draws);
        else {
            item.distance = glm::length(sight);
            draws.push_back(item);
        }
    }
    // Opaque items with few state changes; blended ones last, from the farthest.
    std::stable_sort(draws.begin(), draws.end(), [](const DrawItem& a, const DrawItem& b) {
        const bool blendedA = (a.features & shared::kIsBlended) != 0,
                   blendedB = (b.features & shared::kIsBlended) != 0;
        if (blendedA != blendedB)
            return blendedB;
        if (blendedA)
            return a.distance > b.distance;
        if (a.features != b.features)
            return a.features < b.features;
        return a.distance < b.distance; // the nearest hide what is behind them before it is shaded
    });
}

void SceneRenderer::Impl::drawItem(const vk::raii::CommandBuffer& commands, const DrawItem& item,
                                   ViewMode mode, bool keepsLight) {
    const Scene& scene = scene_->scene();
    const int meshIndex = scene.instances[static_cast<size_t>(item.instance)].mesh;
    const int materialIndex = scene.meshes[static_cast<size_t>(meshIndex)].material;
    const PreparedMesh& mesh = scene_->mesh(meshIndex).mesh;
    const bool shaded = mode == ViewMode::Shaded;
    const std::shared_ptr<const SurfaceProgram>& program = scene_->programs().of(materialIndex);
    const vk::Pipeline programmed =
        shaded && program ? pipelines_.programmed(item.features, keepsLight, program) : vk::Pipeline{};
    const vk::PipelineLayout layout = programmed ? pipelines_.programLayout()
                                      : shaded   ? pipelines_.sceneLayout()
                                                 : pipelines_.falseColorLayout();
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, programmed ? programmed
                                                            : shaded
                                                                ? pipelines_.scene(item.features, keepsLight)
                                                                : pipelines_.falseColor(item.features, mode));
    commands.bindDescriptorSets(
        vk::PipelineBindPoint::eGraphics, layout, 1,
        shaded ? scene_->material(materialIndex) : scene_->falseColorMaterial(materialIndex), {});
    if (programmed)
        commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 2,
                                    scene_->programs().set(materialIndex),
                                    scene_->programs().offset(item.instance));
    commands.setFrontFace(item.mirrored ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise);
    commands.pushConstants<shared::ObjectConstants>(layout, kObjectStages, 0, item.constants);
    ++statistics.drawCalls;
    using Cull = vk::CullModeFlagBits;
    if (mesh.strokes > 0) {
        commands.setCullMode(Cull::eNone);
        commands.bindVertexBuffers(0, scene_->vertices(),
                                   vk::DeviceSize{mesh.strokeVertex * sizeof(SceneVertex)});
        commands.draw(4, item.indexCount, 0, item.firstIndex);
        commands.bindVertexBuffers(0, scene_->vertices(), vk::DeviceSize{0});
        return;
    }
    const bool all = item.sides == DrawItem::Sides::All && item.bothSides;
    commands.setCullMode(all ? Cull::eNone : item.sides == DrawItem::Sides::Far ? Cull::eFront : Cull::eBack);
    const bool reshaped = scene_->bindReshaped(commands, meshIndex, mode);
    commands.drawIndexed(item.indexCount, 1, item.firstIndex, mesh.firstVertex, 0);
    if (reshaped)
        bindMeshes(commands, mode);
    statistics.drawnTriangles += item.indexCount / 3;
}

void SceneRenderer::Impl::bindMeshes(const vk::raii::CommandBuffer& commands, ViewMode mode) const {
    commands.bindIndexBuffer(scene_->indices(), 0, vk::IndexType::eUint32);
    commands.bindVertexBuffers(0, scene_->vertices(), vk::DeviceSize{0});
    if (mode != ViewMode::Shaded)
        commands.bindVertexBuffers(1, scene_->scalars(), vk::DeviceSize{0});
}

void SceneRenderer::Impl::bindScene(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet,
                                    ViewMode mode) {
    if (!scene_)
        return;
    bindMeshes(commands, mode);
    commands.bindDescriptorSets(
        vk::PipelineBindPoint::eGraphics,
        mode == ViewMode::Shaded ? pipelines_.sceneLayout() : pipelines_.falseColorLayout(), 0, frameSet, {});
}

void SceneRenderer::Impl::drawScene(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet,
                                    ViewMode mode, bool over) {
    bool backgroundDrawn = over;
    if (!draws_.empty())
        bindScene(commands, frameSet, mode);
    for (const DrawItem& item : draws_) {
        // After everything opaque, but before transmissive items.
        if (mode == ViewMode::Shaded && (item.features & shared::kIsBlended) != 0 && !backgroundDrawn) {
            drawBackground(commands, frameSet);
            bindScene(commands, frameSet, mode);
            backgroundDrawn = true;
        }
        drawItem(commands, item, mode);
    }
    if (!backgroundDrawn)
        drawBackground(commands, frameSet);
}

void SceneRenderer::Impl::drawBackground(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet,
                                         bool keepsLight) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.background(keepsLight));
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_.overlayLayout(), 0, frameSet,
                                {});
    commands.setCullMode(vk::CullModeFlagBits::eNone);
    commands.setFrontFace(vk::FrontFace::eCounterClockwise);
    commands.draw(3, 1, 0, 0);
}

} // namespace touchstone
