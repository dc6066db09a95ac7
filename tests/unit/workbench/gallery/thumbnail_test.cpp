// What is kept of pictures, what a file says about itself, and what becomes of a program that draws badly.

#include "tests/support/program.h"
#include "workbench/gallery/file_note.h"
#include "workbench/gallery/thumbnail_cache.h"
#include "workbench/gallery/thumbnail_maker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace touchstone::test {
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
    for (size_t i = 0; i < ThumbnailCache::kMost + 20; ++i) {
        const fs::path picture = scratch_ / "cache" / (std::to_string(i) + ".png");
        std::ofstream(picture) << i;
        fs::last_write_time(picture, begin + std::chrono::seconds(i));
    }
    ASSERT_TRUE(cache_.makeRoom());
    EXPECT_EQ(static_cast<size_t>(std::distance(fs::directory_iterator(scratch_ / "cache"), {})),
              ThumbnailCache::kMost - 1)
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
    for (const char* text : {"exit 1", "kill -SEGV $$", "exit 0", "echo no picture > \"$6\""}) {
        ThumbnailMaker maker(program(text), cache_);
        maker.request(model);
        const Thumbnail none = made(maker);
        EXPECT_TRUE(none.picture.bytes.empty()) << text;
        EXPECT_EQ(none.note, "a note") << text;
        EXPECT_FALSE(none.missing) << text;
    }
    ThumbnailMaker maker(scratch_ / "no program", cache_);
    maker.request(model);
    EXPECT_TRUE(made(maker).picture.bytes.empty());
    maker.request(scratch_ / "gone.glb");
    EXPECT_TRUE(made(maker).missing);
}

TEST_F(Thumbnails, WhatHangsEndsWithTheMaker) {
    const fs::path pid = scratch_ / "pid";
    {
        ThumbnailMaker maker(program("echo $$ > '" + pid.string() + "'; exec sleep 1000"), cache_);
        maker.request(file("a.gltf", "{}"));
        for (int i = 0; i < 1000 && readFile(pid).empty(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    const std::string number = readFile(pid);
    ASSERT_FALSE(number.empty());
    EXPECT_FALSE(fs::exists("/proc/" + number.substr(0, number.size() - 1)));
}

} // namespace
} // namespace touchstone::test
