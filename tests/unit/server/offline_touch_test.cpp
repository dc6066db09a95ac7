// Paths that are touched beside the servo, without the network.

#include "server/offline_touch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace touchstone::server {
namespace {

/// A client loads another scene right after it has asked for a path: the path is of the scene before.
TEST(OfflineTouch, TheSceneStaysOpenUntilThePathIsMade) {
    auto scene = std::make_shared<ts::Scene>(std::string(TOUCHSTONE_ASSETS) + "/box.glb", TS_FIT_WORKSPACE);
    OfflineTouch offline;
    offline.begin(Json{{"id", 7}, {"do", "touch"}, {"stroke", "circle"}}, 3, scene);
    scene.reset();
    std::optional<OfflineTouch::Made> made;
    while (!(made = offline.take()))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(made->error, "");
    EXPECT_EQ(made->client, 3u);
    EXPECT_EQ(made->id, 7u);
    EXPECT_GT(made->ticks.time.size(), 1000u);
}

} // namespace
} // namespace touchstone::server
