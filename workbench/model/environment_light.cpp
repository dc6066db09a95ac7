#include "workbench/model/environment_light.h"

#include "engine/core/error.h"

#include <chrono>
#include <utility>

namespace touchstone {

void EnvironmentLight::start(const std::filesystem::path& file) {
    if (!file.empty())
        loading_ = std::async(std::launch::async, [this, file] { return loadEnvironment(file, &cancel_); });
}

std::optional<std::string> EnvironmentLight::update(SceneRenderer& renderer) {
    try {
        if (loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
            light_ = loading_.get();
        if (light_ && !std::exchange(given_, true))
            renderer.setEnvironment(light_);
    } catch (const DeviceLost&) {
        given_ = false;
        throw;
    } catch (const Error& error) {
        return error.what();
    } catch (const std::bad_alloc&) {
        return "there is not enough memory for the environment";
    }
    return std::nullopt;
}

void lightWith(const std::filesystem::path& file, SceneRenderer& renderer) {
    if (file.empty())
        return;
    renderer.setEnvironment(loadEnvironment(file));
}

} // namespace touchstone
