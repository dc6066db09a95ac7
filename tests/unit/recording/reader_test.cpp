// Files as they come back from the world: whole, cut off, spoilt, or something else altogether.

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "haptics/recording/recording_file.h"
#include "haptics/recording/recording_reader.h"
#include "haptics/recording/recording_writer.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

namespace touchstone::test {
namespace {

/// Three blocks of ticks and what they refer to.
std::vector<RecordedItem> smallRecording() {
    // Once: an origin names the second in which it is made.
    static const RecordingOrigin kOrigin = recordingOrigin("touch", 1000.0);
    std::vector<RecordedItem> items{kOrigin, RecordedSettings{}};
    for (uint64_t block = 0; block < 3; ++block) {
        RecordedTicks ticks;
        for (uint64_t i = 0; i < 4; ++i)
            ticks.ticks.emplace_back().tick = 4 * block + i;
        items.emplace_back(ticks);
    }
    items.emplace_back(RecordedEnd{12});
    return items;
}

/// Every chunk that a reader gives, as bytes.
struct Reading {
    std::vector<std::vector<std::byte>> items;
    std::vector<bool> damageBefore;
    bool cutOff = false;
    size_t damage = 0;
};
Reading readingOf(const std::filesystem::path& file) {
    RecordingReader reader(file);
    Reading reading;
    while (const auto item = reader.next()) {
        reading.items.push_back(encode(item->item));
        reading.damageBefore.push_back(item->damageBefore);
    }
    reading.cutOff = reader.cutOff();
    reading.damage = reader.damage().size();
    return reading;
}

class ReaderTest : public testing::Test {
  protected:
    ReaderTest() {
        writeItems(file_, smallRecording());
        bytes_ = readFile(file_);
        whole_ = readingOf(file_);
    }
    Reading reading(const std::string& bytes) {
        writeTextFile(file_, bytes);
        return readingOf(file_);
    }
    std::string problem(const std::string& bytes) {
        writeTextFile(file_, bytes);
        try {
            (void)readingOf(file_);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
    std::string bytes_;
    Reading whole_;
};

TEST_F(ReaderTest, AWholeFileIsReadAsItWasWritten) {
    const std::vector<RecordedItem> items = smallRecording();
    ASSERT_EQ(whole_.items.size(), items.size());
    for (size_t i = 0; i < items.size(); ++i)
        EXPECT_EQ(whole_.items[i], encode(items[i]));
    EXPECT_FALSE(whole_.cutOff);
    EXPECT_EQ(whole_.damage, 0u);
}

TEST_F(ReaderTest, AFileCutAnywhereGivesAllThatIsWholeBeforeIt) {
    for (size_t length = kFileHeaderSize; length < bytes_.size(); length += length < 400 ? 1 : 7) {
        const Reading cut = reading(bytes_.substr(0, length));
        ASSERT_LT(cut.items.size(), whole_.items.size()) << length;
        for (size_t i = 0; i < cut.items.size(); ++i)
            ASSERT_EQ(cut.items[i], whole_.items[i]) << length;
        ASSERT_TRUE(cut.cutOff) << length;
        ASSERT_EQ(cut.damage, 0u) << length;
    }
    const size_t lastChunk = kChunkHeaderSize + 8; // DONE
    EXPECT_EQ(reading(bytes_.substr(0, bytes_.size() - lastChunk)).items.size(), whole_.items.size() - 1);
}

TEST_F(ReaderTest, ASpoiltByteLosesItsOwnChunkAndNoOther) {
    for (size_t at = kFileHeaderSize; at < bytes_.size(); at += at < 400 ? 1 : 7) {
        std::string spoilt = bytes_;
        spoilt[at] = static_cast<char>(spoilt[at] ^ 0x40);
        const Reading got = reading(spoilt);
        // All that is read was written, in its order, and at most one is missing.
        size_t next = 0;
        for (const std::vector<std::byte>& item : got.items) {
            while (next < whole_.items.size() && whole_.items[next] != item)
                ++next;
            ASSERT_LT(next++, whole_.items.size()) << "byte " << at;
        }
        ASSERT_GE(got.items.size() + 1, whole_.items.size()) << "byte " << at;
        ASSERT_TRUE(got.damage > 0 || got.cutOff) << "byte " << at;
    }
}

TEST_F(ReaderTest, AChunkThatIsMissingIsNoticedAndSaid) {
    // The middle block of ticks taken out, as a careless tool might.
    const std::vector<RecordedItem> items = smallRecording();
    std::string cut;
    size_t at = kFileHeaderSize;
    for (size_t i = 0; i < items.size(); ++i) {
        const size_t size = kChunkHeaderSize + encode(items[i]).size();
        if (i != 3)
            cut += bytes_.substr(at, size);
        at += size;
    }
    const Reading got = reading(bytes_.substr(0, kFileHeaderSize) + cut);
    EXPECT_EQ(got.items.size(), items.size() - 1);
    EXPECT_EQ(got.damage, 1u);
    EXPECT_TRUE(got.damageBefore[3]);
}

TEST_F(ReaderTest, AChunkOfAnUnknownKindIsLeftOut) {
    // A chunk of a later version between two of ours: name, checksum and number as they should be.
    const std::vector<RecordedItem> items = smallRecording();
    std::string bytes = bytes_.substr(0, kFileHeaderSize);
    for (uint32_t i = 0; i < items.size(); ++i) {
        std::vector<std::byte> chunk = chunkOf(items[i], i < 2 ? i : i + 1);
        bytes.append(reinterpret_cast<const char*>(chunk.data()), chunk.size());
        if (i != 1)
            continue;
        chunk = chunkOf(RecordedLoss{}, 2);
        std::memcpy(chunk.data() + 4, "XTRA", 4);
        const std::span<const std::byte> all(chunk);
        const uint32_t checksum = crc32c(all.subspan(kChunkHeaderSize), crc32c(all.subspan(4, 12)));
        std::memcpy(chunk.data() + 16, &checksum, sizeof checksum);
        bytes.append(reinterpret_cast<const char*>(chunk.data()), chunk.size());
    }
    const Reading got = reading(bytes);
    EXPECT_EQ(got.items, whole_.items);
    EXPECT_EQ(got.damage, 0u);
}

TEST_F(ReaderTest, WhatIsNoRecordingIsToldApart) {
    EXPECT_NE(problem("").find("is empty"), std::string::npos);
    EXPECT_NE(problem("t,x,y,z\n0,0,0,0\n").find("is no recording"), std::string::npos);
    EXPECT_NE(problem(bytes_.substr(0, kFileHeaderSize - 1)).find("is no recording"), std::string::npos);
    EXPECT_THROW(RecordingReader(scratch_ / "nothing"), Error);
    EXPECT_THROW(RecordingReader(scratch_.path()), Error);
    std::string spoilt = bytes_;
    spoilt[9] = 'x';
    EXPECT_NE(problem(spoilt).find("header is damaged"), std::string::npos);
}

TEST_F(ReaderTest, ANewerFormatSaysSo) {
    std::vector<std::byte> header(kFileHeaderSize - 4);
    std::memcpy(header.data(), bytes_.data(), header.size());
    const uint32_t newer = kRecordingVersion + 1;
    std::memcpy(header.data() + 8, &newer, sizeof newer);
    const uint32_t checksum = crc32c(header);
    std::string bytes(reinterpret_cast<const char*>(header.data()), header.size());
    bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
    const std::string said = problem(bytes + bytes_.substr(kFileHeaderSize));
    EXPECT_NE(said.find("is of format " + std::to_string(newer)), std::string::npos) << said;
    EXPECT_NE(said.find("newer Touchstone"), std::string::npos) << said;
}

TEST(RecordingFile, ADeviceThatIsFullIsAnErrorThatNamesIt) {
    try {
        RecordingFile file("/dev/full");
        FAIL() << "it took the header";
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "/dev/full");
        EXPECT_NE(error.problem().find("No space left"), std::string::npos) << error.problem();
    }
}

/// Runs `work` in a process of its own and returns how it ended.
int inAChild(const std::function<void()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        work();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
}

TEST(RecordingFile, WhereItMayNotGrowItEndsWithItsLastWholeChunk) {
    const ScratchFolder scratch;
    const std::filesystem::path path = scratch / "r.tsrec";
    constexpr size_t kLimit = 10000;
    const int status = inAChild([&] {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{kLimit, kLimit};
        setrlimit(RLIMIT_FSIZE, &limit);
        RecordingFile file(path);
        RecordedTicks ticks;
        ticks.ticks.resize(7);
        try {
            for (;;)
                file.append(ticks);
        } catch (const Error&) {
            _exit(3);
        }
    });
    EXPECT_EQ(WEXITSTATUS(status), 3);
    const size_t chunk = chunkOf(RecordedTicks{std::vector<RecordedTick>(7)}, 0).size();
    EXPECT_EQ(std::filesystem::file_size(path), kFileHeaderSize + (kLimit - kFileHeaderSize) / chunk * chunk);
    const Reading got = readingOf(path);
    EXPECT_EQ(got.items.size(), (kLimit - kFileHeaderSize) / chunk);
    EXPECT_EQ(got.damage, 0u);
    EXPECT_TRUE(got.cutOff);
}

TEST(RecordingFile, AKilledProcessLeavesAllThatItAppended) {
    const ScratchFolder scratch;
    const std::filesystem::path path = scratch / "r.tsrec";
    const int status = inAChild([&] {
        RecordingFile file(path);
        for (uint64_t i = 0; i < 1000; ++i)
            file.append(RecordedLoss{i});
        raise(SIGKILL);
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    const Reading got = readingOf(path);
    ASSERT_EQ(got.items.size(), 1000u);
    EXPECT_EQ(got.items[999], encode(RecordedLoss{999}));
    EXPECT_TRUE(got.cutOff);
}

TEST_F(ReaderTest, GoesBackToWhereAnItemBegan) {
    writeItems(file_, smallRecording());
    RecordingReader reader(file_);
    std::vector<uint64_t> offsets;
    while (const auto item = reader.next())
        offsets.push_back(item->offset);
    ASSERT_EQ(offsets.size(), whole_.items.size());
    for (const size_t i : {size_t{4}, size_t{0}, size_t{2}, size_t{5}}) {
        reader.goTo(offsets[i]);
        const auto item = reader.next();
        ASSERT_TRUE(item);
        EXPECT_EQ(encode(item->item), whole_.items[i]);
        EXPECT_EQ(item->offset, offsets[i]);
        EXPECT_FALSE(item->damageBefore) << "what lies between was left out on purpose";
    }
    EXPECT_TRUE(reader.damage().empty());
}

/// The kinds of the chunks behind the origin, with the number of ticks in a block.
std::string kindsOf(const std::filesystem::path& file) {
    std::string kinds;
    for (const RecordedItem& item : itemsOf(file)) {
        kinds += std::string(kChunkNames[item.index()]);
        if (const auto* block = std::get_if<RecordedTicks>(&item))
            kinds += std::to_string(block->ticks.size());
        if (const auto* loss = std::get_if<RecordedLoss>(&item))
            kinds += std::to_string(loss->ticks);
        kinds += " ";
    }
    return kinds;
}

TEST(RecordingWriter, WhatATickNeedsStandsBeforeIt) {
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "r.tsrec";
    RecordingWriter writer(file, recordingOrigin("test", 1000.0));
    const HapticSettings settings;
    const SceneIdentity scene;
    TouchCheckpoint checkpoint;
    RecordedTick tick;
    const auto add = [&](bool withCheckpoint, uint64_t lost = 0) {
        writer.add({.tick = tick,
                    .settings = settings,
                    .scene = tick.scene != 0 ? &scene : nullptr,
                    .checkpoint = withCheckpoint ? &checkpoint : nullptr,
                    .lostBefore = lost});
        ++tick.tick;
    };
    const auto name = [](const RecordedItem& item) { return std::string(kChunkNames[item.index()]); };
    const std::string origin = name(RecordingOrigin{}), scn = name(RecordedScene{}),
                      set = name(RecordedSettings{}), check = name(TouchCheckpoint{}),
                      ticks = name(RecordedTicks{}), loss = name(RecordedLoss{}), end = name(RecordedEnd{});
    add(false);    // nothing to begin with
    add(false, 3); // and nothing lost of what is not recorded
    add(true, 3);
    add(false);
    tick.settings = 1;
    add(false); // other settings
    tick.scene = 1;
    add(false); // a scene
    add(false);
    add(false, 1); // one tick is lost
    add(true);     // a checkpoint alone
    for (int i = 0; i < 256; ++i)
        add(false); // a block is full
    writer.finish();
    EXPECT_EQ(kindsOf(file), origin + " " + set + " " + check + " " + ticks + "2 " + set + " " + ticks +
                                 "1 " + scn + " " + ticks + "2 " + loss + "1 " + ticks + "1 " + check + " " +
                                 ticks + "256 " + ticks + "1 " + end + " ");
    EXPECT_EQ(writer.ticks(), 263u);
}

} // namespace
} // namespace touchstone::test
