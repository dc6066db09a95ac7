// touchstone_file_portal open|save TITLE FOLDER NAME ["KIND | PATTERN PATTERN ..."]...: asks for a file by
// the desktop's portal and writes its path to standard output. Status 0: chosen, 1: cancelled, 2: it failed,
// 3: there is no portal. A process of its own: libdbus is not in the workbench, and a portal that hangs is
// ended with this.

#include "workbench/dialog/portal/file_chooser.h"

#include <cstdio>
#include <sstream>
#include <string_view>

int main(int count, char** arguments) {
    using touchstone::ChooserAnswer, touchstone::ChooserFilter;
    const std::string_view purpose = count > 4 ? arguments[1] : "";
    if (purpose != "open" && purpose != "save") {
        std::fputs("usage: touchstone_file_portal open|save TITLE FOLDER NAME [\"KIND | PATTERN ...\"]...\n",
                   stderr);
        return 2;
    }
    touchstone::ChooserRequest request{purpose == "save", arguments[2], arguments[3], arguments[4], {}};
    for (int i = 5; i < count; ++i) {
        const std::string_view text = arguments[i];
        const size_t bar = text.find(" | ");
        if (bar == std::string_view::npos)
            continue;
        ChooserFilter filter{std::string(text.substr(0, bar)), {}};
        std::istringstream patterns{std::string(text.substr(bar + 3))};
        for (std::string pattern; patterns >> pattern;)
            filter.patterns.push_back(pattern);
        request.filters.push_back(std::move(filter));
    }
    const ChooserAnswer answer = touchstone::askPortal(request);
    if (answer.end == ChooserAnswer::End::Chosen)
        std::puts(answer.path.c_str());
    return static_cast<int>(answer.end);
}
