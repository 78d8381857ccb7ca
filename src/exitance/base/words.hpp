#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace exitance {

/// Splits text at blanks; words in single or double quotes may contain blanks.
std::vector<std::string> split_words(const std::string& text);
/// Splits text at commas. An empty text is one empty part, and a comma at the end is followed by one.
std::vector<std::string> split_at_commas(const std::string& text);
/// Returns the quote that `text` opens and does not close, as split_words() reads it; 0 if there is none.
char open_quote(const std::string& text);
/// Joins words so that a shell reads them as `words`: words with other than plain characters are in single quotes.
std::string shell_text(const std::vector<std::string>& words);
/// Returns `text` without spaces, tabs and line ends at both ends.
std::string_view without_blanks(std::string_view text);
/// Returns `text` without blanks as above and double quotes at both ends.
std::string_view without_quotes(std::string_view text);
/// Returns a text as a JSON string, with quotation marks. Text that is not UTF-8 is read as Latin-1.
std::string json_text(std::string_view text);
/// Replaces "{name}" in `text` for all names.
std::string filled_in(std::string text, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace exitance
