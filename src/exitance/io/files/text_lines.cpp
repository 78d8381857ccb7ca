#include "exitance/io/files/text_lines.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace exitance {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v' || c == '\0';
}

std::string_view trimmed(std::string_view s) {
    while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
    while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
    return s;
}

std::string_view without_comment(std::string_view s) {
    for (std::size_t i = s.find('#'); i != s.npos; i = s.find('#', i + 1))
        if (i == 0 || is_blank(s[i - 1])) return s.substr(0, i);
    return s;
}

}  // namespace

bool TextLines::take_physical_line(std::string_view& out) {
    if (rest_.empty()) return false;
    ++physical_;
    const std::size_t end = rest_.find_first_of("\n\r");
    out = rest_.substr(0, end);
    if (end == rest_.npos) return rest_ = {}, true;
    const bool pair = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
    rest_.remove_prefix(end + (pair ? 2 : 1));
    return true;
}

bool TextLines::next() {
    std::string_view physical;
    while (take_physical_line(physical)) {
        number_ = physical_;
        line_ = trimmed(without_comment(physical));
        if (!line_.empty() && line_.back() == '\\') {
            joined_.assign(line_);
            while (!joined_.empty() && joined_.back() == '\\' && take_physical_line(physical)) {
                joined_.back() = ' ';
                joined_ += trimmed(without_comment(physical));
            }
            while (!joined_.empty() && joined_.back() == '\\') joined_.pop_back();
            line_ = trimmed(joined_);
        }
        if (!line_.empty()) return true;
    }
    return false;
}

std::string_view TextLines::word() {
    std::size_t n = 0;
    while (n < line_.size() && !is_blank(line_[n])) ++n;
    const std::string_view out = line_.substr(0, n);
    while (n < line_.size() && is_blank(line_[n])) ++n;
    line_.remove_prefix(n);
    return out;
}

std::string shown(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string out;
    for (std::size_t i = 0; i < text.size() && out.size() < longest;) {
        const auto byte = [&](std::size_t k) {
            return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u;
        };
        // UTF-8: the first byte determines how many of the form 10xxxxxx follow.
        const unsigned first = byte(0);
        std::size_t length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
        bool good = first >= 0x20 && first != 0x7f && (first < 0x80 || (first >= 0xc2 && first <= 0xf4));
        for (std::size_t k = 1; k < length; ++k) good = good && (byte(k) & 0xc0u) == 0x80;
        if (length == 3) good = good && !(first == 0xe0 && byte(1) < 0xa0) && !(first == 0xed && byte(1) >= 0xa0);
        if (length == 4) good = good && !(first == 0xf0 && byte(1) < 0x90) && !(first == 0xf4 && byte(1) >= 0x90);
        if (!good) length = 1;
        out += good ? text.substr(i, length) : std::string_view("?");
        i += length;
    }
    return out.size() < text.size() && out.size() >= longest ? out + "..." : out;
}

NumberKind number_of_word(std::string_view word, double& value) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || end != word.data() + word.size() || error == std::errc::invalid_argument)
        return NumberKind::not_a_number;
    // The result is also out of range if the number is too small: strtod() then returns zero.
    if (error == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
    return std::isfinite(value) ? NumberKind::finite : NumberKind::not_finite;
}

std::optional<long long> parse_integer(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    long long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || end != word.data() + word.size() || error != std::errc()) return std::nullopt;
    return value;
}

}  // namespace exitance
