#include "exitance/io/scenes/radiance/rad_distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/radiance/xform.hpp"

namespace exitance {
namespace {

using Angle = EmissionProfile::Angle;
using Body = EmissionProfile::Body;

Error bad(std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, std::move(message), "", std::move(hint)};
}

// ------------------------------------------------------------------------------------------------ tables

/// Reads the numbers of a data file, in which '#' begins comments.
class DataNumbers {
  public:
    explicit DataNumbers(std::string_view text) : words_(text) {}
    std::optional<double> next() {
        double value = 0;
        const auto word = words_.next();
        return word && number_of_word(*word, value) == NumberKind::finite ? std::optional(value) : std::nullopt;
    }
    std::optional<std::size_t> count(double most) {
        const auto value = next();
        if (!value || *value < 1 || *value > most || *value != std::floor(*value)) return std::nullopt;
        return static_cast<std::size_t>(*value);
    }
    int line() const { return words_.line(); }

  private:
    RadWords words_;
};

constexpr double max_entries = 4e6;

/// Reads the angles of an axis: evenly spaced from begin to end, or a list if these are equal.
std::optional<std::vector<double>> read_axis(DataNumbers& numbers) {
    const auto begin = numbers.next(), end = begin ? numbers.next() : std::nullopt;
    const auto count = end ? numbers.count(max_entries) : std::nullopt;
    if (!count) return std::nullopt;
    std::vector<double> out(*count);
    for (std::size_t i = 0; i < *count; ++i) {
        if (*begin != *end) {
            out[i] = *count == 1 ? *begin
                                 : *begin + (*end - *begin) * static_cast<double>(i) / static_cast<double>(*count - 1);
            continue;
        }
        const auto listed = numbers.next();
        if (!listed) return std::nullopt;
        out[i] = *listed;
    }
    return out;
}

/// Reverses descending axes.
void make_ascending(EmissionProfile& p) {
    const std::size_t rows = p.axes[0].at.size(), columns = p.axes[1].at.size();
    if (rows > 1 && p.axes[0].at[1] < p.axes[0].at[0]) {
        std::reverse(p.axes[0].at.begin(), p.axes[0].at.end());
        for (std::size_t r = 0; r < rows / 2; ++r)
            for (std::size_t c = 0; c < columns; ++c)
                std::swap(p.values[r * columns + c], p.values[(rows - 1 - r) * columns + c]);
    }
    if (columns > 1 && p.axes[1].at[1] < p.axes[1].at[0]) {
        std::reverse(p.axes[1].at.begin(), p.axes[1].at.end());
        for (std::size_t r = 0; r < rows; ++r) {
            const auto first = p.values.begin() + static_cast<std::ptrdiff_t>(r * columns);
            std::reverse(first, first + static_cast<std::ptrdiff_t>(columns));
        }
    }
}

/// Reads a table of one or two dimensions.
Result<void> read_table(std::string_view text, std::size_t dimensions, EmissionProfile& p) {
    DataNumbers numbers(text);
    const auto wrong = [&](const std::string& what) {
        return bad(fmt::format("{}, at its line {}", what, numbers.line()));
    };
    const auto found = numbers.count(100);
    if (!found) return wrong("it does not begin with a number of dimensions");
    if (*found != dimensions)
        return wrong(fmt::format("it has {} dimensions, and {} angles are named", *found, dimensions));
    for (std::size_t i = 0; i < dimensions; ++i) {
        auto axis = read_axis(numbers);
        if (!axis) return wrong("it has an invalid axis");
        p.axes[i].at = std::move(*axis);
    }
    const double entries = static_cast<double>(p.axes[0].at.size()) * static_cast<double>(p.axes[1].at.size());
    if (entries > max_entries) return wrong(fmt::format("it has {:g} entries", entries));
    for (std::size_t i = 0; i < static_cast<std::size_t>(entries); ++i) {
        const auto value = numbers.next();
        if (!value) return wrong(fmt::format("it has {} of {} values", i, entries));
        p.values.push_back(*value);
    }
    make_ascending(p);
    return {};
}

// ------------------------------------------------------------------------------------------------ words

/// Parses an angle of source.cal with an offset, such as "src_phi2+90".
std::optional<EmissionProfile::Axis> axis_of(std::string_view word) {
    static constexpr std::array<std::pair<std::string_view, Angle>, 9> known{{{"src_theta", Angle::theta},
                                                                              {"src_phi", Angle::phi},
                                                                              {"src_phi2", Angle::phi2},
                                                                              {"src_phi4", Angle::phi4},
                                                                              {"srcB_vert", Angle::b_vertical},
                                                                              {"srcB_vert2", Angle::b_vertical2},
                                                                              {"srcB_horiz", Angle::b_horizontal},
                                                                              {"srcB_horiz2", Angle::b_horizontal2},
                                                                              {"srcB_phi", Angle::phi}}};
    const std::size_t sign = std::min(word.find_first_of("+-"), word.size());
    const auto at =
        std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.first == word.substr(0, sign); });
    if (at == known.end()) return std::nullopt;
    EmissionProfile::Axis axis{at->second, 0, {0}};
    if (sign < word.size() &&
        (number_of_word(word.substr(sign), axis.offset) != NumberKind::finite || std::abs(axis.offset) > 360))
        return std::nullopt;
    return axis;
}

