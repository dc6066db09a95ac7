// ts_scene_*, ts_setting*, ts_touch, ts_hand_* and ts_stroke.

#include "api/c/calls.h"
#include "api/c/changed_materials.h"
#include "api/c/named_settings.h"
#include "api/c/offline_hand.h"
#include "api/c/scene_arrays.h"
#include "devices/stroke/stroke_library.h"
#include "engine/load/scene_loader.h"
#include "engine/scene/haptic_numbers.h"
#include "haptics/world/driven_objects.h"

#include <cmath>
#include <span>

namespace touchstone::api {

namespace {

constexpr const char* kScene = "scene";

LoadOptions loadOptions(const ts_scene_options& options) {
    LoadOptions loading;
    loading.images.visual = false;
    if (options.iso_given != 0) {
        if (!std::isfinite(options.iso))
            refuseArgument("options.iso", "is not finite");
        loading.iso = options.iso;
    }
    return loading;
}

Fit fitOf(const ts_scene_options& options) {
    if (options.fit != TS_FIT_NONE && options.fit != TS_FIT_WORKSPACE)
        refuseArgument("options.fit", std::to_string(options.fit) + " is no ts_fit");
    return options.fit == TS_FIT_NONE ? Fit::None : Fit::Workspace;
}

/// A scene that `load` reads with the options.
template <class Load>
ts_status makeScene(const ts_scene_options* given_, ts_scene* out, const Load& load) {
    return call([&] {
        (void)given(out, kScene);
        const ts_scene_options options = structOf(given_, "options");
        const Fit fit = fitOf(options);
        give(std::make_shared<TouchedScene>(load(loadOptions(options)), fit), out);
    });
}

std::vector<uint8_t> bytesOf(const void* bytes, size_t count) {
    if (count > 0 && bytes == nullptr)
        refuseArgument("bytes", "is null");
    const auto* begin = static_cast<const uint8_t*>(bytes);
    return {begin, begin + count};
}

/// Writes the corners of at most `capacity` triangles; returns how many there are.
size_t trianglesOf(const TouchedScene& scene, float* corners, size_t capacity) {
    size_t count = 0;
    for (const Instance& instance : scene.source()->instances) {
        const Mesh& mesh = scene.source()->meshes[static_cast<size_t>(instance.mesh)];
        for (size_t corner = 0; corner < mesh.indices.size(); ++corner) {
            const size_t triangle = count + corner / 3;
            if (triangle >= capacity)
                break;
            const glm::dvec4 place =
                instance.sceneFromMesh * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[corner]]), 1.0);
            const glm::dvec3 there = scene.haptic()->workspaceFromScene.point(glm::dvec3(place));
            for (int axis = 0; axis < 3; ++axis)
                corners[9 * triangle + 3 * (corner % 3) + static_cast<size_t>(axis)] =
                    static_cast<float>(there[axis]);
        }
        count += mesh.triangleCount();
    }
    return count;
}

ts_object_info objectInfo(const TouchedScene& scene, uint64_t object) {
    const HapticScene& haptic = *scene.haptic();
    requireBelow(object, haptic.objects.size(), "object");
    const auto index = static_cast<size_t>(object);
    ts_object_info info{};
    const glm::dvec3& centre = haptic.restMotions[index].workspaceFromObject.translation;
    for (int axis = 0; axis < 3; ++axis)
        info.centre[axis] = centre[axis];
    info.movable = drivenProblem(*scene.source(), haptic, index).empty() ? 1 : 0;
    const int instance = haptic.objects[index]->instance;
    for (int i = 0; i <= instance; ++i) {
        const Instance& placed = scene.source()->instances[static_cast<size_t>(i)];
        info.first_triangle += info.triangles;
        info.triangles = scene.source()->meshes[static_cast<size_t>(placed.mesh)].triangleCount();
    }
    return info;
}

/// Those that change no geometry.
const std::vector<const HapticNumber*>& materialNumbers() {
    static const std::vector<const HapticNumber*> all = [] {
        std::vector<const HapticNumber*> numbers;
        for (const HapticNumber& number : hapticNumbers())
            if (number.settled != nullptr)
                numbers.push_back(&number);
        return numbers;
    }();
    return all;
}

ts_number_info infoOf(const HapticNumber& number) {
    ts_number_info info{};
    info.name = number.name.data(); // literals
    info.label = number.label.data();
    info.unit = number.unit.data();
    info.meaning = number.meaning.data();
    info.least = number.least;
    info.most = number.most;
    info.low = number.low;
    info.high = number.high;
    info.logarithmic = number.logarithmic ? 1 : 0;
    return info;
}

