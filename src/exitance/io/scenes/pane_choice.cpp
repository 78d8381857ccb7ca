#include "exitance/io/scenes/pane_choice.hpp"

#include <algorithm>

namespace exitance {
namespace {

constexpr double rounding = 1e-6;  ///< Error of positions, relative to the scene's size; derived from single precision.

Point middle_of(const Pane& pane) {
    Point out;
    for (const Point& p : pane.corners) out += p / static_cast<double>(pane.corners.size());
    return out;
}

/// True if a convex pane was cut from an outline.
bool is_part_of(const Pane& pane, const NamedPane& outline, double tolerance) {
    const Point middle = middle_of(pane);
    return outline.corners.size() >= 3 && std::abs(dot(pane.n, middle - outline.corners[0])) <= tolerance &&
           contains(outline.corners, pane.n, middle);
}

bool is_within(const Pane& pane, const Box& box, double tolerance) {
    return std::all_of(pane.corners.begin(), pane.corners.end(), [&](const Point& p) {
        for (const auto& [v, low, high] : {std::array{p.x, box.lo.x, box.hi.x}, std::array{p.y, box.lo.y, box.hi.y},
                                           std::array{p.z, box.lo.z, box.hi.z}})
            if (v < low - tolerance || v > high + tolerance) return false;
        return true;
    });
}

}  // namespace

std::vector<bool> chosen_panes(const PaneChoice& choice, const Scene& scene, std::span<const NamedPane> named) {
    const double tolerance = rounding * scene.size();
    const auto lists = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    std::vector<bool> out;
    for (const Pane& pane : scene.panes()) {
        bool is_chosen = choice.materials.empty() && choice.objects.empty();
        for (const NamedPane& outline : named)
            is_chosen =
                is_chosen || ((lists(choice.materials, outline.material) || lists(choice.objects, outline.object)) &&
                              is_part_of(pane, outline, tolerance));
        out.push_back(is_chosen && (!choice.box || is_within(pane, *choice.box, tolerance)));
    }
    return out;
}

}  // namespace exitance
