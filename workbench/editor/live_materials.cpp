#include "workbench/editor/live_materials.h"

#include "engine/core/error.h"
#include "haptics/recording/scene_identity.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace touchstone {

namespace {

bool sameMaps(const HapticStatement& a, const HapticStatement& b) {
    const auto same = [](const auto& one, const auto& other) {
        return one.has_value() == other.has_value() && (!one || one->texture == other->texture);
    };
    return same(a.height, b.height) && same(a.friction, b.friction) && same(a.stiffnessMap, b.stiffnessMap) &&
           same(a.dampingMap, b.dampingMap);
}

/// True if the material needs an image for haptics that has not been decoded.
bool lacksImage(const Material& material, const std::vector<Image>& images) {
    const auto lacks = [&](const TextureRef& texture) {
        if (!texture)
            return false;
        const Image& image = images[static_cast<size_t>(texture.image)];
        return !image.decoded && image.problem.empty();
    };
    const HapticMaterial& haptic = material.haptic;
    return (haptic.normalTextureInfluence.value.value_or(1.0f) > 0.0f && material.normalScale != 0.0f &&
            lacks(material.normalTexture)) ||
           (haptic.height.value && haptic.height.value->scale != 0.0f &&
            lacks(haptic.height.value->texture)) ||
           ((!haptic.staticFriction.value || !haptic.dynamicFriction.value) &&
            lacks(material.metallicRoughnessTexture));
}

bool mustRead(const Scene& scene, const std::vector<Material>& before, const std::vector<Material>& after) {
    const std::vector<MaterialPlacement> placements = materialPlacements(scene);
    for (size_t m = 0; m < after.size(); ++m)
        if (!sameMaps(before[m].says.ours, after[m].says.ours) ||
            (placements[m].placed && lacksImage(after[m], scene.images)))
            return true;
    return false;
}

/// Touch goes on where the surfaces stay what they were.
bool sameSurfaces(const std::vector<Material>& before, const std::vector<Material>& after) {
    const auto surface = [](const Material& m) {
        return std::tuple(m.haptic.sides, m.haptic.implicit, m.haptic.voxelSize, m.haptic.fieldError,
                          m.haptic.fieldTexture);
    };
    return std::ranges::equal(before, after, {}, surface, surface);
}

/// Loads the file's scene with the changes applied, as it will be once saved.
void readAnew(const MaterialJob& job, MadeMaterials& made) {
    LoadOptions options;
    options.edits = job.edits;
    options.volume = job.model.scene->volume;
    if (options.volume != nullptr)
        options.iso = job.model.scene->iso;
    if (job.model.scene->animation >= 0)
        options.animation = std::to_string(job.model.scene->animation);
    const ScenePtr scene = loadScene(job.path, options);
    if (scene->file != job.stamp)
        throw Error(scene->path, "", "has changed since it was opened", "open it again");
    const auto compiled = compileHapticScene(*scene, job.model.workspaceFromScene);
    made.haptic = copyOf(*compiled);
    made.haptic->warnings = compiled->warnings;
    made.materials = scene->materials;
    made.scene = scene;
    made.read = true;
    made.touchGoesOn = false;
}

} // namespace

MadeMaterials makeMaterials(const MaterialJob& job) {
    const auto begin = std::chrono::steady_clock::now();
    const Scene& scene = *job.model.scene;
    const std::vector<Material>& before = job.compiledFrom.empty() ? scene.materials : job.compiledFrom;
    MadeMaterials made;
    made.edits = job.edits;
    made.revision = job.revision;
    made.materials = editedMaterials(scene, job.statements);
    if (mustRead(scene, before, made.materials)) {
        readAnew(job, made);
    } else {
        made.haptic = withMaterials(*job.model.haptic, scene, before, made.materials);
        made.touchGoesOn = sameSurfaces(before, made.materials);
        if (job.forTheEye) {
            auto seen = std::make_shared<Scene>(scene);
            seen->materials = made.materials;
            made.scene = std::move(seen);
        }
    }
    made.feltHash = feltHash(*made.haptic, made.scene != nullptr ? *made.scene : scene);
    made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return made;
}

LiveMaterials::~LiveMaterials() {
    discard();
}

void LiveMaterials::start(MaterialJob job) {
    finished_.store(false, std::memory_order_relaxed);
    worker_ = std::thread([this, job = std::move(job)] {
        try {
            result_ = makeMaterials(job);
        } catch (...) {
            failure_ = std::current_exception();
        }
        finished_.store(true, std::memory_order_release);
    });
}

std::optional<MadeMaterials> LiveMaterials::take() {
    if (!worker_.joinable() || !finished_.load(std::memory_order_acquire))
        return std::nullopt;
    worker_.join();
    if (failure_)
        std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(result_, std::nullopt);
}

void LiveMaterials::discard() {
    if (worker_.joinable())
        worker_.join();
    result_.reset();
    failure_ = nullptr;
}

} // namespace touchstone
