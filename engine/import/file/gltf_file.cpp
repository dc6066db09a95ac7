#include "engine/import/file/gltf_file.h"

#include "engine/core/input_file.h"
#include "engine/import/file/gltf_kind.h"
#include "engine/import/file/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <system_error>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr uint32_t kGlbMagic = 0x46546C67;  // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A; // "JSON"
constexpr uint32_t kBinChunk = 0x004E4942;  // "BIN\0"

uint32_t littleEndian32(ByteSpan bytes, size_t at) {
    return static_cast<uint32_t>(bytes[at]) | static_cast<uint32_t>(bytes[at + 1]) << 8 |
           static_cast<uint32_t>(bytes[at + 2]) << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

/// Counts the JSON's values before any is built. (The parser's own callback does the same, but at a cost that
/// grows with the square of an array's length.)
class JsonMeter : public json::json_sax_t {
  public:
    explicit JsonMeter(ImportContext& context) : context_(context) {}

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t& text) override {
        if (!isDataUri(text))
            countText(text);
        return value();
    }
    bool binary(binary_t&) override { return value(); }
    bool key(string_t& text) override {
        countText(text);
        // Only the first kKeysCompared keys are compared: no name that glTF defines is looked up in larger
        // objects, and comparing all keys would cost the square.
        std::vector<size_t>& keys = keys_[static_cast<size_t>(depth_)];
        const size_t hash = std::hash<std::string>()(text);
        if (keys.size() < kKeysCompared && std::find(keys.begin(), keys.end(), hash) != keys.end())
            context_.warn("", "the JSON has an object with two properties \"" + text.substr(0, 40) +
                                  "\"; the last one counts");
        if (keys.size() < kKeysCompared)
            keys.push_back(hash);
        return true;
    }
    bool start_object(size_t) override {
        const bool go = open();
        keys_[static_cast<size_t>(depth_)].clear();
        return go;
    }
    bool start_array(size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(size_t position, const std::string& token,
                     const nlohmann::detail::exception& error) override {
        constexpr int kNumberOverflow = 406; // of nlohmann::json
        if (error.id == kNumberOverflow)
            context_.fail("",
                          "the JSON holds a number beyond all that computers calculate with, " +
                              token.substr(0, 40) + ", at byte " + std::to_string(position),
                          "correct the number in the file, or re-export the model");
        const std::string what = error.what();
        const size_t end = what.find("] "); // of the library's own "[json.exception...] "
        context_.fail(
            "", "not a glTF file, or a damaged one: " + what.substr(end == std::string::npos ? 0 : end + 2),
            "open a .gltf or .glb file, or re-export this one");
    }

  private:
    void countText(const string_t& text) {
        textBytes_ += text.size();
        if (textBytes_ > kMaxTextBytes)
            context_.fail("",
                          "the JSON holds more than " + std::to_string(kMaxTextBytes >> 20) + " MiB of text",
                          "shorten its names and extras");
    }
    bool value() {
        if (++values_ > kMaxJsonValues)
            context_.fail("", "the JSON holds more than " + std::to_string(kMaxJsonValues) + " values",
                          "split the model into several files");
        return true;
    }
    bool open() {
        if (++depth_ > kMaxJsonDepth)
            context_.fail("",
                          "the JSON is nested more than " + std::to_string(kMaxJsonDepth) + " levels deep");
        return value();
    }
    bool close() {
        --depth_;
        return true;
    }

    static constexpr size_t kKeysCompared = 64;
    ImportContext& context_;
    size_t values_ = 0, textBytes_ = 0;
    int depth_ = 0;
    std::array<std::vector<size_t>, kMaxJsonDepth + 1> keys_; ///< hashes, of the object open at each depth
};

void takeBinary(ImportContext& context, GltfFile& file, ByteSpan chunk, size_t index) {
    if (index != 1)
        context.warn(element("chunks", index), "is the binary chunk, which belongs directly after the JSON");
    file.binary = chunk;
}

/// Fills `json` and `binary` from the chunks of a GLB.
ByteSpan readGlbChunks(ImportContext& context, GltfFile& file) {
    const ByteSpan all = file.bytes;
    if (all.size() < 20)
        context.fail("header", "the GLB file is truncated: it ends inside its header",
                     "copy or re-export the file");
    const uint32_t version = littleEndian32(all, 4);
    if (version == 1)
        context.fail("header", "GLB version 1 is not supported: the file is glTF 1.0", kConvertGltf1);
    if (version != 2)
        context.fail("header", "GLB version " + std::to_string(version) + " is not supported",
                     "export it as glTF 2.0");
    const uint64_t stated = littleEndian32(all, 8);
    if (stated > all.size())
        context.fail("header",
                     "the GLB file is truncated: it should have " + std::to_string(stated) +
                         " bytes and has " + std::to_string(all.size()),
                     "copy or re-export the file");
    if (stated < all.size())
        context.warn("header", "bytes after the end of the GLB are ignored");

    ByteSpan text;
    bool haveJson = false;
    size_t index = 0;
    for (uint64_t at = 12; at < stated; ++index) {
        if (stated - at < 8)
            context.fail("chunks", "a GLB chunk header is cut off", "copy or re-export the file");
        const uint64_t length = littleEndian32(all, at);
        const uint32_t type = littleEndian32(all, at + 4);
        at += 8;
        if (length > stated - at)
            context.fail("chunks", "a GLB chunk reaches beyond the end of the file",
                         "copy or re-export the file");
        const ByteSpan chunk = all.subspan(at, length);
        if (!haveJson && type != kJsonChunk)
            context.fail("chunks", "the first GLB chunk is not the JSON");
        if (length % 4 != 0)
            context.warn(element("chunks", index), "its length is no multiple of four");
        if (!haveJson)
            text = chunk;
        else if (type == kBinChunk && !file.binary)
            takeBinary(context, file, chunk, index);
        else
            context.warn(element("chunks", index),
                         type == kJsonChunk  ? "is a second JSON chunk; it is ignored"
                         : type == kBinChunk ? "is a second binary chunk; it is ignored"
                                             : "is of an unknown type; it is ignored");
        haveJson = true;
        at += length;
    }
    if (!haveJson)
        context.fail("chunks", "the GLB holds no JSON chunk");
    return text;
}

} // namespace

