#include "exitance/io/scenes/gltf/json_shape.hpp"

#include <algorithm>

namespace exitance {

JsonShape shape_of_json(std::string_view json) {
    JsonShape out;
    std::size_t depth = 0, list = 0;  // depth of the current list of buffers; 0 outside one
    bool named = false;               // whether the last string was "buffers"
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (c == '"') {
            const std::size_t first = ++i;
            while (i < json.size() && json[i] != '"') i += json[i] == '\\' ? 2 : 1;
            // A name with escape sequences may spell "buffers", so treat it as such.
            const std::string_view name = json.substr(first, std::min(i, json.size()) - first);
            named = name == "buffers" || name.find('\\') != name.npos;
        } else if (c == '[' || c == '{') {
            out.depth = std::max(out.depth, ++depth);
            if (c == '[' && named && list == 0) list = depth;
            if (c == '{' && list != 0) ++out.buffers;
        } else if (c == ']' || c == '}') {
            if (depth == list) list = 0;
            if (depth > 0) --depth;
        }
    }
    return out;
}

}  // namespace exitance
