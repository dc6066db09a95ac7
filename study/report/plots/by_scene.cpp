#include "study/report/plots/figures.h"

#include <algorithm>
#include <set>

namespace touchstone::study {

std::vector<SceneRungs> byScene(const StudyResult& result, bool tessellations) {
    std::vector<SceneRungs> scenes;
    for (const ConfigurationResult& configuration : result.configurations) {
        auto at = std::find_if(scenes.begin(), scenes.end(), [&](const SceneRungs& s) {
            return s.scene == configuration.scene && s.path == configuration.path;
        });
        if (at == scenes.end())
            at = scenes.insert(scenes.end(), {configuration.scene, configuration.path, {}, ""});
        at->configurations.push_back(&configuration);
    }
    if (!tessellations)
        std::erase_if(scenes, [](const SceneRungs& s) {
            return std::all_of(
                s.configurations.begin(), s.configurations.end(),
                [](const ConfigurationResult* r) { return r->ablation == kTessellationAblation; });
        });
    std::set<std::string> taken;
    for (SceneRungs& scene : scenes) {
        const std::string name = slug(scene.scene + " " + scene.path);
        scene.file = name;
        for (int i = 2; !taken.insert(scene.file).second; ++i)
            scene.file = name + "_" + std::to_string(i);
    }
    return scenes;
}

} // namespace touchstone::study
