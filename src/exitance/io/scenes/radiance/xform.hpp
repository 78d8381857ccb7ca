#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/scenes/affine.hpp"

namespace exitance {

/// Parsed arguments of a Radiance command `xform ... file`.
struct Xform {
    std::vector<std::string> files;    ///< Files to transform; may be empty.
    std::vector<std::string> options;  ///< Words of the command that do not name files.
    std::string name;                  ///< Prefix for the names in the files, or empty.
    std::string material;  ///< Material that replaces those of all surfaces in the files; empty: they keep their own.
    std::vector<Affine> copies;  ///< Transform of each copy: one, or several for an array.
};

/// Parses the words after `xform`: -t x y z, -rx, -ry, -rz degrees, -s factor, -mx, -my, -mz, -i times, -a copies, -n
/// name, -m material; -c and -e have no effect. Transforms are applied in the given order. Those after -i are repeated;
/// those after -a are applied once for the second copy, twice for the third, and so on. Several -a make a grid of at
/// most `max_copies` copies. Error: everything else.
Result<Xform> parse_xform(const std::vector<std::string>& words, std::size_t max_copies);

/// Parses a single transform, without files and copies.
Result<Affine> parse_transform(const std::vector<std::string>& words);

}  // namespace exitance
