#include "engine/save/json_parts.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace touchstone {

namespace {

using nlohmann::json;

/// Counts how far the parser has read. After a bracket, a key or a string the count is just behind it; after
/// a number it may be one further.
struct CountingIterator {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at = nullptr;
    size_t* consumed = nullptr;

    reference operator*() const { return *at; }
    CountingIterator& operator++() {
        ++at;
        ++*consumed;
        return *this;
    }
    CountingIterator operator++(int) {
        const CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at == other.at; }
    bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

/// Records the children of the outermost value.
class PartFinder : public json::json_sax_t {
  public:
    PartFinder(std::string_view text, const size_t& consumed) : text_(text), consumed_(consumed) {}

    bool null() override { return scalar(); }
    bool boolean(bool) override { return scalar(); }
    bool number_integer(number_integer_t) override { return scalar(); }
    bool number_unsigned(number_unsigned_t) override { return scalar(); }
    bool number_float(number_float_t, const string_t&) override { return scalar(); }
    bool string(string_t&) override {
        if (depth_ == 1)
            add(valueBegin(), consumed_);
        return true;
    }
    bool binary(binary_t&) override { return true; }
    bool key(string_t& name) override {
        if (depth_ == 1) {
            keyBegin_ = valueBegin();
            key_ = name;
            cursor_ = consumed_;
        }
        return true;
    }
    bool start_object(size_t) override { return open(); }
    bool start_array(size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;
    }

    std::vector<JsonPart> parts;

  private:
    /// The position after any characters between the preceding token and a child's value.
    [[nodiscard]] size_t valueBegin() const {
        return std::min(text_.find_first_not_of(" \t\r\n,:", cursor_), text_.size());
    }
    void add(size_t begin, size_t end) {
        parts.push_back({std::move(key_), keyBegin_.value_or(begin), begin, end});
        key_.clear();
        keyBegin_.reset();
        cursor_ = end;
    }
    bool scalar() {
        if (depth_ != 1)
            return true;
        const size_t begin = valueBegin();
        add(begin, std::min(text_.find_first_of(",]} \t\r\n", begin), text_.size()));
        return true;
    }
    bool open() {
        if (depth_ == 0)
            cursor_ = consumed_;
        else if (depth_ == 1)
            begin_ = valueBegin();
        ++depth_;
        return true;
    }
    bool close() {
        if (--depth_ == 1)
            add(begin_, consumed_);
        return true;
    }

    std::string_view text_;
    const size_t& consumed_;
    int depth_ = 0;
    size_t cursor_ = 0; // after the last token processed
    size_t begin_ = 0;
    std::optional<size_t> keyBegin_;
    std::string key_;
};

class KeyCounter : public json::json_sax_t {
  public:
    explicit KeyCounter(std::string_view wanted) : wanted_(wanted) {}
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool key(string_t& name) override {
        count += name == wanted_ ? 1 : 0;
        return true;
    }
    bool start_object(size_t) override { return true; }
    bool start_array(size_t) override { return true; }
    bool end_object() override { return true; }
    bool end_array() override { return true; }
    bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;
    }
    size_t count = 0;

  private:
    std::string_view wanted_;
};

/// `text` with [from, to) replaced.
std::string spliced(std::string_view text, size_t from, size_t to, std::string_view by) {
    std::string result;
    result.reserve(text.size() - (to - from) + by.size());
    result.append(text.substr(0, from)).append(by).append(text.substr(to));
    return result;
}

/// Inserts after the last child, or after the opening bracket where there is none; `item` gets the white
/// space that precedes the last child.
std::string appended(std::string_view text, const std::vector<JsonPart>& parts, const std::string& item) {
    if (parts.empty()) {
        const size_t open = text.find_first_of("{[");
        const size_t close = text.find_last_of("}]");
        return spliced(text, open + 1, close, item);
    }
    const JsonPart& last = parts.back();
    const size_t before = text.find_last_not_of(" \t\r\n", last.keyBegin - 1) + 1;
    const std::string gap(text.substr(before, last.keyBegin - before));
    return spliced(text, last.end, last.end, "," + gap + item);
}

std::string without(std::string_view text, const std::vector<JsonPart>& parts, size_t index) {
    if (parts.size() == 1)
        return spliced(text, text.find_first_of("{[") + 1, text.find_last_of("}]"), "");
    if (index == 0)
        return spliced(text, parts[0].keyBegin, parts[1].keyBegin, "");
    return spliced(text, parts[index - 1].end, parts[index].end, "");
}

std::string quoted(std::string_view text) {
    return json(text).dump();
}

} // namespace

std::vector<JsonPart> jsonParts(std::string_view text) {
    size_t consumed = 0;
    PartFinder finder(text, consumed);
    const char* const end = text.data() + text.size();
    json::sax_parse(CountingIterator{text.data(), &consumed}, CountingIterator{end, &consumed}, &finder);
    return std::move(finder.parts);
}

std::optional<JsonPart> jsonMember(std::string_view text, std::string_view key) {
    std::vector<JsonPart> parts = jsonParts(text);
    const auto found =
        std::find_if(parts.rbegin(), parts.rend(), [&](const JsonPart& part) { return part.key == key; });
    return found == parts.rend() ? std::nullopt : std::optional(std::move(*found));
}

std::string withMember(std::string_view text, std::string_view key, std::string_view value) {
    if (const auto member = jsonMember(text, key))
        return spliced(text, member->begin, member->end, value);
    const std::vector<JsonPart> parts = jsonParts(text);
    const bool spaced = !parts.empty() && parts.back().begin > 0 && text[parts.back().begin - 1] == ' ';
    return appended(text, parts, quoted(key) + (spaced ? ": " : ":") + std::string(value));
}

std::string withoutMember(std::string_view text, std::string_view key) {
    std::string result(text);
    for (;;) {
        const std::vector<JsonPart> parts = jsonParts(result);
        const auto found = std::find_if(parts.begin(), parts.end(), [&](const JsonPart& part) {
            if (part.keyBegin != part.begin)
                return part.key == key;
            const json element = json::parse(part.of(result), nullptr, false);
            return element.is_string() && element == key;
        });
        if (found == parts.end())
            return result;
        result = without(result, parts, static_cast<size_t>(found - parts.begin()));
    }
}

std::string withElement(std::string_view text, std::string_view value) {
    return appended(text, jsonParts(text), std::string(value));
}

size_t countKeys(std::string_view text, std::string_view key) {
    KeyCounter counter(key);
    json::sax_parse(text.begin(), text.end(), &counter);
    return counter.count;
}

} // namespace touchstone
