#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exitance {

/// Presets of options with which a method works as a publication describes it.
struct Recipe {
    std::string_view name;     ///< "hanrahan91"
    std::string_view does;     ///< The reproduced form of a method, in words.
    std::string_view source;   ///< Key in docs/references.bib; empty: no publication.
    std::string_view presets;  ///< Options as on the command line.
};

/// All recipes, in the order of the help.
std::span<const Recipe> recipes();

/// The recipe of a name; null if there is none.
const Recipe* find_recipe(std::string_view name);

/// Name of the recipe most similar to `name`; empty if none is similar.
std::string nearest_recipe(std::string_view name);

/// The presets as separate words of a command line.
std::vector<std::string> preset_words(const Recipe& recipe);

}  // namespace exitance
