// The gallery in the real window: pictures come while everything goes on, and a model is opened by hand and
// by key.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>

namespace touchstone::test::gallery_window_tests {
namespace {

class GalleryWindow : public WindowTest {
  protected:
    GalleryWindow() { setenv("XDG_CACHE_HOME", cache_.c_str(), 1); }

    void showGallery() {
        display_.key("ctrl+g");
        until("the gallery", [](const Json& s) { return s["gallery"]["open"] == true; });
    }
    static size_t waiting(const Json& s) {
        return static_cast<size_t>(std::ranges::count_if(
            s["gallery"]["entries"], [](const Json& e) { return e["state"] == "waiting"; }));
    }
    /// Pictures are drawn at the loader's niceness: beside other tests each may take seconds. A wait is for
    /// the next picture, not for all.
    Json allDone() {
        Json s = until("entries", [](const Json& now) { return !now["gallery"]["entries"].empty(); });
        while (waiting(s) > 0)
            s = until("the next picture", [&](const Json& now) { return waiting(now) < waiting(s); });
        return s;
    }
    static Json entry(const Json& s, const std::string& name) {
        for (const Json& e : s["gallery"]["entries"])
            if (std::filesystem::path(e["file"].get<std::string>()).filename() == name)
                return e;
        throw std::runtime_error("the gallery has no " + name);
    }
    /// It is in the gallery, and its picture is drawn or cannot be.
    static bool looked(const Json& s, const std::string& name) {
        return std::ranges::any_of(s["gallery"]["entries"], [&](const Json& e) {
            return std::filesystem::path(e["file"].get<std::string>()).filename() == name &&
                   e["state"] != "waiting";
        });
    }
    /// Colours on the screen where a widget's picture is.
    size_t coloursOf(const std::string& widget) {
        const Json rect = status()["widgets"].at(widget);
        const ScreenPicture screen = display_.screen();
        std::set<std::array<uint8_t, 3>> colours;
        for (int y = 10; y < 120; ++y)
            for (int x = 10; x < 200; ++x)
                colours.insert(screen.at(corner_.x + static_cast<int>(rect["x"].get<double>()) + x,
                                         corner_.y + static_cast<int>(rect["y"].get<double>()) + y));
        return colours.size();
    }

    void showsPicturesAndOpensByHandAndByKey();
    void tellsWhatIsBrokenAndForgetsWhatIsGone();

    std::filesystem::path cache_ = scratch_ / "cache";
};

void GalleryWindow::showsPicturesAndOpensByHandAndByKey() {
    open(TOUCHSTONE_ASSETS "/plane.glb");
    showGallery();
    const Json done = allDone();
    for (const Json& e : done["gallery"]["entries"]) {
        EXPECT_EQ(e["state"], "shown") << e;
        EXPECT_EQ(e["sample"], true) << e;
        EXPECT_NE(e["note"], "") << e;
    }
    later();
    display_.move({corner_.x + 2, corner_.y + 2});
    later();
    EXPECT_GT(coloursOf("gallery:box.glb"), 100u) << "a picture, not a field of one colour";
    const auto kept = std::distance(std::filesystem::directory_iterator(cache_ / "touchstone/thumbnails"),
                                    std::filesystem::directory_iterator());
    EXPECT_EQ(static_cast<size_t>(kept), done["gallery"]["entries"].size());

    display_.click(middleOf("gallery:box.glb"));
    const Json box = until("the box", [](const Json& s) { return s["model"] == "box.glb"; });
    EXPECT_EQ(box["gallery"]["open"], false);

    // From the first entry one to the right: the arrows move no camera meanwhile.
    showGallery();
    const double yaw = later()["view"]["yaw"];
    const size_t at = status()["gallery"]["at"];
    display_.key("Right");
    const Json moved = until("the next entry", [&](const Json& s) { return s["gallery"]["at"] == at + 1; });
    EXPECT_EQ(moved["view"]["yaw"], yaw);
    const std::string chosen =
        std::filesystem::path(moved["gallery"]["entries"][at + 1]["file"].get<std::string>())
            .filename()
            .string();
    display_.key("Return");
    until(chosen, [&](const Json& s) { return s["model"] == chosen && s["gallery"]["open"] == false; });

    showGallery();
    display_.key("Escape");
    until("the gallery to close", [](const Json& s) { return s["gallery"]["open"] == false; });
    EXPECT_EQ(later()["model"], chosen);
    expectCleanEnd();
}

void GalleryWindow::tellsWhatIsBrokenAndForgetsWhatIsGone() {
    const std::filesystem::path own = scratch_ / "own.glb", gone = scratch_ / "gone.glb";
    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/box.glb", own);
    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/box.glb", gone);
    open(own.string());
    display_.drop("Touchstone", gone);
    until("the other", [](const Json& s) { return s["model"] == "gone.glb"; });
    std::filesystem::remove(gone);
    std::ofstream(own) << "this is no model";
    showGallery();
    const Json done = until("both to be told of", [](const Json& now) {
        return looked(now, "gone.glb") && looked(now, "own.glb");
    });
    EXPECT_EQ(entry(done, "gone.glb")["state"], "missing");
    EXPECT_EQ(entry(done, "own.glb")["state"], "broken");
    // Walk there by the keys, so that it is scrolled to, and click it away.
    display_.key("ctrl+g");
    until("the gallery to close", [](const Json& s) { return s["gallery"]["open"] == false; });
    showGallery();
    const auto& entries = done["gallery"]["entries"];
    size_t wanted = 0;
    while (entries[wanted]["file"] != gone.string())
        ++wanted;
    for (size_t i = 0; i < 12 && status()["gallery"]["at"].get<size_t>() < wanted; ++i) {
        const size_t at = status()["gallery"]["at"];
        display_.key("Down");
        until("another row", [&](const Json& s) { return s["gallery"]["at"].get<size_t>() > at; });
    }
    while (status()["gallery"]["at"].get<size_t>() > wanted) {
        const size_t at = status()["gallery"]["at"];
        display_.key("Left");
        until("the one before", [&](const Json& s) { return s["gallery"]["at"].get<size_t>() < at; });
    }
    display_.key("Delete");
    until("it to be forgotten", [&](const Json& s) {
        return std::ranges::none_of(s["gallery"]["entries"],
                                    [&](const Json& e) { return e["file"] == gone.string(); });
    });
    EXPECT_EQ(later()["model"], "gone.glb") << "what is open stays";
    expectCleanEnd();
}

/// One cache for both: to draw every sample takes most of the time.
TEST_F(GalleryWindow, ShowsPicturesOpensThemTellsWhatIsBrokenAndForgetsWhatIsGone) {
    showsPicturesAndOpensByHandAndByKey();
    tellsWhatIsBrokenAndForgetsWhatIsGone();
}

} // namespace
} // namespace touchstone::test::gallery_window_tests
