#include "study/report/plots/gnuplot.h"

#include "engine/core/output_file.h"
#include "engine/process/process_answer.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

namespace touchstone::study {

namespace {

/// Runs a program of the search path in `folder` to its end, its output and its errors as one text. A
/// gnuplot that waits for ever (a terminal that asks) is ended: nobody's end of work waits for a figure.
ProcessAnswer run(std::vector<std::string> words, const std::filesystem::path& folder) {
    std::vector<std::string> arguments{"sh", "-c", "cd -- \"$1\" && shift && exec \"$@\" 2>&1", "sh",
                                       std::filesystem::absolute(folder).string()};
    std::ranges::move(words, std::back_inserter(arguments));
    constexpr uint64_t kMostSaid = uint64_t{1} << 20;
    return askProcess("/bin/sh", arguments, {.processorSeconds = 60, .seconds = 60}, FileDescriptor(),
                      kMostSaid, [] { return false; });
}

/// Fallback fonts where Inter is not installed; gnuplot takes one name only.
std::string withFallback(std::string svg) {
    const std::string from = "font-family=\"Inter\"",
                      to = "font-family=\"Inter, Helvetica, Arial, sans-serif\"";
    for (size_t at = 0; (at = svg.find(from, at)) != std::string::npos; at += to.size())
        svg.replace(at, from.size(), to);
    return svg;
}

} // namespace

std::string draw(const Figure& figure, const std::filesystem::path& folder, const std::string& program,
                 PlotFormat format) {
    const bool png = format == PlotFormat::Png;
    if (std::ranges::any_of(figure.name, [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
        return (folder / "a figure").string() +
               ": not drawn, its name holds a control character\n  remedy: give it another";
    writeFile(folder / (figure.name + ".gp"), figure.script);
    writeFile(folder / (figure.name + ".dat"), figure.data);
    // Each name is a path to gnuplot: '-' alone begins an option, '<' and '|' a command.
    const std::string part = ".figure.part" + std::to_string(getpid());
    const ProcessAnswer answer =
        run({program, "--default-settings", "-e", "out = '" + part + (png ? "'; png = 3" : "'"),
             "./" + figure.name + ".gp"},
            folder.empty() ? "." : folder);
    using enum ProcessAnswer::End;
    const std::string said(answer.output.begin(), answer.output.end());
    std::ostringstream drawn;
    drawn << std::ifstream(folder / part, std::ios::binary).rdbuf();
    std::error_code ignored;
    std::filesystem::remove(folder / part, ignored);
    const std::string file = (folder / (figure.name + (png ? ".png" : ".svg"))).string();
    if (answer.end == NotStarted)
        return file + ": not drawn, gnuplot does not start: " + said +
               "\n  remedy: apt-get install gnuplot-nox, then gnuplot " + figure.name + ".gp in that folder";
    if (answer.end == TooSlow)
        return file + ": not drawn, gnuplot did not end within a minute\n  remedy: look at " + figure.name +
               ".gp beside it";
    constexpr std::string_view kPngEnd = "IEND"; // of the last chunk, before its sum
    const bool whole = drawn.str().find(png ? kPngEnd : "</svg>") != std::string::npos;
    if (answer.end != Exited || answer.status != 0 || !whole)
        return file + ": not drawn, gnuplot said: " + said + "\n  remedy: look at " + figure.name +
               ".gp beside it";
    writeFile(file, png ? drawn.str() : withFallback(drawn.str()));
    return "";
}

} // namespace touchstone::study
