#include "study/timing/bench_scene.h"

#include "assets/cut_torus.h"
#include "assets/shapes.h"
#include "haptics/scene/shape_object.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <utility>

namespace touchstone {

namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kRing = 0.060, kTube = 0.025, kBall = 0.050, kSide = 0.1, kDepth = 1e-3; // m

/// Shapes without normals get one per facet, with unshared corners, as in the loader.
Mesh meshOf(assets::Shape shape) {
    Mesh mesh;
    mesh.indices = std::move(shape.indices);
    mesh.positions = std::move(shape.positions);
    mesh.normals = std::move(shape.normals);
    mesh.uv0 = std::move(shape.uv);
    mesh.tangents = std::move(shape.tangents);
    mesh.tangentsFromFile = !mesh.tangents.empty();
    mesh.normalsFromFile = !mesh.normals.empty();
    if (mesh.normalsFromFile)
        return mesh;
    Mesh flat;
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        const size_t first = i - i % 3;
        const glm::vec3 &a = mesh.positions[mesh.indices[first]],
                        &b = mesh.positions[mesh.indices[first + 1]],
                        &c = mesh.positions[mesh.indices[first + 2]];
        flat.positions.push_back(mesh.positions[mesh.indices[i]]);
        flat.normals.push_back(glm::normalize(glm::cross(b - a, c - a)));
        flat.indices.push_back(static_cast<uint32_t>(i));
    }
    return flat;
}

void place(Scene& scene, int mesh, const glm::dvec3& at) {
    Instance instance;
    instance.node = static_cast<int>(scene.nodes.size());
    instance.mesh = mesh;
    instance.sceneFromMesh[3] = glm::dvec4(at, 1.0);
    scene.nodes.emplace_back();
    scene.instances.push_back(instance);
}

Scene plainScene() {
    Scene scene;
    scene.path = "bench";
    scene.materials.emplace_back();
    return scene;
}

/// 256 x 256 pixels of 8 bits, `channels` each; `at` gives 0..1 for a pixel's centre.
int addImage(Scene& scene, int channels, const std::function<glm::dvec3(double u, double v)>& at) {
    constexpr int kSide256 = 256;
    Image image;
    image.decoded = true;
    image.pixels.width = image.pixels.height = kSide256;
    image.pixels.channels = channels;
    for (int y = 0; y < kSide256; ++y)
        for (int x = 0; x < kSide256; ++x) {
            const glm::dvec3 value = at((x + 0.5) / kSide256, (y + 0.5) / kSide256);
            for (int c = 0; c < channels; ++c)
                image.pixels.bytes.push_back(static_cast<std::byte>(std::lround(255.0 * value[c])));
        }
    scene.images.push_back(std::move(image));
    return static_cast<int>(scene.images.size()) - 1;
}

/// One material with every effect.
Scene richScene() {
    constexpr double kTurn = 6.283185307179586;
    Scene scene = plainScene();
    const int wave = addImage(scene, 1, [](double u, double v) {
        return glm::dvec3(0.5 + 0.25 * (std::sin(kTurn * u) + std::sin(kTurn * v)));
    });
    const int lean = addImage(scene, 3, [](double u, double v) {
        return 0.5 +
               0.5 * glm::normalize(glm::dvec3(0.1 * std::cos(kTurn * u), 0.1 * std::cos(kTurn * v), 1.0));
    });
    Material& material = scene.materials[0];
    material.normalTexture.image = lean;
    HapticMaterial& haptic = material.haptic;
    const auto stated = [](auto value) {
        return HapticMaterial::Field<decltype(value)>{value, HapticSource::Touchstone};
    };
    haptic.stiffness = stated(600.0f);
    haptic.damping = stated(1.0f);
    haptic.staticFriction = stated(0.4f);
    haptic.dynamicFriction = stated(0.3f);
    haptic.viscousFriction = stated(1.0f);
    HeightMap height;
    height.texture.image = wave;
    height.scale = 2e-4f;
    haptic.height = stated(height);
    FactorMap factor;
    factor.texture.image = wave;
    factor.min = 0.5f;
    factor.max = 1.0f;
    haptic.friction = haptic.stiffnessMap = haptic.dampingMap = stated(factor);
    return scene;
}

/// Adds one mesh at each of the positions.
Scene sceneOf(assets::Shape shape, const std::vector<glm::dvec3>& places, Scene scene = plainScene()) {
    scene.meshes.push_back(meshOf(std::move(shape)));
    for (const glm::dvec3& at : places)
        place(scene, 0, at);
    return scene;
}

/// The render scene is freed: for ten million triangles the haptic scene suffices.
std::shared_ptr<const HapticScene> compile(assets::Shape shape, const std::vector<glm::dvec3>& places,
                                           Scene scene = plainScene()) {
    return compileHapticScene(sceneOf(std::move(shape), places, std::move(scene)), Similarity{});
}