json parseJson(ImportContext& context, ByteSpan text, Comments comments) {
    const bool ignore = comments == Comments::Ignore;
    JsonMeter meter(context);
    json::sax_parse(text.begin(), text.end(), &meter, nlohmann::detail::input_format_t::json, true, ignore);
    return json::parse(text.begin(), text.end(), nullptr, true, ignore);
}

std::vector<uint8_t> readWholeFile(const std::filesystem::path& path, const std::string& shownAs,
                                   const Progress& progress) {
    constexpr uint64_t kBlock = 8 << 20;
    requireFile(path, shownAs, "name a .gltf or .glb file");
    std::error_code problem;
    const uint64_t size = std::filesystem::file_size(path, problem);
    if (problem)
        throw Error(shownAs, "", "cannot be read: " + problem.message(), "check its permissions");
    if (size > kMaxFileBytes)
        throw Error(shownAs, "", "is larger than 4 GiB", "split the model into several files");

    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        throw Error(shownAs, "", std::string("cannot be opened: ") + std::strerror(errno),
                    "check its permissions");
    std::vector<uint8_t> bytes(size);
    for (uint64_t at = 0; at < size; at += kBlock) {
        progress.step(share(at, size), "reading the file");
        const uint64_t wanted = std::min(kBlock, size - at);
        stream.read(reinterpret_cast<char*>(bytes.data() + at), static_cast<std::streamsize>(wanted));
        if (static_cast<uint64_t>(stream.gcount()) != wanted)
            throw Error(shownAs, "", "could not be read to its end", "try again");
    }
    return bytes;
}

GltfFile takeGltfApart(ImportContext& context, std::vector<uint8_t> bytes,
                       const std::filesystem::path& folder) {
    GltfFile file;
    file.folder = folder;
    file.bytes = std::move(bytes);
    ByteSpan text = file.bytes;
    if (text.empty())
        context.fail("", "the file is empty", "copy or re-export the file");
    if (text.size() >= 4 && littleEndian32(text, 0) == kGlbMagic)
        text = readGlbChunks(context, file);
    file.isGlb = text.data() != file.bytes.data();
    static constexpr std::array<uint8_t, 3> kByteOrderMark = {0xEF, 0xBB, 0xBF};
    if (text.size() >= 3 && std::equal(kByteOrderMark.begin(), kByteOrderMark.end(), text.begin())) {
        context.warn("", "the JSON begins with a byte order mark, which glTF forbids");
        text = text.subspan(3);
    }
    const auto start = std::find_if(
        text.begin(), text.end(), [](uint8_t c) { return c != ' ' && c != '\t' && c != '\r' && c != '\n'; });
    if (!file.isGlb && (start == text.end() || *start != '{'))
        refuseOtherFormats(context, file.bytes);
    file.json = parseJson(context, text, Comments::Refuse);
    if (!file.json.is_object())
        context.fail("", "not a glTF file: its JSON is not an object", "open a .gltf or .glb file");
    return file;
}

GltfFile readGltfFile(ImportContext& context, const std::filesystem::path& path) {
    return takeGltfApart(context, readWholeFile(path, context.file()), path.parent_path());
}

} // namespace touchstone
