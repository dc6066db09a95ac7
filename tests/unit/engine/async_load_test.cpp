#include "engine/load/async_load.h"
#include "tests/unit/engine/load_support.h"

#include <chrono>

namespace touchstone {
namespace {

using test::GltfMaker;

void waitFor(const AsyncLoad& load) {
    while (!load.finished())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(AsyncLoad, GivesTheSceneOnce) {
    test::TemporaryFolder folder;
    test::writeFile(folder.path() / "a.glb", GltfMaker::square().glb());
    AsyncLoad load(folder.path() / "a.glb");
    waitFor(load);
    EXPECT_EQ(load.progress().fraction, 1.0);
    EXPECT_STREQ(load.progress().what, "done");
    const ScenePtr scene = load.take();
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->triangleCount(), 2u);
    EXPECT_FALSE(load.take());
}

TEST(AsyncLoad, BringsTheErrorOfTheWorker) {
    AsyncLoad load("/nonexistent/model.glb");
    waitFor(load);
    const Error error = test::errorOf([&] { return load.take(); });
    EXPECT_EQ(error.file(), "/nonexistent/model.glb");
    EXPECT_TRUE(test::contains(error.problem(), "no such file"));
}

TEST(AsyncLoad, CanBeCancelledAndForgotten) {
    test::TemporaryFolder folder;
    GltfMaker maker = GltfMaker::square();
    for (int i = 0; i < 20'000; ++i)
        maker.append("nodes", {{"mesh", 0}});
    maker.json.erase("scenes");
    test::writeFile(folder.path() / "a.glb", maker.glb());
    {
        AsyncLoad forgotten(folder.path() / "a.glb"); // its destructor must neither hang nor crash
    }
    AsyncLoad load(folder.path() / "a.glb");
    load.cancel();
    // Whichever came first: the scene or the cancellation; never anything else.
    try {
        EXPECT_TRUE(load.take());
    } catch (const Error& error) {
        EXPECT_EQ(error.problem(), "cancelled");
    }
}

TEST(LoadOptions, CancelStopsALoadBeforeItsNextStep) {
    const std::atomic<bool> cancel{true};
    LoadOptions options;
    options.cancel = &cancel;
    EXPECT_EQ(test::errorOf([&] { return test::load(GltfMaker::square(), options); }).problem(), "cancelled");
}

TEST(LoadOptions, ProgressRisesToOne) {
    std::vector<double> fractions;
    LoadOptions options;
    options.progress = [&](double fraction, const char* what) {
        fractions.push_back(fraction);
        EXPECT_NE(std::string(what), "");
    };
    (void)test::load(GltfMaker::square(), options);
    ASSERT_GE(fractions.size(), 3u);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.back(), 1.0);
}

} // namespace
} // namespace touchstone
