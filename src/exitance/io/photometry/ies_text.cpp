#include "exitance/io/photometry/ies_text.hpp"

#include <fmt/format.h>

namespace exitance {

Result<double> IesText::number(const std::string& what) {
    skip_blanks();
    if (rest_.empty() || rest_[0] == '\x1a') return error(fmt::format("ends before {}", what), "is the file complete?");
    const std::string_view word = rest_.substr(0, std::min(rest_.find_first_of(blanks), rest_.size()));
    double value = 0;
    switch (number_of_word(word, value)) {
        case NumberKind::finite:
            break;
        case NumberKind::not_finite:
            return error(fmt::format("'{}' is not finite (expected: {})", shown(word), what));
        case NumberKind::not_a_number:
            return error(fmt::format("'{}' is not a number (expected: {})", shown(word), what));
    }
    rest_.remove_prefix(word.size());
    return value;
}

Error IesText::error(std::string message, std::string hint) const {
    return {ErrorCode::bad_input, std::move(message), fmt::format("{}:{}", name_, line_), std::move(hint)};
}

}  // namespace exitance
