#pragma once

#include <unistd.h>

#include <cstdlib>
#include <map>
#include <string>

namespace touchstone::test {

/// Brings this process's environment back to what it was at its beginning: cases that run in one process
/// share it.
class KeptEnvironment {
  public:
    KeptEnvironment() : before_(now()) {}
    ~KeptEnvironment() {
        for (const auto& [name, value] : now())
            if (!before_.contains(name))
                ::unsetenv(name.c_str());
        for (const auto& [name, value] : before_)
            ::setenv(name.c_str(), value.c_str(), 1);
    }
    KeptEnvironment(const KeptEnvironment&) = delete;
    KeptEnvironment& operator=(const KeptEnvironment&) = delete;

  private:
    static std::map<std::string, std::string> now() {
        std::map<std::string, std::string> variables;
        for (char** each = environ; *each != nullptr; ++each) {
            const std::string variable = *each;
            const size_t equals = variable.find('=');
            if (equals != std::string::npos)
                variables[variable.substr(0, equals)] = variable.substr(equals + 1);
        }
        return variables;
    }

    std::map<std::string, std::string> before_;
};

} // namespace touchstone::test
