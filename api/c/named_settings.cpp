#include "api/c/named_settings.h"

#include "api/c/calls.h"

#include <vector>

namespace touchstone::api {

void NamedSettings::set(std::string_view name, std::string_view value) {
    const std::lock_guard lock(mutex_);
    if (const std::string problem = setSetting(settings_, name, value); !problem.empty())
        refuseArgument("value", problem);
}

HapticSettings NamedSettings::get() const {
    const std::lock_guard lock(mutex_);
    return settings_;
}

HapticSettings settingsOf(ts_settings settings) {
    return settings != nullptr ? take<NamedSettings>(settings, "settings")->get() : HapticSettings{};
}

namespace {

/// The texts of ts_setting_info, which live as long as the library.
struct SettingTexts {
    std::string name, unit, meaning, allowed, initial;
};

const std::vector<SettingTexts>& settingTexts() {
    static const auto* kTexts = [] {
        auto* texts = new std::vector<SettingTexts>;
        for (const StructField<HapticSettings>& field : settingFields())
            texts->push_back({std::string(field.name), std::string(field.unit), std::string(field.meaning),
                              allowedValues(field), writtenValue(field, field.get(HapticSettings{}))});
        return texts;
    }();
    return *kTexts;
}

} // namespace
} // namespace touchstone::api

using namespace touchstone;
using namespace touchstone::api;

extern "C" {

size_t ts_setting_count(void) {
    return settingFields().size();
}

ts_status ts_setting_get_info(size_t index, ts_setting_info* info) {
    return call([&] {
        if (index >= settingTexts().size())
            refuseArgument("index", std::to_string(index) + ", and there are " +
                                        std::to_string(settingTexts().size()) + " settings");
        const SettingTexts& texts = settingTexts()[index];
        giveStruct(ts_setting_info{0, texts.name.c_str(), texts.unit.c_str(), texts.meaning.c_str(),
                                   texts.allowed.c_str(), texts.initial.c_str()},
                   info, "info");
    });
}

ts_status ts_settings_create(ts_settings* settings) {
    return call([&] {
        (void)given(settings, "settings");
        give(std::make_shared<NamedSettings>(), settings);
    });
}

ts_status ts_settings_set(ts_settings settings, const char* name, const char* value) {
    return call([&] {
        take<NamedSettings>(settings, "settings")->set(textOf(name, "name"), textOf(value, "value"));
    });
}

ts_status ts_settings_get(ts_settings settings, const char* name, char* text, size_t capacity,
                          size_t* needed) {
    return call([&] {
        const HapticSettings all = take<NamedSettings>(settings, "settings")->get();
        const std::string key = textOf(name, "name");
        const StructField<HapticSettings>* field = findField(settingFields(), key);
        if (field == nullptr)
            refuseArgument("name",
                           "there is no setting '" + key + "'; known: " + fieldNames(settingFields()));
        giveText(writtenValue(*field, field->get(all)), text, capacity, needed);
    });
}

ts_status ts_settings_close(ts_settings settings) {
    return call([&] { close<NamedSettings>(settings, "settings"); });
}

} // extern "C"
