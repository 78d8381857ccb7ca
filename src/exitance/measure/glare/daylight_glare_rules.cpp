#include "exitance/measure/glare/daylight_glare_rules.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/measure/glare/glare_rules.hpp"
#include "exitance/measure/glare/near_directions.hpp"

namespace exitance {
namespace {

/// Index of Guth's formula to the side of the line of sight, tau = 90 degrees, at an angle beta below it [Iwata10].
double position_below(double ahead, double aside, double above) {
    constexpr double stretch = 0.3225;  // [Iwata10]
    const double off = std::hypot(aside, above), cosine = above / off;
    const double beta = std::atan2(off * std::sqrt(1 + stretch * cosine * cosine), ahead) / degree;
    return std::exp(6.49e-3 * beta + 21e-5 * beta * beta);  // [Iwata10]
}

bool is_peak(const GlarePart& part) {
    return part.luminance >= peak_luminance;
}

/// Makes one source of the parts with these indices.
DaylightGlareSource source_of(const Normal& view, std::span<const GlarePart> parts,
                              std::span<const std::size_t> members) {
    DaylightGlareSource out;
    Vec3 centre;
    double light = 0;
    std::vector<std::pair<std::uint32_t, double>> origins;
    for (const std::size_t i : members) {
        const GlarePart& part = parts[i];
        const double flux = part.luminance * part.solid_angle;
        light += flux, out.solid_angle += part.solid_angle, centre += flux * part.towards;
        const auto known =
            std::find_if(origins.begin(), origins.end(), [&](const auto& o) { return o.first == part.origin; });
        if (known == origins.end())
            origins.emplace_back(part.origin, flux);
        else
            known->second += flux;
    }
    out.luminance = light / out.solid_angle;
    out.towards = normalized(centre);
    out.position = daylight_position(view, centre);
    out.origin = std::max_element(origins.begin(), origins.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                 })->first;
    return out;
}

}  // namespace

double daylight_position(const Normal& view, const Vec3& d) {
    constexpr double largest = 16;  // [Wienold24]
    const auto [ahead, aside, above] = sight_offsets(view, d);
    return std::min(largest, above < 0 ? position_below(ahead, aside, above) : guth_position(view, d));
}

std::vector<DaylightGlareSource> join_glare_parts(const Normal& view, std::span<const GlarePart> parts) {
    std::vector<Normal> directions;
    for (const GlarePart& part : parts) directions.push_back(part.towards);
    DisjointSets sets(parts.size());
    for (const auto& [i, k] : near_pairs(directions, glare_joining_angle))
        if (is_peak(parts[i]) == is_peak(parts[k])) sets.unite(i, k);
    std::vector<std::vector<std::size_t>> members(parts.size());
    for (std::uint32_t i = 0; i < parts.size(); ++i) members[sets.root(i)].push_back(i);
    std::vector<DaylightGlareSource> out;
    for (const std::vector<std::size_t>& some : members)
        if (!some.empty()) out.push_back(source_of(view, parts, some));
    std::stable_sort(out.begin(), out.end(),
                     [](const DaylightGlareSource& a, const DaylightGlareSource& b) { return a.term() > b.term(); });
    return out;
}

double low_light_factor(double vertical_illuminance) {
    constexpr double limit = 1000, slope = 0.024;  // [Wienold24]
    if (vertical_illuminance >= limit) return 1;
    const double x = std::exp(slope * vertical_illuminance - 4);
    return x / (1 + x);
}

double daylight_glare_probability(double vertical_illuminance, double terms) {
    constexpr double per_lux = 5.87e-5, of_contrast = 0.0918, constant = 0.16, exponent = 1.87;  // [Wienold06]
    if (!(vertical_illuminance > 0)) return 0;
    const double contrast = std::log10(1 + terms / std::pow(vertical_illuminance, exponent));
    const double all = per_lux * vertical_illuminance + of_contrast * contrast + constant;
    return std::min(1.0, low_light_factor(vertical_illuminance) * all);
}

const char* glare_class(double probability) {
    constexpr std::array<const char*, 4> names{"imperceptible", "perceptible", "disturbing", "intolerable"};
    std::size_t k = 0;
    while (k < glare_limits.size() && probability >= glare_limits[k]) ++k;
    return names[k];
}

}  // namespace exitance
