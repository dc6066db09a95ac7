#include "engine/import/reader_child/standard_streams.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace touchstone {

std::span<const uint8_t> standardInput() {
    struct stat facts {};
    if (fstat(STDIN_FILENO, &facts) != 0 || facts.st_size <= 0)
        throw std::runtime_error("there is nothing to read");
    const auto size = static_cast<size_t>(facts.st_size);
    void* bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
    if (bytes == MAP_FAILED)
        throw std::runtime_error("the input cannot be mapped");
    return {static_cast<const uint8_t*>(bytes), size};
}

void writeOutput(const void* bytes, size_t size) {
    const auto* const data = static_cast<const char*>(bytes);
    for (size_t at = 0; at < size;) {
        const ssize_t written = write(STDOUT_FILENO, data + at, size - at);
        if (written < 0 && errno != EINTR)
            throw std::runtime_error("the answer cannot be written");
        at += written > 0 ? static_cast<size_t>(written) : 0;
    }
}

void endWith(int status, std::string_view line) {
    lseek(STDOUT_FILENO, 0, SEEK_SET); // over what was written of a file; a pipe keeps it
    [[maybe_unused]] ssize_t written = write(STDOUT_FILENO, line.data(), line.size());
    written = write(STDOUT_FILENO, "\n", 1);
    _exit(status);
}

} // namespace touchstone
