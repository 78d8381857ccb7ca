#include "exitance/lab/study/run_facts.hpp"

#include <nlohmann/json.hpp>

namespace exitance {
namespace {

void add(const nlohmann::json& object, const std::string& before, std::map<std::string, std::string>& facts) {
    for (const auto& [key, value] : object.items()) {
        if (value.is_object())
            add(value, before + key + ".", facts);
        else if (value.is_string())
            facts[before + key] = value.get<std::string>();
        else if (value.is_number() || value.is_boolean())
            facts[before + key] = value.dump();
    }
}

}  // namespace

std::map<std::string, std::string> facts_of_json(const std::string& text) {
    std::map<std::string, std::string> facts;
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_object()) add(json, "", facts);
    return facts;
}

}  // namespace exitance
