#include "workbench/window/window_memory.h"

#include "engine/core/output_file.h"
#include "workbench/figures/quantity.h"
#include "workbench/figures/settings_json.h"
#include "workbench/figures/ui_scale.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <fstream>

namespace touchstone {

namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1;
constexpr int kSmallest = 320, kLargest = 16384; // of a window, screen coordinates

bool flag(const Json& json, const char* name, bool otherwise) {
    const auto found = json.find(name);
    return found != json.end() && found->is_boolean() ? found->get<bool>() : otherwise;
}

/// Of a panel; a value that no drag could leave is the usual one.
float sizeOf(const Json& json, const char* name, float least, float usual) {
    const auto found = json.find(name);
    const double value = found != json.end() && found->is_number() ? found->get<double>() : 0.0;
    return value >= static_cast<double>(least) && value <= kLargest ? static_cast<float>(value) : usual;
}

/// Names of quantities; the usual ones where none is known.
ShownQuantities shownIn(const Json& names) {
    ShownQuantities shown{};
    for (size_t i = 0; i < kChartQuantityCount; ++i)
        shown[i] = std::ranges::find(names, chartQuantities()[i].name) != names.end();
    return std::ranges::find(shown, true) != shown.end() ? shown : kFirstQuantities;
}

/// Ignores names and values that are no longer known.
HapticSettings settingsOf(const Json& json) {
    HapticSettings settings;
    for (const auto& info : settingFields()) {
        const auto found = json.find(std::string(info.name));
        if (found != json.end() && found->is_string())
            (void)setSetting(settings, info.name, found->get<std::string>());
    }
    settings.forceEnabled = true;
    // Of the scene that was open.
    const HapticSettings usual;
    settings.animationSpeed = usual.animationSpeed;
    settings.animationOffset = usual.animationOffset;
    return settings;
}

/// Also of absurd numbers; `warning` says where another one is used.
float uiScaleOf(const Json& json, std::string& warning) {
    const auto found = json.find("ui_scale");
    if (found == json.end())
        return 1.0f;
    const float scale = found->is_number() ? clampedUiScale(found->get<double>()) : 1.0f;
    if (!found->is_number() || found->get<double>() != static_cast<double>(scale))
        warning =
            "its UI scale " + found->dump() + " is none: " + figure(static_cast<double>(scale)) + " is used";
    return scale;
}

WindowMemory memoryOf(const Json& json, std::string& warning) {
    WindowMemory memory;
    const auto version = json.is_object() ? json.find("version") : json.end();
    if (version == json.end() || !version->is_number_integer() || version->get<int64_t>() != kVersion) {
        warning = version == json.end()
                      ? "it has no version: the window begins with the defaults"
                      : "its version is " + version->dump() + ", not " + std::to_string(kVersion) +
                            ": the window begins with the defaults";
        return memory;
    }
    memory.uiScale = uiScaleOf(json, warning);
    if (const auto settings = json.find("settings"); settings != json.end() && settings->is_object())
        memory.settings = settingsOf(*settings);
    if (const auto folds = json.find("folded"); folds != json.end() && folds->is_object())
        memory.folds = {
            .left = flag(*folds, "scene", false),
            .right = flag(*folds, "felt", false),
            .bottom = flag(*folds, "charts", false),
            .leftWidth = sizeOf(json, "scene_width", PanelFolds::kLeftWidth, PanelFolds::kLeftWidth),
            .rightWidth = sizeOf(json, "felt_width", PanelFolds::kRightWidth, PanelFolds::kRightWidth),
            .bottomHeight = sizeOf(json, "charts_height", 1.0f, PanelFolds::kBottomHeight)};
    if (const auto charts = json.find("charts"); charts != json.end() && charts->is_array())
        memory.charts = shownIn(*charts);
    memory.introduced = flag(json, "introduced", false);
    if (const auto sound = json.find("sound"); sound != json.end() && sound->is_object()) {
        memory.sound.on = flag(*sound, "on", false);
        if (const auto volume = sound->find("volume"); volume != sound->end() && volume->is_number())
            memory.sound.volume = std::clamp(volume->get<float>(), 0.0f, 1.0f);
    }
    if (const auto size = json.find("size"); size != json.end() && size->is_array() && size->size() == 2 &&
                                             (*size)[0].is_number_integer() && (*size)[1].is_number_integer())
        memory.size =
            glm::clamp(glm::ivec2((*size)[0].get<int>(), (*size)[1].get<int>()), kSmallest, kLargest);
    if (const auto recent = json.find("recent"); recent != json.end() && recent->is_array())
        for (const Json& file : *recent)
            if (file.is_string() && memory.recent.size() < WindowMemory::kMaxRecent)
                memory.recent.emplace_back(file.get<std::string>());
    return memory;
}

} // namespace

void WindowMemory::opened(const std::filesystem::path& file) {
    std::erase(recent, file);
    recent.insert(recent.begin(), file);
    recent.resize(std::min(recent.size(), kMaxRecent));
}

WindowMemory readMemory(const std::filesystem::path& file, std::string* warning) {
    std::ifstream stream(file);
    if (!stream)
        return {};
    WindowMemory memory;
    std::string found;
    try {
        memory = memoryOf(Json::parse(stream), found);
    } catch (const std::exception&) {
        found = "it cannot be read: the window begins with the defaults";
    }
    if (warning != nullptr && !found.empty())
        *warning = file.string() + ": " + found;
    return memory;
}

bool writeMemory(const std::filesystem::path& file, const WindowMemory& memory) {
    nlohmann::ordered_json recent = nlohmann::ordered_json::array();
    for (const std::filesystem::path& path : memory.recent)
        recent.push_back(path.string());
    nlohmann::ordered_json charts = nlohmann::ordered_json::array();
    for (size_t i = 0; i < kChartQuantityCount; ++i)
        if (memory.charts[i])
            charts.push_back(chartQuantities()[i].name);
    const nlohmann::ordered_json json{
        {"version", kVersion},
        {"settings", settingsJson(memory.settings)},
        {"folded",
         {{"scene", memory.folds.left}, {"felt", memory.folds.right}, {"charts", memory.folds.bottom}}},
        {"charts", std::move(charts)},
        {"scene_width", memory.folds.leftWidth},
        {"felt_width", memory.folds.rightWidth},
        {"charts_height", memory.folds.bottomHeight},
        {"sound", {{"on", memory.sound.on}, {"volume", memory.sound.volume}}},
        {"ui_scale", memory.uiScale},
        {"introduced", memory.introduced},
        {"size", {memory.size.x, memory.size.y}},
        {"recent", std::move(recent)},
    };
    try {
        std::filesystem::create_directories(file.parent_path());
        writeFile(file, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

} // namespace touchstone
