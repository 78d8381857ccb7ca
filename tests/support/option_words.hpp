#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "exitance/methods/options/option_row.hpp"

namespace exitance::test {

/// Words that an option reads: all of a choice, one of other kinds.
inline std::vector<std::string> words_for(const OptionRow& row) {
    const std::string& type = row.value.type;
    if (type.empty()) return {""};
    if (row.name == "--recipe") return {"classical-matrix"};
    if (type == "SIZE") return {"4M"};
    if (type == "WHEN") return {"t=1", "shots=10", "rounds"};
    if (type == "N") return {"8"};
    if (type == "N|all") return {"0", "3"};
    if (type == "N|off") return {"3"};
    if (type == "N|POWER") return {"3", "20W"};
    std::vector<std::string> words;
    std::istringstream in(type);
    for (std::string word; std::getline(in, word, '|');)
        if (word.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos) words.push_back(word);
    return words.empty() ? std::vector<std::string>{"0.5"} : words;
}

}  // namespace exitance::test
