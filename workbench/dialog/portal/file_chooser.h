#pragma once
// The file chooser of xdg-desktop-portal, interface org.freedesktop.portal.FileChooser, over the session's
// D-Bus.

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

/// A kind of files: its name and the patterns of its files' names, "*.glb".
struct ChooserFilter {
    std::string name;
    std::vector<std::string> patterns;
};

struct ChooserRequest {
    bool saves = false;
    std::string title, folder, name; ///< `name`: suggested, of a file to be saved
    std::vector<ChooserFilter> filters;
};

struct ChooserAnswer {
    enum class End : uint8_t {
        Chosen, ///< `path`; the numbers are the statuses of touchstone_file_portal
        Cancelled,
        Failed, ///< it was asked, and then went away or answered with something that is no file
        Absent, ///< no session bus, or nobody on it who shows a file chooser
    };
    End end = End::Absent;
    std::string path; ///< absolute
};

/// Waits for the person who is asked. The portal takes its dialog away when the process ends.
[[nodiscard]] ChooserAnswer askPortal(const ChooserRequest& request);

} // namespace touchstone