std::shared_ptr<OfflineHand> newHands(ts_scene scene, ts_settings settings, size_t hands = 1) {
    return std::make_shared<OfflineHand>(take<TouchedScene>(scene, kScene), settingsOf(settings), hands);
}

[[noreturn]] void cancelled(size_t done, size_t count) {
    throw Refused(TS_CANCELLED, "path.progress: stopped after " + std::to_string(done) + " of " +
                                    std::to_string(count) + " ticks");
}

void touchPaths(OfflineHand& hands, std::span<const ts_path> paths, std::span<const TickArrays> ticks,
                size_t* done) {
    const size_t made = hands.touch(paths, ticks);
    if (done != nullptr)
        *done = made;
    if (made < paths.front().count)
        cancelled(made, paths.front().count);
}

void touchPath(OfflineHand& hand, const ts_path* path, const ts_ticks* ticks, size_t* done) {
    (void)given(path, "path");
    const ts_path whole = structOf(path, "path");
    const TickArrays arrays(ticks, whole.count);
    touchPaths(hand, {&whole, 1}, {&arrays, 1}, done);
}

/// Paths and (where not null) ticks of several hands.
void touchPaths(OfflineHand& hands, const ts_path* paths, const ts_ticks* ticks, size_t count, size_t* done) {
    const std::vector<ts_path> whole = structsOf(paths, checkedHands(count), "paths");
    std::vector<TickArrays> arrays;
    if (ticks != nullptr)
        for (const ts_ticks& of : structsOf(ticks, count, "ticks"))
            arrays.emplace_back(&of, whole[arrays.size()].count);
    touchPaths(hands, whole, arrays, done);
}

void layPath(TouchedScene& scene, const StrokeRequest& request, double rate, double* positions,
             size_t capacity, size_t& rows) {
    if (!(rate >= 1.0 && rate <= 1e6))
        refuseArgument("rate", "is not within 1 .. 1e6 Hz");
    if (const std::string problem = strokeProblem(request.name); !problem.empty())
        refuseArgument("name", problem);
    if (positions == nullptr && capacity > 0)
        refuseArgument("positions", "is null, and its capacity is not 0");
    const std::shared_ptr<const StrokePath> stroke = scene.stroke(request);
    rows = static_cast<size_t>(std::floor(stroke->period() * rate * (1.0 + 1e-12))) + 1;
    for (size_t i = 0; i < std::min(rows, capacity); ++i) {
        const double time = static_cast<double>(i) / rate;
        const glm::dvec3 place = stroke->positionIn(time, time);
        for (int axis = 0; axis < 3; ++axis)
            positions[3 * i + static_cast<size_t>(axis)] = place[axis];
    }
}

} // namespace
} // namespace touchstone::api

using namespace touchstone;
using namespace touchstone::api;

