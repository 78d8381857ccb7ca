#include "exitance/what_if/light_groups/light_change_words.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

namespace exitance {
namespace {

std::optional<double> number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
    return value;
}

Error not_understood(std::string_view word, const char* example) {
    return {ErrorCode::usage, fmt::format("'{}' is not understood", word), std::string(word), example};
}

/// Adds a named value; an error if the name has one already, since one of the two would be ignored.
template <class Value>
Result<void> add_once(std::vector<std::pair<std::string, Value>>& all, std::string_view name, const Value& value) {
    for (const auto& known : all)
        if (known.first == name)
            return Error{ErrorCode::usage, "is given more than once", std::string(name), "leave all but one out"};
    all.emplace_back(name, value);
    return {};
}

}  // namespace

Result<void> read_dim(std::string_view word, LightChange& change, char parted_by) {
    const std::size_t at = word.rfind(parted_by);
    const auto factor = at == word.npos ? std::nullopt : number(word.substr(at + 1));
    if (!factor || at == 0) return not_understood(word, "GROUP=FACTOR: lamp=0.5");
    return add_once(change.dim, word.substr(0, at), *factor);
}

Result<void> read_reflectance(std::string_view word, LightChange& change, char parted_by, char between_bands) {
    constexpr const char* example = "MATERIAL=r,g,b: wall=0.8,0.7,0.6";
    const std::size_t at = word.rfind(parted_by);
    if (at == word.npos || at == 0) return not_understood(word, example);
    Spectrum rho;
    std::string_view rest = word.substr(at + 1);
    std::size_t band = 0;
    for (; band < bands; ++band) {
        const std::size_t comma = rest.find(between_bands);
        const auto value = number(rest.substr(0, comma));
        if (!value) return not_understood(word, example);
        rho[band] = *value;
        if (comma == rest.npos) break;
        rest.remove_prefix(comma + 1);
    }
    if (band == 0)
        rho = Spectrum(rho[0]);
    else if (band + 1 != bands)
        return not_understood(word, example);
    return add_once(change.reflectance, word.substr(0, at), rho);
}

}  // namespace exitance