/// A channel of evenly spaced keys.
template <class Key>
AnimationChannel channelOf(size_t node, AnimatedPath path, double duration, int keys, const Key& key) {
    AnimationChannel channel;
    channel.node = static_cast<int>(node);
    channel.path = path;
    for (int i = 0; i <= keys; ++i) {
        const double share = static_cast<double>(i) / keys;
        channel.times.push_back(static_cast<float>(duration * share));
        channel.values.push_back(glm::vec4(key(share)));
    }
    return channel;
}

BenchScene animate(std::string name, Scene scene, Animation animation, BenchStroke stroke) {
    scene.animations.push_back(std::move(animation));
    auto haptic = compileHapticScene(scene, Similarity{});
    return {std::move(name), std::move(haptic), std::move(stroke),
            std::make_shared<const Scene>(std::move(scene))};
}

/// A spiral along the ring and around the tube, `reach` from the tube's centre line.
BenchStroke alongTorus(double reach) {
    return [reach](double metres, double lift) {
        const double r = reach + lift;
        const double a = metres / (kRing + reach), v = 0.37 * a;
        const double out = kRing + r * std::cos(v);
        return glm::dvec3(out * std::cos(a), out * std::sin(a), r * std::sin(v));
    };
}

/// Around the ball, slowly up and down between the 34th degrees of latitude.
BenchStroke aroundBall(double reach) {
    return [reach](double metres, double lift) {
        const double a = metres / reach, tilt = 0.6 * std::sin(0.37 * a);
        return (reach + lift) *
               glm::dvec3(std::cos(a) * std::cos(tilt), std::sin(tilt), std::sin(a) * std::cos(tilt));
    };
}

/// A circle on the box's upper face; it crosses the face's diagonal.
BenchStroke onBox() {
    return [](double metres, double lift) {
        constexpr double kCircle = 0.03;
        const double a = metres / kCircle;
        return glm::dvec3(kCircle * std::cos(a), 0.5 * kSide - kDepth + lift, kCircle * std::sin(a));
    };
}

/// Edges of a mesh by its indices.
size_t linesOf(const assets::Shape& shape) {
    std::set<std::pair<uint32_t, uint32_t>> lines;
    for (size_t i = 0; i < shape.indices.size(); ++i)
        lines.insert(std::minmax(shape.indices[i], shape.indices[i % 3 == 2 ? i - 2 : i + 1]));
    return lines.size();
}

BenchScene ringOfTableOne() {
    // Twenty facets around the ring and eleven around the tube: 1 mm below the middle of the outermost facet
    // is 3.1 mm below its corners.
    const double middle = kTube * std::cos(kPi / 11.0) - (kRing + kTube) * (1.0 - std::cos(kPi / 20.0));
    const assets::Shape shape = assets::tableOneRing();
    return {"object 2",
            compile(shape, {glm::dvec3(0.0)}),
            alongTorus(middle - kDepth),
            nullptr,
            shape.positions.size(),
            linesOf(shape)};
}

} // namespace

size_t BenchScene::triangles() const {
    size_t count = 0;
    for (const auto& object : haptic->objects)
        count += object->triangleCount();
    return count;
}

size_t BenchScene::vertices() const {
    if (madeVertices > 0)
        return madeVertices;
    size_t count = 0;
    for (const auto& object : haptic->objects)
        count += object->shape != nullptr ? 0 : object->vertices.size() - 1;
    return count;
}

size_t BenchScene::lines() const {
    if (madeLines > 0)
        return madeLines;
    size_t count = 0;
    if (const auto* neighbourhoods = haptic->neighbourhoods())
        for (const MeshAdjacency& adjacency : *neighbourhoods)
            count += adjacency.edges();
    return count;
}

BenchScene tableOneScene(int number) {
    const std::vector<glm::dvec3> centre{glm::dvec3(0.0)};
    if (number == 1)
        return {"object 1", compile(assets::boxWithSharedCorners(glm::dvec3(kSide)), centre), onBox(),
                nullptr};
    if (number == 2)
        return ringOfTableOne();
    if (number == 3)
        return {"object 3", compile(assets::sphere(kBall, 30, 30), centre), aroundBall(kBall - kDepth),
                nullptr};
    return {"object 4", compile(assets::sphere(kBall, 180, 180), centre), aroundBall(kBall - kDepth),
            nullptr};
}

BenchScene torusScene(size_t triangles) {
    const auto side =
        static_cast<uint32_t>(std::max(3L, std::lround(std::sqrt(0.5 * static_cast<double>(triangles)))));
    return {"torus", compile(assets::torus(kRing, kTube, side, side), {glm::dvec3(0.0)}),
            alongTorus(kTube - kDepth), nullptr};
}

BenchScene shapeScene(std::string name, assets::Shape shape, BenchStroke stroke) {
    return {std::move(name), compile(std::move(shape), {glm::dvec3(0.0)}), std::move(stroke), nullptr};
}

BenchScene fieldScene(std::string name, std::shared_ptr<const Shape> shape,
                      const Similarity& workspaceFromObject, BenchStroke stroke) {
    const std::shared_ptr<HapticScene> haptic = copyOf(*compileHapticScene(plainScene(), Similarity{}));
    addShape(*haptic, name, std::move(shape), 0, workspaceFromObject);
    return {std::move(name), haptic, std::move(stroke), nullptr};
}

