#include "assets/glb_writer.h"
#include "assets/picture.h"
#include "assets/scenes.h"

#include <array>
#include <cmath>
#include <numbers>

namespace touchstone::assets {

namespace {

constexpr const char* kPhysics = "KHR_physics_rigid_bodies";
const glm::dvec3 kFloor{0.15, 0.008, 0.12}; // m: the fitted size, so that the workspace is the scene's scale
constexpr double kFloorTop = -0.03;

std::vector<double> turn(int axis, double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    std::vector<double> q{0.0, 0.0, 0.0, std::cos(half)};
    q[static_cast<size_t>(axis)] = std::sin(half);
    return q;
}

/// A scene with rigid bodies.
class BodyScene {
  public:
    BodyScene(const std::string& name, const std::string& line) : glb_(name), name_(name) {
        glb_.describe(line);
    }

    int paint(const char* name, std::array<double, 3> color, double roughness = 0.5, double metal = 0.0) {
        return glb_.addMaterial({{"name", name},
                                 {"pbrMetallicRoughness",
                                  {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
                                   {"metallicFactor", metal},
                                   {"roughnessFactor", roughness}}}});
    }
    /// Grooves across u, 0.3 mm deep, and friction.
    int grooved(const char* name, std::array<double, 3> color) {
        const int height = glb_.addTexture(
            "grooves",
            png(heightMap([](double u, double) { return 0.5 + 0.5 * std::sin(8.0 * std::numbers::pi * u); },
                          128)));
        return glb_.addMaterial(
            {{"name", name},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
               {"metallicFactor", 0.0},
               {"roughnessFactor", 0.5}}},
             {"extensions",
              {{"TOUCHSTONE_materials_haptic",
                {{"staticFriction", 0.5},
                 {"dynamicFriction", 0.4},
                 {"heightTexture", {{"index", height}, {"scale", 0.0003}, {"midLevel", 0.5}}}}}}}});
    }
    int surface(double friction, double restitution = 0.0) {
        materials_.push_back(
            {{"staticFriction", friction}, {"dynamicFriction", friction}, {"restitution", restitution}});
        return static_cast<int>(materials_.size()) - 1;
    }
    int mesh(const char* name, const Shape& shape, int material) {
        return glb_.addMesh(name, shape, material);
    }
    /// A node of the scene; parent -1: at its root.
    int node(const std::string& name, int mesh, const glm::dvec3& at,
             const std::vector<double>& rotation = {}, int parent = -1) {
        parts_.emplace_back(Json::object());
        return glb_.addChild(parent, name, mesh, at, rotation);
    }
    void collideBox(int node, const glm::dvec3& size, int surface) {
        shapes_.push_back({{"type", "box"}, {"box", {{"size", {size.x, size.y, size.z}}}}});
        collide(node, surface);
    }
    void collideBall(int node, double radius, int surface) {
        shapes_.push_back({{"type", "sphere"}, {"sphere", {{"radius", radius}}}});
        collide(node, surface);
    }
    void move(int node, double mass, const glm::dvec3& velocity = glm::dvec3(0.0),
              const glm::dvec3& spin = glm::dvec3(0.0)) {
        Json motion{{"mass", mass}};
        if (velocity != glm::dvec3(0.0))
            motion["linearVelocity"] = {velocity.x, velocity.y, velocity.z};
        if (spin != glm::dvec3(0.0))
            motion["angularVelocity"] = {spin.x, spin.y, spin.z};
        part(node)["motion"] = std::move(motion);
    }
    /// Free along or about one axis (0 to 5) of the nodes, within limits.
    Json freeAxis(int free, double low, double high) {
        Json limits = Json::array();
        for (int axis = 0; axis < 6; ++axis) {
            const char* kind = axis < 3 ? "linearAxes" : "angularAxes";
            if (axis != free)
                limits.push_back({{kind, {axis % 3}}, {"min", 0.0}, {"max", 0.0}});
            else if (low < high)
                limits.push_back({{kind, {axis % 3}}, {"min", low}, {"max", high}});
        }
        return {{"limits", limits}};
    }
    /// The pose of `of` is read in the frame of `base`, which rests.
    void join(int base, int of, Json joint) {
        joints_.push_back(std::move(joint));
        part(base)["joint"] = {{"connectedNode", of}, {"joint", joints_.size() - 1}};
    }
    /// A floor with a rim of the height, such that nothing rolls off.
    void floor(int surface, double rim) {
        const int slate = paint("slate", {0.40, 0.47, 0.53});
        const int at = node("floor", mesh("floor", box(kFloor), slate), {0.0, kFloorTop - 0.004, 0.0});
        collideBox(at, kFloor, surface);
        if (!(rim > 0.0))
            return;
        const double t = 0.003, y = kFloorTop + 0.5 * rim;
        const glm::dvec3 along{kFloor.x, rim, t}, across{t, rim, kFloor.z - 2.0 * t};
        const int one = mesh("rim", box(along), slate), other = mesh("side", box(across), slate);
        for (const double sign : {-1.0, 1.0}) {
            collideBox(node("rim", one, {0.0, y, sign * 0.5 * (kFloor.z - t)}), along, surface);
            collideBox(node("side", other, {sign * 0.5 * (kFloor.x - t), y, 0.0}), across, surface);
        }
    }
    SceneFile finish() {
        glb_.useExtension(kPhysics);
        glb_.useExtension("KHR_implicit_shapes");
        glb_.extend("KHR_implicit_shapes", {{"shapes", shapes_}});
        Json physics{{"physicsMaterials", materials_}};
        if (!joints_.empty())
            physics["physicsJoints"] = joints_;
        glb_.extend(kPhysics, std::move(physics));
        for (size_t n = 0; n < parts_.size(); ++n)
            if (!parts_[n].empty())
                glb_.extendNode(static_cast<int>(n), kPhysics, parts_[n]);
        return {name_ + ".glb", glb_.finish()};
    }

