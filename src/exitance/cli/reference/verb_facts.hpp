#pragma once

#include <string>
#include <vector>

#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// An option of a verb, as help and reference describe it.
struct OptionFacts {
    std::string short_name, long_name;  ///< "-o", "--output"; both empty for an input.
    std::string type;                   ///< "FILE", "on|off"; empty for a flag; for an input, its name.
    std::string help, group;
    Audience audience = Audience::users;
    bool is_required = false;
    std::string supported_by;  ///< Methods that support the option; empty: all.

    bool is_input() const { return long_name.empty() && short_name.empty(); }
};

/// A verb, as help and reference describe it.
struct VerbFacts {
    std::string name, does, example;
    std::vector<OptionFacts> options;  ///< Inputs first.
};

}  // namespace exitance
