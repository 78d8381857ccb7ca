#include "exitance/cli/view/view_words.hpp"

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace exitance {

std::string view_text(const ViewServer::Parameters& parameters, const std::string& name) {
    const auto found = parameters.find(name);
    return found == parameters.end() ? "" : found->second;
}

std::optional<std::vector<double>> view_numbers(const ViewServer::Parameters& parameters, const std::string& name,
                                                std::size_t count) {
    std::istringstream in(view_text(parameters, name));
    std::vector<double> out;
    for (std::string word; std::getline(in, word, ',');) {
        char* end = nullptr;
        const double x = std::strtod(word.c_str(), &end);
        if (word.empty() || *end != 0 || !(std::abs(x) < 1e12)) return std::nullopt;
        out.push_back(x);
    }
    if (out.size() != count) return std::nullopt;
    return out;
}

}  // namespace exitance