  private:
    Json& part(int node) { return parts_[static_cast<size_t>(node)]; }
    void collide(int node, int surface) {
        part(node)["collider"] = {{"geometry", {{"shape", shapes_.size() - 1}}},
                                  {"physicsMaterial", surface}};
    }

    GlbWriter glb_;
    std::string name_;
    Json shapes_ = Json::array(), materials_ = Json::array(), joints_ = Json::array();
    std::vector<Json> parts_; // of the nodes' extension
};

SceneFile blocks() {
    BodyScene scene("blocks", "blocks and a ball beside a ramp");
    const int wood = scene.surface(0.5);
    scene.floor(wood, 0.006);
    const int slate = scene.paint("ramp", {0.30, 0.35, 0.42});
    const glm::dvec3 ramp{0.06, 0.006, 0.04};
    scene.collideBox(
        scene.node("ramp", scene.mesh("ramp", box(ramp), slate), {-0.036, -0.018, -0.028}, turn(2, -20.0)),
        ramp, wood);
    const std::array<std::array<double, 3>, 4> colors{
        {{0.70, 0.24, 0.18}, {0.85, 0.60, 0.20}, {0.25, 0.50, 0.30}, {0.22, 0.38, 0.65}}};
    const glm::dvec3 cube{0.018, 0.018, 0.018};
    constexpr double kRest = kFloorTop + 0.009;
    const std::array<glm::dvec3, 4> places{{{0.015, kRest, 0.020},
                                            {0.040, kRest, 0.020},
                                            {0.0275, kRest + 0.018, 0.020},
                                            {-0.030, kRest, 0.030}}};
    for (size_t i = 0; i < places.size(); ++i) {
        const int paint = scene.paint("block", colors[i], 0.7);
        const int block =
            scene.node("block " + std::to_string(i + 1), scene.mesh("block", box(cube), paint), places[i]);
        scene.collideBox(block, cube, wood);
        scene.move(block, 0.05);
    }
    const glm::dvec3 plank{0.05, 0.008, 0.016};
    const int board =
        scene.node("plank", scene.mesh("plank", box(plank), scene.paint("beech", {0.75, 0.62, 0.45})),
                   {0.035, kFloorTop + 0.004, -0.025});
    scene.collideBox(board, plank, wood);
    scene.move(board, 0.06);
    const int ball = scene.node(
        "ball", scene.mesh("ball", sphere(0.009, 24, 48), scene.paint("ball", {0.8, 0.8, 0.85}, 0.2)),
        {0.008, kFloorTop + 0.009, -0.004});
    scene.collideBall(ball, 0.009, wood);
    scene.move(ball, 0.03);
    return scene.finish();
}

