#pragma once

#include "tests/support/kept_environment.h"
#include "tests/support/program.h"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace touchstone::test {

/// A folder with programs of the shell in it, which is all of PATH but for the system's own during its life;
/// the environment is as before at its end.
class Scripts {
  public:
    Scripts() {
        setenv("PATH", (folder_.path().string() + ":/usr/bin:/bin").c_str(), 1);
        unsetenv("TOUCHSTONE_FILE_DIALOG");
        unsetenv("XDG_CURRENT_DESKTOP");
        unsetenv("XDG_RUNTIME_DIR"); // no portal
        unsetenv("DBUS_SESSION_BUS_ADDRESS");
    }
    Scripts(const Scripts&) = delete;
    Scripts& operator=(const Scripts&) = delete;

    std::filesystem::path add(const std::string& name, const std::string& text) {
        const std::filesystem::path file = folder_ / name;
        writeTextFile(file, "#!/bin/sh\n" + text + "\n");
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
        return file;
    }

  private:
    KeptEnvironment kept_;
    ScratchFolder folder_;
};

} // namespace touchstone::test
