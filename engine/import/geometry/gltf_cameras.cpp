#include "engine/import/geometry/gltf_cameras.h"

#include "engine/scene/animation.h"

#include <glm/gtc/constants.hpp>

#include <cmath>
#include <optional>

namespace touchstone {
namespace {

using nlohmann::json;

/// The lens of a camera, in the units of its node.
struct Lens {
    std::string name;
    bool orthographic = false;
    double fovY = 0.0;                        ///< rad; perspective
    double halfWidth = 0.0, halfHeight = 0.0; ///< orthographic
    double aspect = 0.0;                      ///< perspective; 0: that of the picture
    double nearPlane = 0.0, farPlane = INFINITY;
};

/// A number of `object`, whose types checkSchema has checked.
double required(const ImportContext& context, const json& object, const char* name,
                const std::string& place) {
    const auto found = object.find(name);
    if (found == object.end())
        context.fail(place, std::string("property '") + name + "' is missing");
    return found->get<double>();
}

double positive(const ImportContext& context, double value, const char* name, const std::string& place) {
    if (!(value > 0.0))
        context.fail(place + "." + name, json(value).dump() + " is out of range, it must be above 0");
    return value;
}

void readPerspective(const ImportContext& context, const json& stated, const std::string& place, Lens& lens) {
    lens.fovY = positive(context, required(context, stated, "yfov", place), "yfov", place);
    if (!(lens.fovY < glm::pi<double>()))
        context.fail(place + ".yfov", json(lens.fovY).dump() + " is out of range, it must be below pi");
    if (stated.contains("aspectRatio"))
        lens.aspect = positive(context, stated["aspectRatio"].get<double>(), "aspectRatio", place);
    lens.nearPlane = positive(context, required(context, stated, "znear", place), "znear", place);
    if (stated.contains("zfar"))
        lens.farPlane = stated["zfar"].get<double>();
}

void readOrthographic(ImportContext& context, const json& stated, const std::string& place, Lens& lens) {
    lens.orthographic = true;
    const double x = required(context, stated, "xmag", place), y = required(context, stated, "ymag", place);
    if (x == 0.0 || y == 0.0)
        context.fail(place + (x == 0.0 ? ".xmag" : ".ymag"), "is 0: the picture would have no area");
    if (x < 0.0 || y < 0.0)
        context.warn(place + (x < 0.0 ? ".xmag" : ".ymag"), "is negative; its magnitude is used");
    lens.halfWidth = std::abs(x);
    lens.halfHeight = std::abs(y);
    lens.nearPlane = required(context, stated, "znear", place);
    if (!(lens.nearPlane >= 0.0))
        context.fail(place + ".znear",
                     json(lens.nearPlane).dump() + " is out of range, it must be at least 0");
    lens.farPlane = required(context, stated, "zfar", place);
}

Lens readLens(ImportContext& context, const json& camera, const std::string& at) {
    Lens lens;
    lens.name = camera.value("name", std::string());
    const std::string type = camera["type"];
    if (type != "perspective" && type != "orthographic")
        context.fail(at + ".type", "\"" + type.substr(0, 40) + "\" is neither perspective nor orthographic");
    const std::string place = at + "." + type;
    if (!camera.contains(type))
        context.fail(at, "property '" + type + "' is missing");
    if (camera.contains("perspective") && camera.contains("orthographic"))
        context.warn(at, "has both a perspective and an orthographic lens; its type says " + type);
    if (type == "perspective")
        readPerspective(context, camera[type], place, lens);
    else
        readOrthographic(context, camera[type], place, lens);
    if (!(lens.farPlane > lens.nearPlane))
        context.fail(place + ".zfar",
                     json(lens.farPlane).dump() + " is not beyond znear, " + json(lens.nearPlane).dump());
    return lens;
}

/// Axes of a rotation with the third as it stands and the second as near as it can be; empty where they have
/// no direction.
std::optional<glm::dmat3> orthogonal(const glm::dmat3& m) {
    const double back = glm::length(m[2]), up = glm::length(m[1]);
    if (!(back > 0.0 && up > 0.0 && std::isfinite(back) && std::isfinite(up)))
        return std::nullopt;
    const glm::dvec3 z = m[2] / back, x = glm::cross(m[1] / up, z);
    const double right = glm::length(x);
    if (!(right > 1e-9))
        return std::nullopt;
    return glm::dmat3(x / right, glm::cross(z, x / right), z);
}

std::optional<SceneCamera> placed(const Lens& lens, const glm::dmat4& sceneFromNode) {
    const std::optional<glm::dmat3> axes = orthogonal(glm::dmat3(sceneFromNode));
    const glm::dvec3 scale(glm::length(glm::dvec3(sceneFromNode[0])),
                           glm::length(glm::dvec3(sceneFromNode[1])),
                           glm::length(glm::dvec3(sceneFromNode[2])));
    SceneCamera camera;
    camera.name = lens.name;
    camera.eye = glm::dvec3(sceneFromNode[3]);
    camera.orthographic = lens.orthographic;
    camera.fovY = lens.fovY;
    camera.halfHeight = lens.halfHeight * scale.y;
    camera.aspect = lens.orthographic ? lens.halfWidth * scale.x / camera.halfHeight : lens.aspect;
    camera.nearPlane = lens.nearPlane * scale.z;
    camera.farPlane = lens.farPlane * scale.z;
    if (!axes || !std::isfinite(glm::dot(camera.eye, camera.eye)) || !std::isfinite(camera.aspect) ||
        !std::isfinite(camera.halfHeight) || !(camera.farPlane > camera.nearPlane) ||
        (lens.orthographic && !(camera.aspect > 0.0 && camera.halfHeight > 0.0)))
        return std::nullopt;
    camera.axes = *axes;
    return camera;
}

} // namespace

std::vector<SceneCamera> readCameras(ImportContext& context, const GltfDocument& document,
                                     const NodeForest& forest, const std::vector<Node>& nodes) {
    const auto stated = document.json.find("cameras");
    if (stated == document.json.end())
        return {};
    std::vector<std::optional<Lens>> lenses(stated->size());
    for (size_t i = 0; i < stated->size(); ++i)
        if (!(*stated)[i].empty()) // checkSchema has left nothing of a broken one, and warned
            context.attempt("the camera is left out",
                            [&] { lenses[i] = readLens(context, (*stated)[i], element("cameras", i)); });
    const std::vector<glm::dmat4> sceneFromNode = sceneFromNodes(nodes);
    std::vector<SceneCamera> cameras;
    for (size_t n = 0; n < nodes.size(); ++n) {
        const auto gltfNode = static_cast<size_t>(forest.gltfOfNode[n]);
        const json& node = document.json["nodes"][gltfNode];
        if (!forest.shown[n] || !node.contains("camera"))
            continue;
        const size_t index = node["camera"];
        if (!lenses[index])
            continue;
        std::optional<SceneCamera> camera = placed(*lenses[index], sceneFromNode[n]);
        if (!camera) {
            context.warn(element("nodes", gltfNode),
                         "gives its camera no place or direction; it is left out");
            continue;
        }
        camera->index = static_cast<int>(index);
        camera->nodeName = nodes[n].name;
        cameras.push_back(std::move(*camera));
    }
    return cameras;
}

} // namespace touchstone
