#include "server/tables.h"

namespace touchstone::server {

namespace {

Json materialNumbers() {
    Json numbers = Json::array();
    for (size_t i = 0; i < ts_material_number_count(); ++i) {
        ts_number_info info = TS_STRUCT(ts_number_info);
        ts::check(ts_material_number_get_info(i, &info));
        numbers.push_back({{"name", info.name},
                           {"label", info.label},
                           {"unit", info.unit},
                           {"meaning", info.meaning},
                           {"least", info.least},
                           {"most", info.most},
                           {"low", info.low},
                           {"high", info.high},
                           {"logarithmic", info.logarithmic != 0}});
    }
    return numbers;
}

Json numberNow(ts_session session, uint64_t material, const std::string& name) {
    double value = 0.0;
    ts::check(ts_session_material_number(session, material, name.c_str(), &value));
    return numberOrNull(value);
}

} // namespace

Json settingsTable(const Json& changed) {
    Json all = Json::array();
    for (size_t i = 0; i < ts_setting_count(); ++i) {
        ts_setting_info info = TS_STRUCT(ts_setting_info);
        ts::check(ts_setting_get_info(i, &info));
        all.push_back({{"name", info.name},
                       {"unit", info.unit},
                       {"meaning", info.meaning},
                       {"allowed", info.allowed},
                       {"initial", info.initial},
                       {"value", changed.value(info.name, info.initial)}});
    }
    return {{"settings", all}};
}

Json materialsTable(ts_session session, const ts::Scene* scene) {
    const Json numbers = materialNumbers();
    Json all = Json::array();
    for (uint64_t m = 0, count = scene != nullptr ? scene->info().materials : 0; m < count; ++m) {
        Json values = Json::object();
        for (const Json& number : numbers) {
            const auto name = number["name"].get<std::string>();
            values[name] = numberNow(session, m, name);
        }
        all.push_back({{"name", ts::text([&](char* text, size_t room, size_t* needed) {
                            return ts_scene_material_name(scene->get(), m, text, room, needed);
                        })},
                       {"values", values}});
    }
    return {{"numbers", numbers}, {"materials", all}};
}

Json numberOfMaterials(ts_session session, const ts::Scene& scene, const std::string& name) {
    Json all = Json::array();
    for (uint64_t m = 0, count = scene.info().materials; m < count; ++m)
        all.push_back(numberNow(session, m, name));
    return all;
}

Json objectsTable(const ts::Scene* scene) {
    Json all = Json::array();
    for (uint64_t i = 0, count = scene != nullptr ? scene->info().objects : 0; i < count; ++i) {
        ts_object_info info = TS_STRUCT(ts_object_info);
        ts::check(ts_scene_object(scene->get(), i, &info));
        all.push_back({{"centre", vectorOf(info.centre)},
                       {"first_triangle", info.first_triangle},
                       {"triangles", info.triangles},
                       {"movable", info.movable != 0}});
    }
    return {{"objects", all}};
}

} // namespace touchstone::server
