#include "exitance/methods/options/value_kinds.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace exitance::option_values {

std::optional<double> number_in(const std::string& word) {
    double value = 0;
    const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return {};
    return value;
}

std::optional<std::size_t> bytes_in(std::string word) {
    for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const std::size_t digits = std::min(word.find_first_not_of("0123456789."), word.size());
    const std::optional<double> value = number_in(word.substr(0, digits));
    const std::string unit = word.substr(digits);
    constexpr std::array<std::string_view, 5> prefixes{"", "K", "M", "G", "T"};
    const auto prefix = std::find_if(prefixes.begin(), prefixes.end(), [&](std::string_view p) {
        return unit == p || unit == std::string(p) + "B" || (!p.empty() && unit == std::string(p) + "IB");
    });
    if (!value || prefix == prefixes.end()) return {};
    const double bytes = std::ldexp(*value, static_cast<int>(10 * (prefix - prefixes.begin())));
    if (bytes < 1 || bytes > 1e18) return {};
    return static_cast<std::size_t>(bytes);
}

std::string text_of(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string not_a_number(const std::string& word) {
    return "'" + word + "' is not a number";
}

}  // namespace exitance::option_values
