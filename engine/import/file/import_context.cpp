#include "engine/import/file/import_context.h"

#include <algorithm>
#include <functional>

namespace touchstone {
namespace {

/// `text` with every number replaced by one '#'. Digits at the end of a name ("TEXCOORD_1") are no number.
std::string withoutNumbers(std::string_view text) {
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    const auto isName = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    std::string kind;
    kind.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (!isDigit(text[i]) || (!kind.empty() && (isName(kind.back()) || isDigit(kind.back()))))
            kind.push_back(text[i]);
        else if (kind.empty() || kind.back() != '#')
            kind.push_back('#');
    }
    return kind;
}

} // namespace

void ImportContext::warn(std::string place, const std::string& message) {
    // A flaw found through several paths counts once.
    const std::string whole = place + '\n' + message;
    const size_t hash = std::hash<std::string>()(whole);
    if (told_.contains(hash))
        return;
    if (told_.size() < kMaxRemembered)
        told_.insert(hash);
    const std::string kind = withoutNumbers(whole);
    if (const auto known = kindOf_.find(kind); known != kindOf_.end()) {
        Kind& like = kinds_[known->second];
        ++like.otherCount;
        if (like.others.size() < kListedPlaces)
            like.others.push_back(std::move(place));
        return;
    }
    if (kinds_.size() == kMaxWarnings) {
        ++droppedWarnings_;
        return;
    }
    kindOf_.emplace(kind, kinds_.size());
    kinds_.push_back({{std::move(place), message}, {}, 0});
}

void ImportContext::spendGeometry(uint64_t bytes, const std::string& place) {
    const uint64_t limit = std::max(kFreeGeometryBytes, kGeometryExpansion * fileBytes_);
    if (bytes > limit - geometrySpent_)
        fail(place,
             "the geometry would expand to more than " + std::to_string(limit >> 20) +
                 " MiB, far beyond the file's own data",
             "check the accessors' counts, or split the model into several files");
    geometrySpent_ += bytes;
}

bool ImportContext::spendPixels(uint64_t bytes) {
    const uint64_t limit = std::max(kFreePixelBytes, kPixelExpansion * fileBytes_);
    if (bytes > limit - pixelsSpent_)
        return false;
    pixelsSpent_ += bytes;
    return true;
}

std::vector<Warning> ImportContext::takeWarnings() {
    std::vector<Warning> warnings;
    for (Kind& kind : kinds_) {
        std::string also;
        for (const std::string& place : kind.others)
            if (!place.empty())
                also += (also.empty() ? "" : ", ") + place;
        if (const size_t rest = kind.otherCount - kind.others.size(); rest > 0)
            also += " and " + std::to_string(rest) + " more";
        warnings.push_back(std::move(kind.first));
        if (!also.empty())
            warnings.back().message += " (also " + also + ")";
    }
    if (droppedWarnings_ > 0)
        warnings.push_back({"", "and " + std::to_string(droppedWarnings_) + " more warnings like these"});
    kinds_.clear();
    kindOf_.clear();
    told_.clear();
    droppedWarnings_ = 0;
    return warnings;
}

std::string element(std::string_view array, size_t index) {
    return std::string(array) + "[" + std::to_string(index) + "]";
}

} // namespace touchstone
