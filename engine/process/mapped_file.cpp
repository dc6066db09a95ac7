#include "engine/process/mapped_file.h"

#include <sys/mman.h>
#include <sys/stat.h>

#include <utility>

namespace touchstone {

MappedFile::MappedFile(const FileDescriptor& file) {
    struct stat facts {};
    if (fstat(file.get(), &facts) != 0 || facts.st_size <= 0)
        return;
    const auto size = static_cast<size_t>(facts.st_size);
    void* const bytes = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
    if (bytes != MAP_FAILED)
        bytes_ = {static_cast<const uint8_t*>(bytes), size};
}

MappedFile::~MappedFile() {
    if (!bytes_.empty())
        munmap(const_cast<uint8_t*>(bytes_.data()), bytes_.size());
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
}

} // namespace touchstone
