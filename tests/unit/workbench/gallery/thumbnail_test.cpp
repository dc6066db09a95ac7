// What is kept of pictures, what a file says about itself, and what becomes of a program that draws badly.

#include "engine/process/limited_process.h"
#include "tests/support/program.h"
#include "workbench/gallery/file_note.h"
#include "workbench/gallery/thumbnail_cache.h"
#include "workbench/gallery/thumbnail_maker.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace touchstone::test::thumbnail_test {
namespace {

namespace fs = std::filesystem;

class Thumbnails : public testing::Test {
  protected:
    fs::path file(const std::string& name, const std::string& text) {
        const fs::path path = scratch_ / name;
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }
    /// A program of the shell that stands in for ours.
    fs::path program(const std::string& text) {
        const fs::path path = file("program", "#!/bin/sh\n" + text);
        fs::permissions(path, fs::perms::owner_all);
        return path;
    }
    Thumbnail made(ThumbnailMaker& maker) {
        for (int i = 0; i < 3000; ++i) {
            if (std::optional<Thumbnail> done = maker.take())
                return *done;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        throw std::runtime_error("no thumbnail came");
    }

    ScratchFolder scratch_;
    ThumbnailCache cache_{scratch_ / "cache"};
};

TEST_F(Thumbnails, AreFoundAgainUntilTheFileChanges) {
    const fs::path model = file("a.glb", "one");
    const fs::path first = cache_.pictureOf(model);
    EXPECT_EQ(first.parent_path(), scratch_ / "cache");
    EXPECT_EQ(cache_.pictureOf(model), first);
    EXPECT_EQ(cache_.pictureOf(scratch_ / "./a.glb"), first) << "by whatever name";
    EXPECT_NE(cache_.pictureOf(file("b.glb", "one")), first);
    fs::last_write_time(model, fs::last_write_time(model) + std::chrono::seconds(1));
    const fs::path touched = cache_.pictureOf(model);
    EXPECT_NE(touched, first);
    const auto time = fs::last_write_time(model);
    file("a.glb", "longer");
    fs::last_write_time(model, time);
    EXPECT_NE(cache_.pictureOf(model), touched);
    EXPECT_EQ(cache_.pictureOf(scratch_ / "none.glb"), "");
    EXPECT_EQ(cache_.pictureOf(scratch_.path()), "") << "a folder";
}

TEST_F(Thumbnails, AreAtMostSoMany) {
    ASSERT_TRUE(cache_.makeRoom());
    const auto begin = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (size_t i = 0; i < ThumbnailCache::kMax + 20; ++i) {
        const fs::path picture = scratch_ / "cache" / (std::to_string(i) + ".png");
        std::ofstream(picture) << i;
        fs::last_write_time(picture, begin + std::chrono::seconds(i));
    }
    ASSERT_TRUE(cache_.makeRoom());
    EXPECT_EQ(static_cast<size_t>(std::distance(fs::directory_iterator(scratch_ / "cache"), {})),
              ThumbnailCache::kMax - 1)
        << "room for one more";
    EXPECT_FALSE(fs::exists(scratch_ / "cache/0.png")) << "the oldest go";
    EXPECT_TRUE(fs::exists(scratch_ / "cache/219.png"));
    EXPECT_FALSE(ThumbnailCache(file("no folder", "x") / "cache").makeRoom());
}

TEST_F(Thumbnails, KnowWhatAFileSaysAboutItself) {
    const std::string json = R"({"asset":{"version":"2.0","extras":{"description":"ribs\nand more"}}})";
    EXPECT_EQ(fileNote(file("a.gltf", json)), "ribs");
    const auto number = [](uint32_t n) { return std::string(reinterpret_cast<const char*>(&n), 4); };
    const auto size = static_cast<uint32_t>(json.size());
    EXPECT_EQ(fileNote(file("a.glb", "glTF" + number(2) + number(size + 20) + number(size) + "JSON" + json)),
              "ribs");
    EXPECT_EQ(fileNote(file("cut.glb", "glTF" + number(2) + number(900) + number(900) + "JSON" + json)), "");
    EXPECT_EQ(
        fileNote(file("huge.glb", "glTF" + number(2) + number(0xffffffff) + number(0xfffffff0) + "JSON")),
        "");
    for (const char* text : {"", "{", "[]", R"({"asset":7})", R"({"asset":{"extras":{"description":[1]}}})"})
        EXPECT_EQ(fileNote(file("b.gltf", text)), "") << text;
    EXPECT_EQ(fileNote(scratch_ / "none.gltf"), "");
    EXPECT_NE(fileNote(TOUCHSTONE_ASSETS "/doughnut.glb"), "");
}

TEST_F(Thumbnails, AreDrawnOnceAndThenKept) {
    ThumbnailMaker maker(TOUCHSTONE_BINARY, cache_);
    const fs::path box = TOUCHSTONE_ASSETS "/box.glb";
    maker.request(box);
    const Thumbnail drawn = made(maker);
    EXPECT_EQ(drawn.file, box);
    ASSERT_EQ(drawn.picture.bytes.size(), size_t{4} * ThumbnailMaker::kWidth * ThumbnailMaker::kHeight);
    ThumbnailMaker other("/bin/false", cache_);
    other.request(box);
    EXPECT_EQ(made(other).picture.bytes, drawn.picture.bytes);
}

TEST_F(Thumbnails, AreNotThereWhereDrawingFails) {
    const fs::path model = file("a.gltf", R"({"asset":{"version":"2.0","extras":{"description":"a note"}}})");
    const auto expectFate = [&](const fs::path& with, ThumbnailFate fate) {
        ThumbnailMaker maker(with, cache_);
        maker.request(model);
        const Thumbnail none = made(maker);
        EXPECT_TRUE(none.picture.bytes.empty());
        EXPECT_EQ(none.note, "a note");
        EXPECT_EQ(none.fate, fate);
    };
    for (const char* text : {"exit 1", "kill -SEGV $$", "exit 0", "echo no picture > \"$6\""}) {
        SCOPED_TRACE(text);
        expectFate(program(text), ThumbnailFate::Broken);
    }
    {
        SCOPED_TRACE("the system ends it");
        expectFate(program("kill -KILL $$"), ThumbnailFate::None);
    }
    {
        SCOPED_TRACE("nothing can be written");
        expectFate(program("rm -r \"$(dirname \"$6\")\"; exit 1"), ThumbnailFate::None);
    }
    {
        SCOPED_TRACE("no program");
        expectFate(scratch_ / "no program", ThumbnailFate::None);
    }
    ThumbnailMaker maker(TOUCHSTONE_BINARY, cache_);
    maker.request(scratch_ / "gone.glb");
    EXPECT_EQ(made(maker).fate, ThumbnailFate::Missing);
}

TEST_F(Thumbnails, TakeNoMoreThanTheyMay) {
    const fs::path box = TOUCHSTONE_ASSETS "/box.glb", seen = scratch_ / "seen";
    ThumbnailMaker small(TOUCHSTONE_BINARY, cache_, {.memory = uint64_t{32} << 20});
    small.request(box);
    EXPECT_TRUE(made(small).picture.bytes.empty()) << "more is needed, and not given";
    ThumbnailMaker maker(
        program("{ ulimit -t; ulimit -d; ulimit -c; cat /proc/$$/oom_score_adj; } > '" + seen.string() + "'"),
        cache_, {.processorSeconds = 7, .memory = uint64_t{100} << 20});
    maker.request(box);
    EXPECT_TRUE(made(maker).picture.bytes.empty());
    EXPECT_EQ(readFile(seen), "7\n102400\n0\n1000\n");
}

/// The first time it hangs, then it fails at once; its number is in `pid`.
class HangingThumbnail : public Thumbnails {
  protected:
    fs::path hanging() {
        return program("[ -e '" + pid_.string() + "' ] && exit 1; echo $$ > '" + pid_.string() +
                       ".new'; mv '" + pid_.string() + ".new' '" + pid_.string() + "'; exec sleep 1000");
    }
    void untilItRuns() {
        for (int i = 0; i < 1000 && !fs::exists(pid_); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ASSERT_TRUE(fs::exists(pid_));
    }
    bool runs() {
        const std::string number = readFile(pid_);
        return fs::exists("/proc/" + number.substr(0, number.size() - 1));
    }
    fs::path pid_ = scratch_ / "pid";
};

TEST_F(HangingThumbnail, EndsWithTheMaker) {
    {
        ThumbnailMaker maker(hanging(), cache_);
        maker.request(file("a.gltf", "{}"));
        untilItRuns();
    }
    EXPECT_FALSE(runs());
}

TEST_F(HangingThumbnail, EndsWhenNobodyWantsItAnyMore) {
    ThumbnailMaker maker(hanging(), cache_);
    const fs::path other = file("b.gltf", "{}");
    maker.request(file("a.gltf", "{}"));
    untilItRuns();
    maker.cancel();
    maker.request(other);
    EXPECT_EQ(made(maker).file, other) << "the next one, and nothing of what was given up";
    EXPECT_FALSE(runs());
}

TEST_F(HangingThumbnail, EndsWhenItsTimeIsOver) {
    ThumbnailMaker maker(hanging(), cache_, {.seconds = 1});
    maker.request(file("a.gltf", "{}"));
    maker.request(file("b.gltf", "{}"));
    const Thumbnail late = made(maker);
    EXPECT_EQ(late.file, scratch_ / "a.gltf");
    EXPECT_EQ(late.fate, ThumbnailFate::None);
    EXPECT_EQ(made(maker).file, scratch_ / "b.gltf") << "the others have their turn";
    EXPECT_FALSE(runs());
}

TEST_F(HangingThumbnail, EndsWithTheThreadThatStartedIt) {
    pid_t child = -1;
    std::thread([&] { child = startLimited("/bin/sleep", {"sleep", "1000"}, {}); }).join();
    ASSERT_GT(child, 0);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

} // namespace
} // namespace touchstone::test::thumbnail_test