SceneFile cradle() {
    BodyScene scene("cradle", "Newton's cradle");
    const int steel = scene.surface(0.0, 1.0);
    const int dark = scene.paint("frame", {0.20, 0.20, 0.22}),
              bright = scene.paint("steel", {0.8, 0.8, 0.82}, 0.15, 1.0);
    scene.node("base", scene.mesh("base", box({0.15, 0.006, 0.06}), dark), {0.0, -0.057, 0.0});
    const int rod = scene.mesh("rod", box({0.12, 0.003, 0.003}), dark);
    const int post = scene.mesh("post", box({0.003, 0.11, 0.003}), dark);
    const int bar = scene.node("bar", rod, {0.0, 0.05, 0.0});
    for (const double x : {-0.06, 0.06})
        scene.node("post", post, {x, -0.003, 0.0});
    constexpr double kRadius = 0.009, kLength = 0.07;
    const int ball = scene.mesh("ball", sphere(kRadius, 24, 48), bright);
    const int wire = scene.mesh("wire", box({0.0006, kLength - kRadius, 0.0006}), dark);
    for (int i = 0; i < 5; ++i) {
        // A tenth of a millimetre apart: the impulse goes from ball to ball.
        const double x = (i - 2) * (2.0 * kRadius + 1e-4);
        const double angle = i == 0 ? -35.0 : 0.0, r = angle * std::numbers::pi / 180.0;
        const glm::dvec3 at{x + kLength * std::sin(r), 0.05 - kLength * std::cos(r), 0.0};
        const int body = scene.node("ball " + std::to_string(i + 1), ball, at, turn(2, angle));
        scene.collideBall(body, kRadius, steel);
        scene.move(body, 0.024);
        scene.node("wire", wire, {0.0, 0.5 * (kLength + kRadius), 0.0}, {}, body);
        const int pivot = scene.node("pivot", -1, {x, 0.0, 0.0}, {}, bar);
        const int end = scene.node("end", -1, {0.0, kLength, 0.0}, {}, body);
        scene.join(pivot, end, scene.freeAxis(5, 0.0, 0.0));
    }
    return scene.finish();
}

SceneFile stack() {
    BodyScene scene("stack", "a stack of ten");
    const int wood = scene.surface(0.6);
    scene.floor(wood, 0.006);
    const glm::dvec3 block{0.02, 0.008, 0.02};
    for (int i = 0; i < 10; ++i) {
        const double tone = 0.35 + 0.05 * i;
        const int paint = scene.paint("block", {tone, 0.45, 0.75 - 0.05 * i}, 0.6);
        const int body = scene.node("block " + std::to_string(i + 1), scene.mesh("block", box(block), paint),
                                    {0.0, kFloorTop + (i + 0.5) * block.y, 0.0});
        scene.collideBox(body, block, wood);
        scene.move(body, 0.03);
    }
    return scene.finish();
}

