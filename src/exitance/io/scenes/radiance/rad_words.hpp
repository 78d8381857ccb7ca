#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace exitance {

/// Splits a Radiance file into words. '#' at the start of a word begins a comment. A word that begins with ' or " ends
/// at the same mark and may contain blanks. A word that begins with '!' is a command, which extends to the end of its
/// line.
class RadWords {
  public:
    explicit RadWords(std::string_view text) : rest_(text) {}

    /// Returns the next word; empty at the end of the text, or if a quoted word is not closed.
    std::optional<std::string_view> next();
    /// Returns the rest of a command, after a word that begins with '!'. A backslash at the end of a line continues it.
    std::string rest_of_command();
    int line() const { return line_; }  ///< Line of the last word.
    /// The last word was quoted, so its first character has no special meaning.
    bool was_quoted() const { return was_quoted_; }
    bool is_open_quote() const { return open_quote_; }  ///< The text ended within a quoted word.

  private:
    void pass() {
        if (rest_.front() == '\n') ++at_;
        rest_.remove_prefix(1);
    }
    void pass_blanks();

    std::string_view rest_;
    int at_ = 1, line_ = 1;
    bool was_quoted_ = false, open_quote_ = false;
};

/// A primitive of a Radiance file: modifier, type, name and its arguments.
struct RadPrimitive {
    std::string modifier, type, name;
    std::vector<std::string> words;
    std::vector<double> numbers;
    int line = 0;
};

/// Fault of a primitive, with its line.
struct RadFault {
    int line = 0;
    std::string message;
};

/// Reads a primitive after its modifier: type, name, and three lists with counts (for an alias, one word). After a
/// fault, the beginning of the next primitive is unknown.
std::optional<RadFault> read_primitive(RadWords& words, RadPrimitive& out);

}  // namespace exitance
