#include "engine/scene/import/import_context.h"

#include <algorithm>

namespace touchstone {

void ImportContext::warn(std::string place, std::string message) {
    // The same flaw met from several places is one flaw.
    for (const Warning& known : warnings_)
        if (known.place == place && known.message == message)
            return;
    if (warnings_.size() < kMaxWarnings)
        warnings_.push_back({std::move(place), std::move(message)});
    else
        ++droppedWarnings_;
}

void ImportContext::stopIfCancelled() const {
    if (options_.cancel != nullptr && options_.cancel->load(std::memory_order_relaxed))
        throw Error(file_, "", "cancelled", "");
}

void ImportContext::step(double fraction, const char* what) const {
    stopIfCancelled();
    if (options_.progress)
        options_.progress(fraction, what);
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
    if (droppedWarnings_ > 0)
        warnings_.push_back({"", "and " + std::to_string(droppedWarnings_) + " more warnings like these"});
    droppedWarnings_ = 0;
    return std::move(warnings_);
}

std::string element(std::string_view array, size_t index) {
    return std::string(array) + "[" + std::to_string(index) + "]";
}

} // namespace touchstone
