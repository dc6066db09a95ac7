#include "engine/import/file/gltf_uri.h"
#include "tests/unit/engine/load_support.h"

namespace touchstone::gltf_uri_test {
namespace {

using test::contains;
using test::GltfMaker;

class Uris : public testing::Test {
  protected:
    std::filesystem::path resolve(const std::string& uri) {
        return resolveUri(context_, "images[0].uri", "folder", uri);
    }
    DataUri decode(const std::string& uri) { return decodeDataUri(context_, "images[0].uri", uri); }

    LoadOptions options_;
    ImportContext context_{"model.gltf", options_};
};

TEST_F(Uris, RelativeOnesStayInTheFolder) {
    EXPECT_EQ(resolve("a.png"), "folder/a.png");
    EXPECT_EQ(resolve("./textures/a.png"), "folder/./textures/a.png");
    EXPECT_EQ(resolve("with%20space%25.png"), "folder/with space%.png");
    EXPECT_EQ(resolve("with space.png"), "folder/with space.png");
    EXPECT_EQ(resolve("%C3%BCml%C3%A4ut.png"), "folder/\xC3\xBCml\xC3\xA4ut.png");
    EXPECT_EQ(resolve("textures\\a.png"), "folder/textures/a.png");
    EXPECT_EQ(resolve("..a/b..png"), "folder/..a/b..png"); // dots alone make no parent
}

TEST_F(Uris, WhatLeavesTheFolderIsRefused) {
    for (const char* uri : {"/etc/passwd",
                            "../a.png",
                            "a/../../b.png",
                            "..",
                            "a/..",
                            "%2e%2e/a.png",
                            "%2E%2E%2Fa.png",
                            "a%2f..%2f..%2fb.png",
                            "..\\a.png",
                            "%5c%5cserver%5cshare",
                            "\\\\server\\share",
                            "%2Fetc%2Fpasswd",
                            "file:///etc/passwd",
                            "http://example.com/a.png",
                            "HTTPS://x",
                            "C:/a.png",
                            "C%3A/a.png",
                            ":",
                            "",
                            "a%00.png",
                            "a%2.png",
                            "a%zz.png",
                            "100%"}) {
        const Error error = test::errorOf([&] { return resolve(uri); });
        EXPECT_EQ(error.place(), "images[0].uri") << uri;
        EXPECT_FALSE(error.remedy().empty()) << uri;
    }
}

TEST_F(Uris, DataUrisDecode) {
    const auto text = [](const DataUri& data) { return std::string(data.bytes.begin(), data.bytes.end()); };
    EXPECT_EQ(text(decode("data:application/octet-stream;base64,aGVsbG8=")), "hello");
    EXPECT_EQ(text(decode("data:;base64,aGVsbG8")), "hello"); // padding may be left out
    EXPECT_EQ(text(decode("DATA:Image/PNG;charset=x;base64,aGVsbG8=")), "hello");
    EXPECT_EQ(decode("DATA:Image/PNG;charset=x;base64,aGVsbG8=").mediaType, "image/png");
    EXPECT_EQ(text(decode("data:,he%6Clo")), "hello");
    EXPECT_EQ(text(decode("data:;base64,aGVsbG8%3D")), "hello");
    EXPECT_TRUE(decode("data:;base64,").bytes.empty());
}

TEST_F(Uris, MalformedDataUrisAreRefused) {
    for (const char* uri :
         {"data:", "data:image/png;base64", "data:image/png;;base64,AA==", "data:;base64,A",
          "data:;base64,A?==", "data:;base64,AA===", "data:;base64,AA==AA==", "data:;,x", "data:,%4"})
        EXPECT_TRUE(contains(test::errorOf([&] { return decode(uri); }).problem(), "malformed")) << uri;
}

TEST(UriFiles, NamesWithSpacesAndUnicodeLoad) {
    test::TemporaryFolder folder;
    GltfMaker maker = GltfMaker::square();
    test::writeFile(folder.path() /
                        "m\xC3\xB6"
                        "del \xE8\xA7\xA6" /
                        "the data \xE2\x9C\x8B.bin",
                    maker.bytes);
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", "the%20data%20\xE2\x9C\x8B.bin"}}};
    const auto path = folder.path() /
                      "m\xC3\xB6"
                      "del \xE8\xA7\xA6" /
                      "a square.gltf";
    test::writeFile(path, maker.json.dump());
    EXPECT_EQ(loadScene(path)->triangleCount(), 2u);
}

TEST(UriFiles, BuffersOutsideAreNotRead) {
    test::TemporaryFolder folder;
    GltfMaker maker = GltfMaker::square();
    test::writeFile(folder.path() / "secret.bin", maker.bytes);
    std::filesystem::create_directories(folder.path() / "model");
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
          (folder.path() / "secret.bin").string(), "file://" + (folder.path() / "secret.bin").string()}) {
        maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", uri}}};
        const auto path = folder.path() / "model" / "a.gltf";
        test::writeFile(path, maker.json.dump());
        const Error error = test::errorOf([&] { return loadScene(path); });
        EXPECT_EQ(error.place(), "buffers[0].uri") << uri;
        EXPECT_TRUE(contains(error.remedy(), "the model's folder")) << error.what();
    }
}

TEST(UriFiles, MissingAndShortBuffersAreRefused) {
    test::TemporaryFolder folder;
    GltfMaker maker = GltfMaker::square();
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", "a.bin"}}};
    const auto path = folder.path() / "a.gltf";
    test::writeFile(path, maker.json.dump());
    EXPECT_TRUE(contains(test::errorOf([&] { return loadScene(path); }).problem(), "\"a.bin\" is missing"));
    test::writeFile(folder.path() / "a.bin", maker.bytes.data(), maker.bytes.size() - 1);
    EXPECT_TRUE(contains(test::errorOf([&] { return loadScene(path); }).problem(), "byteLength says"));
    std::filesystem::remove(folder.path() / "a.bin");
    std::filesystem::create_directory(folder.path() / "a.bin");
    EXPECT_TRUE(contains(test::errorOf([&] { return loadScene(path); }).problem(), "not a file"));
}

TEST(UriFiles, OneFileForManyBuffersIsReadOnce) {
    test::TemporaryFolder folder;
    GltfMaker maker = GltfMaker::square();
    maker.json["buffers"] = nlohmann::json::array();
    std::vector<uint8_t> large(8 << 20);
    std::copy(maker.bytes.begin(), maker.bytes.end(), large.begin());
    test::writeFile(folder.path() / "a.bin", large);
    for (int i = 0; i < 2000; ++i)
        maker.json["buffers"].push_back(
            {{"byteLength", large.size()}, {"uri", "a.bin"}}); // 16 GB if each were kept
    test::writeFile(folder.path() / "a.gltf", maker.json.dump());
    EXPECT_EQ(loadScene(folder.path() / "a.gltf")->triangleCount(), 2u);
}

} // namespace
} // namespace touchstone::gltf_uri_test
