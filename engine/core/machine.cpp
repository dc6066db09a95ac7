#include "engine/core/machine.h"

#include <cpuid.h>
#include <elf.h>
#include <link.h>

#include <array>
#include <cstring>
#include <string_view>

namespace touchstone {

namespace {

/// The note of type NT_GNU_BUILD_ID among the notes from `at` on, hexadecimal.
std::string buildNote(const char* at, size_t left) {
    const auto padded = [](size_t size) { return (size + 3) & ~size_t{3}; };
    while (left >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) note;
        std::memcpy(&note, at, sizeof note);
        const size_t name = padded(note.n_namesz), size = sizeof note + name + padded(note.n_descsz);
        if (size > left)
            break;
        if (note.n_type == NT_GNU_BUILD_ID && std::string_view(at + sizeof note, 3) == "GNU") {
            std::string text;
            for (size_t i = 0; i < note.n_descsz; ++i) {
                const auto byte = static_cast<unsigned char>(at[sizeof note + name + i]);
                constexpr std::string_view kDigits = "0123456789abcdef";
                text += kDigits[byte >> 4];
                text += kDigits[byte & 15];
            }
            return text;
        }
        at += size;
        left -= size;
    }
    return {};
}

} // namespace

std::string buildIdentity() {
    std::string identity;
    dl_iterate_phdr(
        [](dl_phdr_info* info, size_t, void* out) {
            for (int i = 0; i < info->dlpi_phnum; ++i) {
                const ElfW(Phdr)& header = info->dlpi_phdr[i];
                if (header.p_type != PT_NOTE)
                    continue;
                const std::string found = buildNote(
                    reinterpret_cast<const char*>(info->dlpi_addr + header.p_vaddr), header.p_memsz);
                if (!found.empty())
                    *static_cast<std::string*>(out) = found;
            }
            return 1; // the executable comes first
        },
        &identity);
    return identity.empty() ? "unknown" : identity;
}

std::string compilerName() {
#if defined(__clang__)
    return "clang " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

std::string processorName() {
    std::array<unsigned, 12> words{};
    unsigned most = 0, ignored = 0;
    if (__get_cpuid(0x80000000u, &most, &ignored, &ignored, &ignored) == 0 || most < 0x80000004u)
        return "unknown";
    for (unsigned i = 0; i < 3; ++i)
        __get_cpuid(0x80000002u + i, &words[4 * i], &words[4 * i + 1], &words[4 * i + 2], &words[4 * i + 3]);
    std::array<char, sizeof words + 1> text{};
    std::memcpy(text.data(), words.data(), sizeof words);
    std::string name(text.data());
    const size_t first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
    return first == std::string::npos ? "unknown" : name.substr(first, last - first + 1);
}

} // namespace touchstone