extern "C" {

void ts_material_init(ts_material* material) {
    if (material != nullptr)
        *material = {sizeof(ts_material), nullptr, NAN, NAN, NAN, NAN, NAN};
}

ts_status ts_scene_load(const char* file, const ts_scene_options* options, ts_scene* scene) {
    return makeScene(options, scene,
                     [&](const LoadOptions& loading) { return loadScene(textOf(file, "file"), loading); });
}

ts_status ts_scene_load_memory(const void* bytes, size_t count, const char* folder,
                               const ts_scene_options* options, ts_scene* scene) {
    return makeScene(options, scene, [&](const LoadOptions& loading) {
        return loadSceneFromMemory(bytesOf(bytes, count), folder != nullptr ? folder : "", loading);
    });
}

ts_status ts_scene_create(const ts_mesh* meshes, size_t mesh_count, const ts_material* materials,
                          size_t material_count, const ts_scene_options* options, ts_scene* scene) {
    return makeScene(options, scene, [&](const LoadOptions& loading) {
        return loadSceneFromMemory(api::glbOf(arraysOf(meshes, mesh_count, materials, material_count)), "",
                                   loading);
    });
}

ts_status ts_scene_get_info(ts_scene scene, ts_scene_info* info) {
    return call([&] {
        const std::shared_ptr<TouchedScene> touched = take<TouchedScene>(scene, kScene);
        ts_scene_info known{};
        known.objects = touched->haptic()->objects.size();
        known.triangles = touched->source()->triangleCount();
        known.materials = touched->source()->materials.size();
        const Bounds bounds = touched->bounds();
        for (int axis = 0; axis < 3; ++axis) {
            known.low[axis] = bounds.low[axis];
            known.high[axis] = bounds.high[axis];
        }
        known.moves = touched->moves() ? 1 : 0;
        known.warnings = touched->warnings().size();
        giveStruct(known, info, "info");
    });
}

ts_status ts_scene_warning(ts_scene scene, uint64_t index, char* text, size_t capacity, size_t* needed) {
    return call([&] {
        const std::shared_ptr<TouchedScene> touched = take<TouchedScene>(scene, kScene);
        if (index >= touched->warnings().size())
            refuseArgument("index", std::to_string(index) + ", and there are " +
                                        std::to_string(touched->warnings().size()) + " warnings");
        giveText(touched->warnings()[index], text, capacity, needed);
    });
}

size_t ts_material_number_count(void) {
    return materialNumbers().size();
}

ts_status ts_material_number_get_info(size_t index, ts_number_info* info) {
    return call([&] {
        if (index >= materialNumbers().size())
            refuseArgument("index", "is not below ts_material_number_count");
        giveStruct(infoOf(*materialNumbers()[index]), info, "info");
    });
}

ts_status ts_scene_material_name(ts_scene scene, uint64_t material, char* text, size_t capacity,
                                 size_t* needed) {
    return call([&] {
        const std::shared_ptr<TouchedScene> touched = take<TouchedScene>(scene, kScene);
        const std::vector<Material>& all = touched->source()->materials;
        if (material >= all.size())
            refuseArgument("material", "is not below the scene's materials");
        giveText(all[static_cast<size_t>(material)].name, text, capacity, needed);
    });
}

ts_status ts_scene_material_number(ts_scene scene, uint64_t material, const char* name, double* value) {
    return call([&] {
        (void)given(value, "value");
        *value = feltNumber(take<TouchedScene>(scene, kScene)->source()->materials, material,
                            textOf(name, "name"));
    });
}

ts_status ts_scene_object(ts_scene scene, uint64_t object, ts_object_info* info) {
    return call([&] { giveStruct(objectInfo(*take<TouchedScene>(scene, kScene), object), info, "info"); });
}

ts_status ts_scene_triangles(ts_scene scene, float* corners, size_t capacity, size_t* triangles) {
    return call([&] {
        const std::shared_ptr<TouchedScene> touched = take<TouchedScene>(scene, kScene);
        (void)given(triangles, "triangles");
        if (corners == nullptr && capacity > 0)
            refuseArgument("corners", "is null, and its capacity is not 0");
        *triangles = trianglesOf(*touched, corners, capacity);
    });
}

ts_status ts_scene_close(ts_scene scene) {
    return call([&] { close<TouchedScene>(scene, kScene); });
}

ts_status ts_touch(ts_scene scene, ts_settings settings, const ts_path* path, const ts_ticks* ticks) {
    return call([&] { touchPath(*newHands(scene, settings), path, ticks, nullptr); });
}

ts_status ts_hand_create(ts_scene scene, ts_settings settings, ts_hand* hand) {
    return call([&] {
        (void)given(hand, "hand");
        give(newHands(scene, settings), hand);
    });
}

ts_status ts_hands_create(ts_scene scene, ts_settings settings, size_t count, ts_hand* hands) {
    return call([&] {
        (void)given(hands, "hands");
        give(newHands(scene, settings, count), hands);
    });
}

ts_status ts_hand_set(ts_hand hand, const char* name, const char* value) {
    return call([&] { take<OfflineHand>(hand, "hand")->set(textOf(name, "name"), textOf(value, "value")); });
}

ts_status ts_hand_touch(ts_hand hand, const ts_path* path, const ts_ticks* ticks, size_t* done) {
    return call([&] { touchPath(*take<OfflineHand>(hand, "hand"), path, ticks, done); });
}

ts_status ts_hands_touch(ts_hand hands, const ts_path* paths, const ts_ticks* ticks, size_t count,
                         size_t* done) {
    return call([&] { touchPaths(*take<OfflineHand>(hands, "hands"), paths, ticks, count, done); });
}

ts_status ts_hand_close(ts_hand hand) {
    return call([&] { close<OfflineHand>(hand, "hand"); });
}

ts_status ts_stroke(ts_scene scene, const char* name, double speed, double depth, double rate,
                    double* positions, size_t capacity, size_t* rows) {
    return call([&] {
        const std::shared_ptr<TouchedScene> touched = take<TouchedScene>(scene, kScene);
        size_t all = 0;
        StrokeRequest request;
        request.name = textOf(name, "name");
        request.speed = speed;
        request.depth = depth;
        layPath(*touched, request, rate, positions, capacity, all);
        given(rows, "rows") = all;
    });
}

} // extern "C"
