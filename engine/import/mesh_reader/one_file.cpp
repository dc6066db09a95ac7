#include "engine/import/mesh_reader/one_file.h"

#include <algorithm>
#include <cstring>

namespace touchstone {

namespace {

class MemoryStream final : public Assimp::IOStream {
  public:
    explicit MemoryStream(std::span<const uint8_t> bytes) : bytes_(bytes) {}

    size_t Read(void* buffer, size_t size, size_t count) override {
        const size_t whole = size == 0 ? 0 : std::min(count, (bytes_.size() - at_) / size);
        if (whole > 0) {
            std::memcpy(buffer, bytes_.data() + at_, whole * size);
            at_ += whole * size;
        }
        return whole;
    }
    size_t Write(const void*, size_t, size_t) override { return 0; }
    aiReturn Seek(size_t offset, aiOrigin origin) override {
        const size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        // Offsets are unsigned, so only forward from the begin and from here; from the end backward.
        const size_t target = origin == aiOrigin_END ? from - std::min(from, offset) : from + offset;
        if (target > bytes_.size() || target < from - std::min(from, offset))
            return aiReturn_FAILURE;
        at_ = target;
        return aiReturn_SUCCESS;
    }
    size_t Tell() const override { return at_; }
    size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

  private:
    std::span<const uint8_t> bytes_;
    size_t at_ = 0;
};

} // namespace

Assimp::IOStream* OneFile::Open(const char* file, const char* mode) {
    const bool reading = mode != nullptr && mode[0] == 'r';
    return reading && Exists(file) ? new MemoryStream(bytes_) : nullptr;
}

} // namespace touchstone