SceneFile seesaw() {
    BodyScene scene("seesaw", "a seesaw with two weights");
    const int wood = scene.surface(0.7);
    scene.floor(wood, 0.006);
    const glm::dvec3 plank{0.11, 0.005, 0.03}, foot{0.006, 0.018, 0.03};
    const int base =
        scene.node("foot", scene.mesh("foot", box(foot), scene.paint("foot", {0.30, 0.35, 0.42})),
                   {0.0, kFloorTop + 0.009, 0.0});
    const int board =
        scene.node("plank", scene.mesh("plank", box(plank, 4), scene.paint("beech", {0.75, 0.62, 0.45})),
                   {0.0, kFloorTop + 0.0215, 0.0});
    scene.collideBox(board, plank, wood);
    scene.move(board, 0.05);
    const int pivot = scene.node("pivot", -1, {0.0, 0.0125, 0.0}, {}, base);
    scene.join(pivot, board, scene.freeAxis(5, -0.4, 0.4));
    const glm::dvec3 cube{0.016, 0.016, 0.016};
    const std::array<std::array<double, 3>, 2> colors{{{0.70, 0.24, 0.18}, {0.22, 0.38, 0.65}}};
    for (int i = 0; i < 2; ++i) {
        const int body =
            scene.node(i == 0 ? "light" : "heavy",
                       scene.mesh("weight", box(cube), scene.paint("weight", colors[static_cast<size_t>(i)])),
                       {i == 0 ? -0.042 : 0.042, kFloorTop + 0.024 + 0.008, 0.0});
        scene.collideBox(body, cube, wood);
        scene.move(body, i == 0 ? 0.03 : 0.05);
    }
    return scene.finish();
}

/// [000 Fig. 11]: what is pressed, thrown, pushed and turned, and sets what the sample behind it feels like.
SceneFile panel() {
    BodyScene scene("panel",
                    "button: friction; switch: texture; slider: stiffness; knob: texture's strength");
    (void)scene.surface(0.4);
    const int grey = scene.paint("panel", {0.55, 0.57, 0.60});
    const int base =
        scene.node("panel", scene.mesh("panel", box({0.15, 0.01, 0.08}), grey), {0.0, -0.02, 0.0});
    constexpr double kTop = 0.005; // of the panel, in its frame
    scene.node("stand", scene.mesh("stand", box({0.15, 0.012, 0.03}), grey), {0.0, -0.0195, -0.056});
    Shape grooves = plane(0.15, 0.03);
    for (glm::vec2& uv : grooves.uv) // a wave is 3.75 mm long
        uv *= glm::vec2(10.0f, 2.0f);
    scene.node("sample", scene.mesh("sample", grooves, scene.grooved("sample", {0.62, 0.55, 0.42})),
               {0.0, -0.0134, -0.056});
    const auto part = [&](const char* name, const Shape& shape, std::array<double, 3> color, glm::dvec3 at,
                          double mass, Json joint, const std::vector<double>& rotation = {}) {
        const int body = scene.node(name, scene.mesh(name, shape, scene.paint(name, color, 0.4)),
                                    at + glm::dvec3(0.0, -0.02, 0.0));
        scene.move(body, mass);
        const int socket = scene.node(std::string(name) + " socket", -1, at, rotation, base);
        const int plug = scene.node(std::string(name) + " plug", -1, glm::dvec3(0.0), rotation, body);
        scene.join(socket, plug, std::move(joint));
    };
    const auto ours = [](Json joint, Json values) {
        joint["extensions"]["TOUCHSTONE_joint"] = std::move(values);
        return joint;
    };
    // A button: 4 mm of way on a spring that is prestressed by 0.4 N.
    Json button = scene.freeAxis(1, -0.004, 0.0);
    button["drives"] = Json::array({{{"type", "linear"},
                                     {"mode", "force"},
                                     {"axis", 1},
                                     {"positionTarget", 0.002},
                                     {"stiffness", 200.0},
                                     {"damping", 1.0}}});
    button =
        ours(std::move(button), {{"setting", "friction"}, {"values", {"zilles", "off"}}, {"press", true}});
    part("button", prism(32, 0.011, 0.008, true), {0.75, 0.20, 0.16}, {-0.053, kTop + 0.005, 0.0}, 0.01,
         button);
    // A switch: it rests at either end.
    part("switch", box({0.008, 0.02, 0.014}), {0.15, 0.15, 0.17}, {-0.018, kTop + 0.009, 0.0}, 0.01,
         ours(scene.freeAxis(5, -0.4, 0.4), {{"detents", {-0.35, 0.35}},
                                             {"detentForce", 0.012},
                                             {"friction", 0.0005},
                                             {"setting", "texture"},
                                             {"values", {"law", "off"}}}));
    // A slider: 24 mm of way, held by friction.
    part("slider", box({0.010, 0.014, 0.008}), {0.90, 0.75, 0.25}, {0.014, kTop + 0.008, 0.0}, 0.01,
         ours(scene.freeAxis(2, -0.024, 0.024),
              {{"friction", 0.25}, {"setting", "stiffness"}, {"from", 1500.0}, {"to", 200.0}}));
    // A knob: a detent every 30 degrees, from 0 to 1 in tenths.
    Json detents = Json::array(), strengths = Json::array();
    for (int i = -5; i <= 5; ++i) {
        detents.push_back(i * std::numbers::pi / 6.0);
        strengths.push_back(std::to_string(5 - i) == "10" ? "1" : "0." + std::to_string(5 - i));
    }
    part("knob", prism(12, 0.014, 0.014, false), {0.20, 0.35, 0.60}, {0.052, kTop + 0.008, 0.0}, 0.03,
         ours(scene.freeAxis(4, -5.2 * std::numbers::pi / 6.0, 5.2 * std::numbers::pi / 6.0),
              {{"detents", detents},
               {"detentForce", 0.01},
               {"friction", 0.001},
               {"setting", "textureStrength"},
               {"values", strengths}}));
    return scene.finish();
}

