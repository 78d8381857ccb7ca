#include "exitance/io/scenes/radiance/rad_box_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {

bool is_box_command(const CommandWords& words) {
    constexpr std::size_t plain = 6;
    if (words.empty() || words[0] != "genbox" || words.size() < plain) return false;
    return std::all_of(words.begin() + plain, words.end(), [](const std::string& w) { return w == "-i"; });
}

Result<std::string> box_command_output(const CommandWords& words) {
    std::array<double, 3> size{};
    for (std::size_t k = 0; k < 3; ++k)
        if (number_of_word(words[3 + k], size[k]) != NumberKind::finite || !(size[k] > 0))
            return Error{ErrorCode::bad_input,
                         fmt::format("genbox's size '{}' is not a number above 0", shown(words[3 + k])), "",
                         "genbox material name x y z"};
    const bool inwards = words.size() > 6;
    // Corner indices, counter-clockwise seen from outside.
    constexpr std::array<std::array<unsigned, 4>, 6> sides{
        {{1, 5, 4, 0}, {4, 6, 2, 0}, {6, 7, 3, 2}, {5, 1, 3, 7}, {1, 0, 2, 3}, {4, 5, 7, 6}}};
    std::string out;
    for (std::array<unsigned, 4> side : sides) {
        if (inwards) std::reverse(side.begin(), side.end());
        out += fmt::format("{} polygon {}.{}\n0\n0\n12\n", words[1], words[2], fmt::join(side, ""));
        for (const unsigned corner : side)
            out += fmt::format("{:.17g} {:.17g} {:.17g}\n", corner & 1 ? size[0] : 0, corner & 2 ? size[1] : 0,
                               corner & 4 ? size[2] : 0);
    }
    return out;
}

}  // namespace exitance
