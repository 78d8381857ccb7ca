#include "exitance/scene/named_regions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string_view>

namespace exitance {

Field<RegionId, std::uint8_t> regions_named(const Scene& scene, std::span<const std::string> names) {
    const std::set<std::string_view> wanted(names.begin(), names.end());
    Field<RegionId, std::uint8_t> out;
    out.resize(scene.regions().size());
    for (const Surface& face : scene.surfaces())
        if (wanted.contains(scene.materials()[face.material].name) || wanted.contains(scene.groups()[face.group]))
            out[face.region] = 1;
    return out;
}

Result<void> check_face_names(const Scene& scene, std::span<const std::string> names, const std::string& option) {
    constexpr std::size_t max_shown = 8;
    std::set<std::string_view> known;
    for (const Surface& face : scene.surfaces())
        known.insert(scene.materials()[face.material].name), known.insert(scene.groups()[face.group]);
    known.erase("");
    for (const std::string& name : names) {
        if (known.contains(name)) continue;
        std::vector<std::string_view> shown(known.begin(), known.end());
        const bool are_more = shown.size() > max_shown;
        if (are_more) shown.resize(max_shown);
        return Error{ErrorCode::usage, fmt::format("no material, object or file is called '{}'", name), option,
                     fmt::format("the scene has {}{}", fmt::join(shown, ", "), are_more ? ", ..." : "")};
    }
    return {};
}

}  // namespace exitance
