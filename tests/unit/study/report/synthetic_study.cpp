#include "tests/unit/study/report/synthetic_study.h"

#include "study/report/fields.h"

#include <unistd.h>

#include <atomic>
#include <concepts>
#include <fstream>
#include <limits>
#include <sstream>

namespace touchstone::study::test {

namespace {

/// Gives every field that it visits a value of its own.
class Filler {
  public:
    template <class Value>
    void operator()(std::string_view name, std::string_view, Value& value) {
        if constexpr (requires(Filler f) { visitFields(f, value); })
            visitFields(*this, value);
        else
            fill(std::string(name), value);
    }

  private:
    template <class Element>
    void fill(const std::string& name, std::vector<Element>& values) {
        for (int i = 0; i < 2; ++i)
            (*this)(name, "", values.emplace_back());
    }
    void fill(const std::string&, double& value) { value = 1.0 / ++count_; }
    void fill(const std::string&, bool& value) { value = ++count_ % 2 == 0; }
    void fill(const std::string&, Truth& value) { value = Truth::Reference; }
    void fill(const std::string& name, std::string& value) {
        value = name + " \"" + std::to_string(++count_) + "\", µm\nline";
    }
    template <std::integral Integer>
    void fill(const std::string&, Integer& value) {
        value = std::numeric_limits<Integer>::max() - static_cast<Integer>(++count_);
    }

    int count_ = 6;
};

} // namespace

StudyResult everyField() {
    StudyResult result;
    Filler fill;
    visitFields(fill, result);
    return result;
}

Folder::Folder() {
    static std::atomic<int> number{0};
    path_ = std::filesystem::temp_directory_path() /
            ("touchstone report " + std::to_string(getpid()) + " " + std::to_string(++number));
    std::filesystem::create_directories(path_);
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

} // namespace touchstone::study::test