/// [001 Fig. 4-1]: a screw that is turned at a bar and goes in by 2 mm a turn. Its axis is x of the joint's
/// frame, which stands upright.
SceneFile screw() {
    BodyScene scene("screw", "a screw that is turned at its bar");
    (void)scene.surface(0.5);
    const int block = scene.node(
        "block", scene.mesh("block", box({0.10, 0.03, 0.10}, 4), scene.paint("beech", {0.75, 0.62, 0.45})),
        {0.0, -0.045, 0.0});
    const int steel = scene.paint("steel", {0.7, 0.7, 0.73}, 0.3, 1.0);
    const int body =
        scene.node("screw", scene.mesh("shaft", prism(24, 0.005, 0.06, true), steel), {0.0, 0.0, 0.0});
    scene.move(body, 0.05);
    scene.node("bar", scene.mesh("bar", box({0.08, 0.008, 0.008}, 3), steel), {0.0, 0.026, 0.0}, {}, body);
    for (const double x : {-0.036, 0.036})
        scene.node("grip",
                   scene.mesh("grip", box({0.008, 0.016, 0.012}), scene.paint("grip", {0.70, 0.24, 0.18})),
                   {x, 0.030, 0.0}, {}, body);
    const std::vector<double> upright = turn(2, 90.0);
    const int socket = scene.node("thread", -1, {0.0, 0.045, 0.0}, upright, block);
    const int plug = scene.node("axis", -1, glm::dvec3(0.0), upright, body);
    Json limits = Json::array();
    limits.push_back({{"linearAxes", {0}}, {"min", -0.02}, {"max", 0.02}});
    limits.push_back({{"linearAxes", {1, 2}}, {"min", 0.0}, {"max", 0.0}});
    limits.push_back({{"angularAxes", {1, 2}}, {"min", 0.0}, {"max", 0.0}});
    Json joint{{"limits", limits}};
    joint["extensions"]["TOUCHSTONE_joint"] = {{"pitch", 0.002}, {"friction", 0.5}};
    scene.join(socket, plug, std::move(joint));
    return scene.finish();
}

} // namespace

std::vector<SceneFile> bodies() {
    return {blocks(), cradle(), stack(), seesaw(), panel(), screw()};
}

} // namespace touchstone::assets
