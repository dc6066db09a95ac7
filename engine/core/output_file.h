#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace touchstone {

/// A file that exists as a whole or not at all: written under a temporary name beside the target, renamed by
/// `commit`, removed without it. One thread. Every function throws Error that names the target.
class OutputFile {
  public:
    explicit OutputFile(std::filesystem::path target);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    void commit();

  private:
    std::filesystem::path target_, temporary_;
    std::ofstream stream_;
};

/// Writes the whole file at once.
void writeFile(const std::filesystem::path& target, std::string_view text);

} // namespace touchstone
