#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace exitance {

/// The lines of a text that is held whole, as OBJ and MTL understand them: LF, CRLF or CR, a backslash at the end goes
/// on, '#' at the start of a word begins a comment. Lines are handed out one at a time, without blanks at both ends.
class TextLines {
  public:
    explicit TextLines(std::string_view text) : rest_(text) {
        if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);  // byte order mark
    }

    /// Moves to the next line that holds something; false at the end.
    bool next();
    /// The words of the line that have not been taken yet.
    std::string_view rest() const { return line_; }
    /// Takes a word; empty when there is none left.
    std::string_view word();
    /// Where the line stands in the text; the first is 1.
    int number() const { return number_; }

  private:
    bool take_physical_line(std::string_view& out);

    std::string_view rest_, line_;
    std::string joined_;
    int number_ = 0, physical_ = 0;
};

/// A piece of a file as a message may show it: shortened when long, bytes that are no text as '?'.
std::string shown(std::string_view text);

/// What a word says as a number. Finite numbers only: "nan" and what exceeds the range of double has none.
enum class NumberKind { finite, not_finite, not_a_number };
NumberKind number_of_word(std::string_view word, double& value);

/// A whole number, with a sign or without.
std::optional<long long> parse_integer(std::string_view word);

}  // namespace exitance
