#include "exitance/io/scenes/json_members.hpp"

namespace exitance {

const Json& member(const Json& object, const char* key) {
    static const Json none;
    if (!object.is_object()) return none;
    const auto found = object.find(key);
    return found == object.end() ? none : *found;
}

const Json& entries(const Json& object, const char* key) {
    static const Json none = Json::array();
    const Json& value = member(object, key);
    return value.is_array() ? value : none;
}

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : std::string();
}

std::string text_in(const Json& object, const char* key) {
    return text_of(member(object, key));
}

bool flag_in(const Json& object, const char* key) {
    const Json& value = member(object, key);
    return value.is_boolean() && value.get<bool>();
}

std::optional<Vec3> vector_of(const Json& value) {
    if (!value.is_array() || value.size() != 3) return std::nullopt;
    Vec3 out;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!value[i].is_number()) return std::nullopt;
        out[i] = value[i].get<double>();
    }
    if (!is_finite(out)) return std::nullopt;
    return out;
}

}  // namespace exitance
