// The per-frame uniforms.

#include "renderer/scene_renderer_impl.h"

#include <cstring>

namespace touchstone {

namespace {

glm::vec4 unitOrZero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? glm::vec4(glm::vec3(v / length), 0.0f) : glm::vec4(0.0f);
}

void setSurroundings(const Surroundings& from, float exposure, shared::FrameUniforms& to) {
    const auto exposed = [exposure](const glm::vec3& radiance) {
        return glm::vec4(exposure * radiance, 0.0f);
    };
    const std::array<glm::dvec3, 9> irradiance = irradiancePolynomial(from);
    for (size_t i = 0; i < 4; ++i)
        to.irradiance[i] = exposed(glm::vec3(irradiance[i]));
    const auto grey = [&](size_t i) {
        return exposure * static_cast<float>((irradiance[i].x + irradiance[i].y + irradiance[i].z) / 3.0);
    };
    to.irradianceSquares = {grey(4), grey(5), grey(6), grey(7)};
    to.irradiance[0].w = grey(8);
    to.horizon = exposed(from.horizon);
    to.skyRise = exposed(from.zenith - from.horizon);
    to.rim = exposed(from.rim);
    to.floorFall = exposed(from.below - from.rim);
    for (size_t i = 0; i < from.lamps.size(); ++i) {
        const Lamp& lamp = from.lamps[i];
        to.lampAxis[i] = unitOrZero(lamp.towards);
        to.lampAxis[i].w = static_cast<float>(lamp.sharpness);
        to.lampRadiance[i] = exposed(lamp.radiance);
    }
}

/// Replaces the closed form's light; its key light stays, so that the probe has a shadow.
void setEnvironmentLight(const Environment& from, float exposure, shared::FrameUniforms& to) {
    const auto exposed = [exposure](const glm::dvec3& light) {
        return glm::vec4(exposure * glm::vec3(light), 0.0f);
    };
    for (size_t i = 0; i < 4; ++i)
        to.irradiance[i] = exposed(from.irradiance[i]);
    for (size_t i = 0; i < 5; ++i)
        to.irradianceColor[i] = exposed(from.irradiance[4 + i]);
    to.environment = {exposure, static_cast<float>(Environment::kLevels - 1), 0.0f, 0.0f};
}

} // namespace

glm::dvec3 eyeOf(const View& view) {
    const glm::dmat3 axes(view.viewFromWorkspace);
    return -(glm::inverse(axes) * glm::dvec3(view.viewFromWorkspace[3]));
}

glm::dmat4 clipFromEye(const View& view) {
    return view.clipFromView * glm::dmat4(glm::dmat3(view.viewFromWorkspace));
}

void SceneRenderer::Impl::writeUniforms(FrameSlot& slot, const View& view, const glm::dvec3& eye,
                                        const Overlay& overlay, vk::Extent2D extent) {
    shared::FrameUniforms uniforms{};
    uniforms.clipFromEye = glm::mat4(clipFromEye(view));
    uniforms.eyeFromClip = glm::mat4(glm::inverse(clipFromEye(view)));
    uniforms.toLight0 = unitOrZero(view.lights[0].toLight);
    uniforms.toLight1 = unitOrZero(view.lights[1].toLight);
    const float exposure = view.exposure;
    uniforms.irradiance0 = glm::vec4(exposure * view.lights[0].irradiance, 0.0f);
    uniforms.irradiance1 = glm::vec4(exposure * view.lights[1].irradiance, 0.0f);
    setSurroundings(view.surroundings, exposure, uniforms);
    if (environment_.source)
        setEnvironmentLight(*environment_.source, exposure, uniforms);
    uniforms.probe = glm::vec4(
        glm::dvec4(view.probe.centre - eye, view.probe.radius > 0.0 ? 1.0 / view.probe.radius : 0.0));
    uniforms.backgroundTop = glm::vec4(view.background.top, 1.0f);
    uniforms.backgroundBottom = glm::vec4(view.background.bottom, 1.0f);
    uniforms.image = {static_cast<float>(extent.width), static_cast<float>(extent.height),
                      overlay.hiddenAlpha, static_cast<float>(view.workspaceFromScene.scale)};
    const auto towardsViewer = unitOrZero(
        glm::dvec3(view.viewFromWorkspace[0].z, view.viewFromWorkspace[1].z, view.viewFromWorkspace[2].z));
    uniforms.toEye = view.orthographic() ? towardsViewer : glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    uniforms.toViewer = towardsViewer;
    uniforms.toViewer.w = view.pixelScale;
    std::memcpy(slot.uniforms.mapped, &uniforms, sizeof uniforms);
}

} // namespace touchstone