BenchScene reliefScene(std::string name, assets::Shape shape, BenchStroke stroke, int side, double scale,
                       const BenchHeight& height) {
    Image image;
    image.decoded = true;
    image.pixels = {side, side, 1, ComponentType::F32, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto bytes = std::bit_cast<std::array<std::byte, 4>>(
                static_cast<float>(height((x + 0.5) / side, (y + 0.5) / side)));
            image.pixels.bytes.insert(image.pixels.bytes.end(), bytes.begin(), bytes.end());
        }
    Scene scene = plainScene();
    scene.images.push_back(std::move(image));
    HeightMap map;
    map.texture.image = 0;
    map.scale = static_cast<float>(scale);
    scene.materials[0].haptic.height = HapticMaterial::Field<HeightMap>{map, HapticSource::Touchstone};
    return {std::move(name), compile(std::move(shape), {glm::dvec3(0.0)}, std::move(scene)),
            std::move(stroke), nullptr};
}

BenchScene torusWithAllEffects(size_t triangles) {
    const auto side =
        static_cast<uint32_t>(std::max(3L, std::lround(std::sqrt(0.5 * static_cast<double>(triangles)))));
    return {"torus with all effects",
            compile(assets::torus(kRing, kTube, side, side, {24, 10}), {glm::dvec3(0.0)}, richScene()),
            alongTorus(kTube - kDepth), nullptr};
}

namespace {

std::vector<glm::dvec3> gridPlaces(size_t count) {
    constexpr double kPitch = 2.0 * kBall + 2e-4;
    const auto side = static_cast<size_t>(std::ceil(std::cbrt(static_cast<double>(count)) - 1e-9));
    const size_t middle = side / 2;
    std::vector<glm::dvec3> places;
    for (size_t i = 0; places.size() < count; ++i) {
        const glm::dvec3 cell(i % side, i / side % side, i / side / side);
        places.push_back(kPitch * (cell - glm::dvec3(static_cast<double>(middle))));
    }
    return places;
}

} // namespace

BenchScene sphereGridScene(size_t count) {
    return {count == 1 ? "1 object" : std::to_string(count) + " objects",
            compile(assets::sphere(kBall, 30, 30), gridPlaces(count)), aroundBall(kBall - kDepth), nullptr};
}

BenchScene movingGridScene(size_t count) {
    constexpr double kLoop = 2.0, kCircle = 50e-6; // s, m
    const std::vector<glm::dvec3> places = gridPlaces(count);
    Animation animation{"turning", kLoop, {}};
    for (size_t i = 0; i < places.size(); ++i) {
        const double phase = 0.7 * static_cast<double>(i);
        const glm::dvec3 axis = glm::normalize(glm::dvec3(std::cos(phase), std::sin(phase), 0.5));
        animation.channels.push_back(channelOf(i, AnimatedPath::Rotation, kLoop, 4, [&](double share) {
            const double half = kPi * share;
            return glm::dvec4(std::sin(half) * axis, std::cos(half));
        }));
        animation.channels.push_back(channelOf(i, AnimatedPath::Translation, kLoop, 16, [&](double share) {
            const double turn = 2.0 * kPi * share + phase;
            return glm::dvec4(places[i] + kCircle * glm::dvec3(std::cos(turn), 0.0, std::sin(turn)), 0.0);
        }));
    }
    return animate(std::to_string(count) + " moving objects", sceneOf(assets::sphere(kBall, 30, 30), places),
                   std::move(animation), aroundBall(kBall - kDepth));
}

BenchScene jawsScene(Jaws jaws, size_t triangles) {
    const bool boxes = jaws == Jaws::Boxes;
    const auto side = [&](double perSquare) {
        return static_cast<uint32_t>(
            std::max(3L, std::lround(std::sqrt(static_cast<double>(triangles) / perSquare))));
    };
    assets::Shape shape =
        boxes ? assets::box(glm::dvec3(kSide), side(12.0)) : assets::sphere(kBall, side(2.0), side(2.0));
    constexpr double kLoop = 1.0, kApart = 6e-3, kOverlap = 4e-3; // s, m; both shapes are 0.1 m wide
    Animation animation{"jaws", kLoop, {}};
    std::vector<glm::dvec3> places;
    for (const double sign : {-1.0, 1.0}) {
        places.emplace_back(sign * 0.5 * (kSide + kApart), 0.0, 0.0);
        animation.channels.push_back(
            channelOf(places.size() - 1, AnimatedPath::Translation, kLoop, 2, [&](double share) {
                const double gap = share == 0.5 ? -kOverlap : kApart;
                return glm::dvec4(sign * 0.5 * (kSide + gap), 0.0, 0.0, 0.0);
            }));
    }
    const BenchStroke between = [](double metres, double) {
        constexpr double kCircle = 2e-3; // m
        return glm::dvec3(0.3e-3, kCircle * std::cos(metres / kCircle), kCircle * std::sin(metres / kCircle));
    };
    return animate(boxes ? "two boxes" : "two balls", sceneOf(std::move(shape), places), std::move(animation),
                   between);
}

} // namespace touchstone
