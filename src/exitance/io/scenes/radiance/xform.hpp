#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/scenes/affine.hpp"

namespace exitance {

/// What a Radiance command `xform ... file` asks for.
struct Xform {
    std::vector<std::string> files;    ///< Empty: it is given none.
    std::vector<std::string> options;  ///< All words that name no file.
    std::string name;                  ///< Goes before the names of what is in the files, or empty.
    std::string material;              ///< Of all surfaces in the files, in place of their own, or empty.
    std::vector<Affine> copies;        ///< One, or as many as an array has.
};

/// Understands the words after `xform`: -t x y z, -rx, -ry, -rz degrees, -s factor, -mx, -my, -mz, -i times, -a copies,
/// -n name, -m material, and -c, -e, which change nothing here. Transforms apply in the order given; those after -i so
/// many times, those after -a once for the second copy, twice for the third; several -a make a grid. At most
/// `most_copies` of them. Everything else is an error that says so.
Result<Xform> parse_xform(const std::vector<std::string>& words, std::size_t most_copies);

/// The same for a transform by itself, without a file and copies.
Result<Affine> parse_transform(const std::vector<std::string>& words);

}  // namespace exitance
