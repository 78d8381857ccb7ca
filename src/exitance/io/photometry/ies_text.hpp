#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "exitance/base/result.hpp"
#include "exitance/io/files/text_lines.hpp"

namespace exitance {

/// Splits a text into lines that end with LF, CR LF or CR, and into numbers separated by blanks, commas or line ends.
class IesText {
  public:
    IesText(std::string_view text, const std::string& name) : rest_(text), name_(name) {
        if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // skip the byte order mark
    }

    std::optional<std::string_view> line() {
        if (rest_.empty()) return std::nullopt;
        const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        const std::string_view out = rest_.substr(0, end);
        rest_.remove_prefix(end);
        take_line_end();
        return out;
    }

    /// Returns the next number. Error: it is missing or malformed; `what` names it in the message.
    Result<double> number(const std::string& what);

    /// True if only blanks are left.
    bool at_end() {
        skip_blanks();
        return rest_.empty() || rest_[0] == '\x1a';
    }
    std::size_t bytes_left() const { return rest_.size(); }
    int line_number() const { return line_; }
    Error error(std::string message, std::string hint = "") const;

  private:
    static constexpr const char* blanks = " \t,\r\n\x1a\f\v";

    void take_line_end() {
        if (rest_.empty()) return;
        rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
        ++line_;
    }
    void skip_blanks() {
        while (!rest_.empty() && rest_[0] != '\x1a' &&
               std::string_view(blanks).find(rest_[0]) != std::string_view::npos) {
            if (rest_[0] == '\r' || rest_[0] == '\n')
                take_line_end();
            else
                rest_.remove_prefix(1);
        }
    }

    std::string_view rest_;
    const std::string& name_;
    int line_ = 1;
};

}  // namespace exitance