/// Selects the conversion from table values to radiance by the name of a function of source.cal.
Result<void> read_body(std::string_view function, const std::vector<double>& numbers, EmissionProfile& p) {
    const auto lacks = [&](std::size_t wanted) {
        return bad(fmt::format("{} takes {} numbers, not {}", function, wanted, numbers.size()));
    };
    double multiplier = 1;
    if (function == "corr" || function == "flatcorr" || function == "noop" || function == "noneg") {
        p.body = function == "flatcorr" ? Body::flat : Body::none;
        if (!numbers.empty() && function.ends_with("corr")) multiplier = numbers[0];
    } else if (function == "boxcorr" || function == "lboxcorr") {
        if (numbers.size() < 4) return lacks(4);
        p.body = Body::box, multiplier = numbers[0], p.size = {numbers[1], numbers[2], numbers[3]};
    } else if (function == "cylcorr") {
        if (numbers.size() < 3) return lacks(3);
        p.body = Body::cylinder, multiplier = numbers[0], p.size = {numbers[1], numbers[2], 0};
    } else {
        return bad(fmt::format("the function '{}' is not known", shown(function)),
                   "known: corr, flatcorr, boxcorr, lboxcorr and cylcorr of source.cal");
    }
    for (double& v : p.values) v = std::max(0.0, v * multiplier);
    return {};
}

Result<std::string> read_beside(const std::string& name, const RadPattern& pattern, const std::string& scene_file) {
    std::error_code ignored;
    const std::string near = beside(pattern.file, name);
    return read_whole_file(std::filesystem::exists(near, ignored) ? near : beside(scene_file, name));
}

/// Reads the words FUNC FILE source.cal ANGLE [ANGLE] [transform].
Result<RadDistribution> read_data(const RadPattern& pattern, const std::string& scene_file) {
    const std::vector<std::string>& words = pattern.primitive.words;
    if (words.size() < 4)
        return bad(fmt::format("it has {} words: function, data, calculation and angles", words.size()));
    if (!words[2].ends_with("source.cal"))
        return bad(fmt::format("its functions are in '{}'", shown(words[2])),
                   "only the functions of source.cal are supported");
    RadDistribution out;
    std::size_t angles = 0;
    while (3 + angles < words.size() && !words[3 + angles].starts_with("-")) {
        const auto axis = axis_of(words[3 + angles]);
        if (!axis) return bad(fmt::format("the angle '{}' is not known", shown(words[3 + angles])));
        if (angles == 2) return bad("it has more than two angles");
        out.profile.axes[angles++] = *axis;
    }
    if (angles == 0) return bad("it has no angles");
    const Result<Affine> turn = parse_transform({words.begin() + static_cast<std::ptrdiff_t>(3 + angles), words.end()});
    if (!turn) return turn.error();
    out.to_world = pattern.to_world * *turn;
    const Result<std::string> text = read_beside(words[1], pattern, scene_file);
    if (!text) return bad(fmt::format("its data '{}' {}", shown(words[1]), text.error().message));
    if (const auto table = read_table(*text, angles, out.profile); !table)
        return bad(fmt::format("its data '{}': {}", shown(words[1]), table.error().message));
    if (const auto body = read_body(words[0], pattern.primitive.numbers, out.profile); !body) return body.error();
    return out;
}

/// Reads the words FUNC(number) source.cal [transform].
Result<RadDistribution> read_function(const RadPattern& pattern) {
    const std::vector<std::string>& words = pattern.primitive.words;
    const std::size_t open = words.empty() ? std::string::npos : words[0].find('(');
    double value = 0;
    if (words.size() < 2 || open == std::string::npos || !words[0].ends_with(')') ||
        number_of_word(std::string_view(words[0]).substr(open + 1, words[0].size() - open - 2), value) !=
            NumberKind::finite)
        return bad(fmt::format("the function '{}' is not known", words.empty() ? "" : shown(words[0])),
                   "brightdata is read, and brightfunc of a number such as flatcorr(1)");
    const Result<Affine> turn = parse_transform({words.begin() + 2, words.end()});
    if (!turn) return turn.error();
    RadDistribution out;
    out.profile.values = {value};
    out.to_world = pattern.to_world * *turn;
    if (const auto body = read_body(words[0].substr(0, open), pattern.primitive.numbers, out.profile); !body)
        return body.error();
    return out;
}

}  // namespace

Result<RadDistribution> read_distribution(const RadPattern& pattern, const std::string& scene_file) {
    Result<RadDistribution> out = pattern.primitive.type == "brightdata"   ? read_data(pattern, scene_file)
                                  : pattern.primitive.type == "brightfunc" ? read_function(pattern)
                                                                           : bad("this type is not supported");
    if (out && !out->profile.is_sane())
        return bad("its table is not a distribution", "angles ascend, sizes are positive, values finite");
    return out;
}

}  // namespace exitance
