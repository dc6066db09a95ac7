#include "study/report/plots/figures.h"

#include <algorithm>
#include <set>

namespace touchstone::study {

std::vector<SceneRungs> byScene(const StudyResult& result, bool tessellations) {
    std::vector<SceneRungs> scenes;
    for (const RungResult& rung : result.rungs) {
        auto at = std::find_if(scenes.begin(), scenes.end(), [&](const SceneRungs& s) {
            return s.scene == rung.scene && s.path == rung.path;
        });
        if (at == scenes.end())
            at = scenes.insert(scenes.end(), {rung.scene, rung.path, {}, ""});
        at->rungs.push_back(&rung);
    }
    if (!tessellations)
        std::erase_if(scenes, [](const SceneRungs& s) {
            return std::all_of(s.rungs.begin(), s.rungs.end(),
                               [](const RungResult* r) { return r->ladder == kTessellationLadder; });
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
