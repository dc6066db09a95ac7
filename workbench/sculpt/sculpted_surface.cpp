#include "workbench/sculpt/sculpted_surface.h"

#include "engine/math/similarity.h"
#include "haptics/shape/field/cut_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

/// One mesh of all blocks.
std::shared_ptr<const ReshapedMesh> packed(const FieldBlocks& blocks, const glm::dmat4& meshFromObject,
                                           double voxel) {
    auto mesh = std::make_shared<ReshapedMesh>();
    const glm::dmat3 linear(meshFromObject), normals = glm::transpose(glm::inverse(linear));
    const auto placeOf = [&](const glm::vec3& p) {
        return glm::dvec3(meshFromObject * glm::dvec4(glm::dvec3(p), 1.0));
    };
    Bounds bounds;
    size_t vertices = 0, corners = 0;
    for (const auto& [number, block] : blocks.blocks()) {
        for (const glm::vec3& position : block.positions)
            bounds.include(placeOf(position));
        vertices += block.positions.size();
        corners += block.corners.size();
    }
    if (bounds.empty())
        return mesh;
    mesh->centre = bounds.centre();
    mesh->halfSize = 0.5 * bounds.extent();
    mesh->radius = glm::length(mesh->halfSize);
    mesh->meanEdge = voxel * std::cbrt(std::abs(glm::determinant(linear)));
    mesh->vertices.reserve(vertices);
    mesh->indices.reserve(corners);
    for (const auto& [number, block] : blocks.blocks()) {
        const auto first = static_cast<uint32_t>(mesh->vertices.size());
        for (size_t i = 0; i < block.positions.size(); ++i) {
            SceneVertex vertex{};
            vertex.position = glm::vec3(placeOf(block.positions[i]) - mesh->centre);
            vertex.normal = glm::vec3(glm::normalize(normals * glm::dvec3(block.normals[i])));
            vertex.tangent = {1.0f, 0.0f, 0.0f, 1.0f};
            vertex.color = {65535, 65535, 65535, 65535};
            if (!block.colors.empty()) {
                mesh->hasColors = true;
                for (int k = 0; k < 3; ++k)
                    vertex.color[static_cast<size_t>(k)] = static_cast<uint16_t>(
                        std::lround(65535.0f * std::clamp(block.colors[i][k], 0.0f, 1.0f)));
            }
            mesh->vertices.push_back(vertex);
        }
        for (const uint32_t corner : block.corners)
            mesh->indices.push_back(first + corner);
    }
    return mesh;
}

} // namespace

std::vector<int> texturedFields(const HapticScene& felt, const Scene& drawn) {
    std::vector<int> found;
    for (size_t k = 0; k < felt.objects.size(); ++k) {
        const HapticObject& object = *felt.objects[k];
        if (wholeField(object.shape.get()) == nullptr || object.instance < 0 || drawn.volume != nullptr)
            continue;
        const Instance& instance = drawn.instances[static_cast<size_t>(object.instance)];
        const Mesh& mesh = drawn.meshes[static_cast<size_t>(instance.mesh)];
        if (!drawn.materials[static_cast<size_t>(mesh.material)].haptic.fieldTexture.empty())
            found.push_back(static_cast<int>(k));
    }
    return found;
}

void drawTexturedFields(const HapticScene& felt, const Scene& drawn, SceneRenderer& renderer) {
    for (const int k : texturedFields(felt, drawn)) {
        const HapticObject& object = *felt.objects[static_cast<size_t>(k)];
        const FieldShape& shape = *wholeField(object.shape.get());
        FieldBlocks blocks;
        (void)blocks.update(shape.sharedGrid(), {}, nullptr);
        renderer.reshape(drawn.instances[static_cast<size_t>(object.instance)].mesh,
                         *packed(blocks, glm::inverse(object.objectFromMesh), shape.voxel()));
    }
}

SculptedSurface::~SculptedSurface() {
    {
        const std::scoped_lock lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (worker_.joinable())
        worker_.join();
}

void SculptedSurface::forget() {
    const std::scoped_lock lock(mutex_);
    ++model_;
    jobs_.clear();
    made_.clear();
    fresh_.clear();
    prepared_.clear();
}

void SculptedSurface::prepare(const HapticScene& scene, int object, const Scene* drawn) {
    if (prepared_.insert(object).second)
        add(scene, object, drawn, {}, false);
}

void SculptedSurface::changed(const HapticScene& scene, int object, const Scene* drawn,
                              std::span<const uint32_t> bricks) {
    prepared_.insert(object);
    add(scene, object, drawn, bricks, true);
}

void SculptedSurface::add(const HapticScene& scene, int object, const Scene* drawn,
                          std::span<const uint32_t> bricks, bool shown) {
    const HapticObject& own = *scene.objects[static_cast<size_t>(object)];
    const FieldShape* const shape = wholeField(own.shape.get());
    if (shape == nullptr || drawn == nullptr || own.instance < 0)
        return;
    {
        const std::scoped_lock lock(mutex_);
        Job& job = jobs_[drawn->instances[static_cast<size_t>(own.instance)].mesh];
        job.grid = shape->sharedGrid();
        job.colors = shape->colors();
        job.bricks.insert(job.bricks.end(), bricks.begin(), bricks.end());
        job.meshFromObject = glm::inverse(own.objectFromMesh);
        job.shown = job.shown || shown;
        if (!worker_.joinable())
            worker_ = std::thread([this] { work(); });
    }
    wake_.notify_all();
}

void SculptedSurface::work() {
    std::map<int, FieldBlocks> blocks; // by Scene::meshes, of this model
    uint64_t model = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
        if (stopping_)
            return;
        if (std::exchange(model, model_) != model_)
            blocks.clear();
        const auto first = jobs_.begin();
        const int mesh = first->first;
        const Job job = std::move(first->second);
        jobs_.erase(first);
        lock.unlock();
        FieldBlocks& own = blocks[mesh];
        (void)own.update(job.grid, job.bricks, job.colors.get());
        const std::shared_ptr<const ReshapedMesh> made =
            job.shown ? packed(own, job.meshFromObject, job.grid->layout().voxel) : nullptr;
        lock.lock();
        if (made != nullptr && model == model_) {
            made_[mesh] = made;
            fresh_.insert(mesh);
        }
    }
}

void SculptedSurface::draw(SceneRenderer& renderer) {
    std::vector<std::pair<int, std::shared_ptr<const ReshapedMesh>>> meshes;
    {
        const std::scoped_lock lock(mutex_);
        if (std::exchange(rendered_, renderer.sceneNumber()) != renderer.sceneNumber())
            for (const auto& [mesh, made] : made_)
                fresh_.insert(mesh);
        for (const int mesh : std::exchange(fresh_, {}))
            meshes.emplace_back(mesh, made_.at(mesh));
    }
    for (const auto& [mesh, made] : meshes)
        renderer.reshape(mesh, *made);
}

} // namespace touchstone
