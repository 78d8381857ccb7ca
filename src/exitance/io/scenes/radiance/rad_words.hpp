#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace exitance {

/// Words of a Radiance file. '#' at the start of one begins a comment. A word that begins with ' or " goes on to the
/// same sign, blanks included. A word that begins with '!' is a command, which takes the rest of its line.
class RadWords {
  public:
    explicit RadWords(std::string_view text) : rest_(text) {}

    /// Nothing at the end, or where a quoted word has no end.
    std::optional<std::string_view> next();
    /// After a word that begins with '!': the rest of the command, a backslash at the end of a line going on.
    std::string rest_of_command();
    int line() const { return line_; }                  ///< Of the last word.
    bool was_quoted() const { return was_quoted_; }     ///< The last word: what it begins with means nothing.
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

/// What is wrong with a primitive, and where.
struct RadFault {
    int line = 0;
    std::string message;
};

/// Reads what follows a modifier: type, name and three counted lists, of an alias one word. Where the next primitive
/// begins is not known after a fault.
std::optional<RadFault> read_primitive(RadWords& words, RadPrimitive& out);

}  // namespace exitance
