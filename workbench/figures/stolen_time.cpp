#include "workbench/figures/stolen_time.h"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

namespace touchstone {

std::optional<unsigned long long> StolenTime::parse(std::string_view stat) {
    // "cpu  user nice system idle iowait irq softirq steal ...": the first line is the sum over all.
    std::istringstream line{std::string(stat.substr(0, stat.find('\n')))};
    std::string name;
    unsigned long long value = 0;
    if (!(line >> name) || name != "cpu")
        return {};
    constexpr int kSteal = 8;
    for (int i = 0; i < kSteal; ++i)
        if (!(line >> value))
            return {};
    return value;
}

std::optional<double> StolenTime::now() {
    std::ifstream file("/proc/stat");
    std::string line;
    std::getline(file, line);
    const auto ticks = parse(line);
    const long rate = sysconf(_SC_CLK_TCK);
    if (!ticks || rate <= 0)
        return {};
    return static_cast<double>(*ticks) / static_cast<double>(rate);
}

std::optional<double> StolenTime::seconds() const {
    const std::optional<double> end = now();
    if (!start_ || !end)
        return {};
    return *end - *start_;
}

} // namespace touchstone
