#pragma once

#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
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

/// Whether a warning says `part` of `place`, which may be one of the further places that it lists.
inline bool warns(const Scene& scene, const std::string& place, const std::string& part) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(), [&](const Warning& warning) {
        const size_t also = std::min(warning.message.rfind(" (also "), warning.message.size());
        return (contains(warning.place, place) || contains(warning.message.substr(also), place)) &&
               contains(warning.message, part);
    });
}

/// The warnings as one text, for messages of tests.
inline std::string warningsOf(const Scene& scene) {
    std::string all;
    for (const Warning& warning : scene.warnings)
        all += warning.place + ": " + warning.message + "\n";
    return all;
}

} // namespace touchstone::test

#define EXPECT_REFUSED(maker, where, why)                                                                    \
    do {                                                                                                     \
        const touchstone::Error refusal = touchstone::test::loadError(maker);                                \
        EXPECT_EQ(refusal.place(), where) << refusal.what();                                                 \
        EXPECT_TRUE(touchstone::test::contains(refusal.problem(), why)) << refusal.what();                   \
    } while (false)

/// The square loads with both of its triangles and a warning.
#define EXPECT_MENDED(maker, where, why)                                                                     \
    do {                                                                                                     \
        const touchstone::ScenePtr mended = touchstone::test::load(maker);                                   \
        EXPECT_EQ(mended->triangleCount(), 2u);                                                              \
        EXPECT_TRUE(touchstone::test::warns(*mended, where, why)) << touchstone::test::warningsOf(*mended);  \
    } while (false)
