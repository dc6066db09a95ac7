#include "engine/save/replace_file.h"

#include "engine/core/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

namespace touchstone {

namespace {

/// A file under a temporary name, deleted unless it is renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& target) : target_(target.string()) {
        int number = 0;
        do {
            name_ = target_ + "." + std::to_string(getpid()) + "-" + std::to_string(number++) + ".part";
            descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        } while (descriptor_ < 0 && errno == EEXIST && number < 1000);
        if (descriptor_ < 0) // nothing to clean up
            fail("cannot be written", "check the folder's permissions, or save under another name");
    }
    ~TemporaryFile() {
        if (descriptor_ >= 0)
            close(descriptor_);
        if (!renamed_ && !name_.empty())
            unlink(name_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::span<const uint8_t> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR)
                continue;
            if (written < 0)
                fail("could not be written to its end", "free some space on the disk");
            bytes = bytes.subspan(static_cast<size_t>(written));
        }
    }

    void takeTheTargetsPlace() {
        struct stat there {};
        const bool replaces = stat(target_.c_str(), &there) == 0;
        if ((replaces && fchmod(descriptor_, there.st_mode & 07777) != 0) || fsync(descriptor_) != 0)
            fail("could not be written to its end", "free some space on the disk");
        if (rename(name_.c_str(), target_.c_str()) != 0)
            fail("cannot be replaced", "save under another name");
        renamed_ = true;
        // Makes the new name survive a power failure; where the folder cannot be synchronised the name exists
        // anyway.
        const std::filesystem::path parent = std::filesystem::path(target_).parent_path();
        const int folder = open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder >= 0) {
            (void)fsync(folder);
            (void)close(folder);
        }
    }

  private:
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) {
        const std::string why = std::strerror(errno); // the destructor cleans up
        throw Error(target_, "", problem + ": " + why + "; nothing was changed", remedy);
    }

    std::string target_, name_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

} // namespace

void replaceFile(const std::filesystem::path& target, std::span<const uint8_t> bytes) {
    std::error_code ignored;
    std::filesystem::path real = std::filesystem::weakly_canonical(target, ignored);
    if (real.empty())
        real = target;
    struct stat there {};
    if (stat(real.c_str(), &there) == 0) {
        if (!S_ISREG(there.st_mode))
            throw Error(target.string(), "", "is not a file", "save under another name");
        if (access(real.c_str(), W_OK) != 0)
            throw Error(target.string(), "", std::string("cannot be written: ") + std::strerror(errno),
                        "make it writable, or save under another name");
    }
    TemporaryFile file(real);
    file.write(bytes);
    file.takeTheTargetsPlace();
}

} // namespace touchstone
