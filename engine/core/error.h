#pragma once

#include <stdexcept>
#include <string>

namespace touchstone {

/// Bad input or a missing facility, reported so that the user can act: what, where in it, and the remedy. The
/// program prints `what()` and exits with status 1. Never thrown by code that the servo calls.
class Error : public std::runtime_error {
  public:
    /// `file`: the file or facility; `place`: the spot in it ("meshes[2].primitives[0]"), may be empty;
    /// `problem`: what is wrong; `remedy`: what the user can do about it, may be empty.
    Error(std::string file, std::string place, std::string problem, std::string remedy)
        : std::runtime_error(compose(file, place, problem, remedy)), file_(std::move(file)),
          place_(std::move(place)), problem_(std::move(problem)), remedy_(std::move(remedy)) {}

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] const std::string& problem() const { return problem_; }
    [[nodiscard]] const std::string& remedy() const { return remedy_; }

  private:
    static std::string compose(const std::string& file, const std::string& place, const std::string& problem,
                               const std::string& remedy) {
        std::string text = file;
        if (!place.empty())
            text += ": " + place;
        text += ": " + problem;
        if (!remedy.empty())
            text += "\n  remedy: " + remedy;
        return text;
    }

    std::string file_, place_, problem_, remedy_;
};

} // namespace touchstone
