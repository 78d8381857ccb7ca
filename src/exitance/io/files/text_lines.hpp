#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace exitance {

/// Splits a text in memory into lines, by the rules of OBJ and MTL: lines end with LF, CRLF or CR, a backslash at the
/// end continues a line, and '#' at the start of a word begins a comment. Lines are returned one at a time, without
/// blanks at both ends.
class TextLines {
  public:
    explicit TextLines(std::string_view text) : rest_(text) {
        if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // skip the byte order mark
    }

    /// Moves to the next line that is not empty; false at the end.
    bool next();
    /// Returns the words of the line that have not been taken.
    std::string_view rest() const { return line_; }
    /// Takes the next word; empty at the end of the line.
    std::string_view word();
    /// Number of the current line in the text, from 1.
    int number() const { return number_; }

  private:
    bool take_physical_line(std::string_view& out);

    std::string_view rest_, line_;
    std::string joined_;
    int number_ = 0, physical_ = 0;
};

/// Prepares a piece of a file for a message: shortens long text and replaces bytes that are not UTF-8 by '?'.
std::string shown(std::string_view text);

/// Parses a word as a number. "nan" and numbers beyond the range of double are `not_finite`.
enum class NumberKind { finite, not_finite, not_a_number };
NumberKind number_of_word(std::string_view word, double& value);

/// Parses a whole number with an optional sign.
std::optional<long long> parse_integer(std::string_view word);

}  // namespace exitance
