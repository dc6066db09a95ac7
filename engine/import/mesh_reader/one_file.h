#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace touchstone {

/// A file system with one file in it, whose bytes are in memory. Whatever else a model refers to (a material
/// library, a picture) does not exist.
class OneFile final : public Assimp::IOSystem {
  public:
    OneFile(std::string name, std::span<const uint8_t> bytes) : name_(std::move(name)), bytes_(bytes) {}

    bool Exists(const char* file) const override { return file != nullptr && name_ == file; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* mode) override;
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    std::string name_;
    std::span<const uint8_t> bytes_;
};

} // namespace touchstone
