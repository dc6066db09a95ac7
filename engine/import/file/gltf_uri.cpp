#include "engine/import/file/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace touchstone {
namespace {

constexpr const char* kStayInside = "put the file into the model's folder and refer to it by a relative path";

int hexDigit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

std::optional<std::string> percentDecoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded.push_back(text[i]);
            continue;
        }
        if (i + 2 >= text.size())
            return std::nullopt;
        const int high = hexDigit(text[i + 1]), low = hexDigit(text[i + 2]);
        if (high < 0 || low < 0)
            return std::nullopt;
        decoded.push_back(static_cast<char>(high * 16 + low));
        i += 2;
    }
    return decoded;
}

// A colon before the first separator makes a scheme (RFC 3986), or a drive letter, or an empty scheme.
bool hasScheme(std::string_view text) {
    const size_t end = text.find_first_of(":/\\?#");
    return end != std::string_view::npos && text[end] == ':';
}

bool hasParentStep(std::string_view path) {
    for (size_t at = 0; at <= path.size();) {
        const size_t end = std::min(path.find('/', at), path.size());
        if (path.substr(at, end - at) == "..")
            return true;
        at = end + 1;
    }
    return false;
}

std::string shortened(std::string_view uri) {
    return uri.size() <= 60 ? std::string(uri) : std::string(uri.substr(0, 60)) + "...";
}

std::optional<std::vector<uint8_t>> base64Decoded(std::string_view text) {
    static constexpr auto kValues = [] {
        std::array<int8_t, 256> table{};
        table.fill(-1);
        constexpr std::string_view kAlphabet =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (size_t i = 0; i < kAlphabet.size(); ++i)
            table[static_cast<uint8_t>(kAlphabet[i])] = static_cast<int8_t>(i);
        return table;
    }();
    for (int padding = 0; padding < 2 && !text.empty() && text.back() == '='; ++padding)
        text.remove_suffix(1);
    if (text.size() % 4 == 1)
        return std::nullopt;
    std::vector<uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int value = kValues[static_cast<uint8_t>(c)];
        if (value < 0)
            return std::nullopt;
        bits = bits << 6 | static_cast<uint32_t>(value);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(static_cast<uint8_t>(bits >> held));
        }
    }
    return bytes;
}

} // namespace

bool isDataUri(std::string_view uri) {
    constexpr std::string_view kScheme = "data:";
    return uri.size() >= kScheme.size() &&
           std::equal(kScheme.begin(), kScheme.end(), uri.begin(), [](char a, char b) {
               return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
           });
}

DataUri decodeDataUri(const ImportContext& context, const std::string& place, std::string_view uri) {
    const auto malformed = [&](const char* why) {
        context.fail(place, std::string("the data URI is malformed: ") + why + " (" + shortened(uri) + ")");
    };
    uri.remove_prefix(5);
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos)
        malformed("it has no comma before its data");
    std::string_view head = uri.substr(0, comma);
    const std::string_view payload = uri.substr(comma + 1);

    bool base64 = false;
    DataUri data;
    for (bool first = true; first || !head.empty(); first = false) {
        const size_t end = std::min(head.find(';'), head.size());
        const std::string_view part = head.substr(0, end);
        const bool last = end == head.size();
        if (first)
            data.mediaType = part;
        else if (part == "base64" && last)
            base64 = true;
        else if (part.find('=') == std::string_view::npos)
            malformed("a parameter has no '='");
        head = last ? std::string_view() : head.substr(end + 1);
        if (!last && head.empty())
            malformed("a parameter is empty");
    }
    std::transform(data.mediaType.begin(), data.mediaType.end(), data.mediaType.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });

    // Most payloads have no escapes and are decoded without a copy.
    std::string unescaped;
    std::string_view body = payload;
    if (payload.find('%') != std::string_view::npos) {
        auto decoded = percentDecoded(payload);
        if (!decoded)
            malformed("a percent-escape is not two hexadecimal digits");
        unescaped = std::move(*decoded);
        body = unescaped;
    }
    if (base64) {
        auto bytes = base64Decoded(body);
        if (!bytes)
            malformed("its base64 is broken");
        data.bytes = std::move(*bytes);
    } else {
        data.bytes.assign(body.begin(), body.end());
    }
    return data;
}

std::string dataUriOf(std::string_view mediaType, std::span<const uint8_t> bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string uri = "data:" + std::string(mediaType) + ";base64,";
    uri.reserve(uri.size() + (bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? uint32_t{bytes[i + k]} : 0u);
        for (size_t k = 0; k < 4; ++k)
            uri += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63u];
    }
    return uri;
}

std::filesystem::path resolveUri(const ImportContext& context, const std::string& place,
                                 const std::filesystem::path& folder, std::string_view uri) {
    const auto refuse = [&](const std::string& why) {
        context.fail(place, "the URI \"" + shortened(uri) + "\" " + why, kStayInside);
    };
    if (uri.empty())
        refuse("is empty");
    if (hasScheme(uri))
        refuse("has a scheme; only files in the model's folder and data URIs are read");
    auto decoded = percentDecoded(uri);
    if (!decoded)
        refuse("has a percent-escape that is not two hexadecimal digits");
    std::string path = std::move(*decoded);
    std::replace(path.begin(), path.end(), '\\', '/');
    if (path.find('\0') != std::string::npos)
        refuse("holds a NUL character");
    if (path.front() == '/')
        refuse("is absolute");
    if (hasScheme(path))
        refuse("has a scheme; only files in the model's folder and data URIs are read");
    if (hasParentStep(path))
        refuse("leaves the model's folder");
    return folder / std::filesystem::path(path);
}

} // namespace touchstone
