#pragma once

#include "engine/core/error.h"
#include "engine/scene/scene_loader.h"
#include "tests/support/gltf_maker.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace touchstone::test {

inline ScenePtr load(const GltfMaker& maker, const LoadOptions& options = {}) {
    return loadSceneFromMemory(maker.glb(), ".", options);
}

/// The Error of a load that must fail; an empty one if it does not.
template <class Load>
Error errorOf(Load&& loading) {
    try {
        (void)loading();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "the load was expected to fail";
    return Error("", "", "", "");
}

inline Error loadError(const GltfMaker& maker) {
    return errorOf([&] { return load(maker); });
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline bool warns(const Scene& scene, const std::string& place, const std::string& part) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(), [&](const Warning& warning) {
        return contains(warning.place, place) && contains(warning.message, part);
    });
}

} // namespace touchstone::test

#define EXPECT_REFUSED(maker, where, why)                                                                    \
    do {                                                                                                     \
        const touchstone::Error refusal = touchstone::test::loadError(maker);                                \
        EXPECT_EQ(refusal.place(), where) << refusal.what();                                                 \
        EXPECT_TRUE(touchstone::test::contains(refusal.problem(), why)) << refusal.what();                   \
    } while (false)
