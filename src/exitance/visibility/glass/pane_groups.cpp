#include "exitance/visibility/glass/pane_groups.hpp"

#include "exitance/base/check.hpp"
#include "exitance/visibility/glazed_part.hpp"

namespace exitance {

PaneGroups::PaneGroups(const Scene& scene, std::vector<std::int32_t> group_of_pane, std::size_t count)
    : group_of_pane_(std::move(group_of_pane)), reach_(2 * scene.size()), count_(count) {
    EXI_CHECK(group_of_pane_.size() == scene.panes().size() && count <= max_groups);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < group_of_pane_.size(); ++i) {
        if (group_of_pane_[i] < 0) continue;
        panes_.push_back(scene.panes()[i]), number_.push_back(static_cast<std::uint32_t>(i));
        Box& box = boxes.emplace_back();
        for (const Point& p : panes_.back().corners) box.add(p);
    }
    tree_ = Bvh(boxes);
}

PaneGroups PaneGroups::all_light() {
    PaneGroups out;
    out.count_ = 1, out.has_all_light_ = true;
    return out;
}

PaneGroups::Mask PaneGroups::crossed(const Point& x, const Point& y, std::int32_t ignored) const {
    if (has_all_light_) return 1;
    Mask out = 0;
    tree_.visit_segment(x, y - x, 1, [&](std::uint32_t i) {
        const std::uint32_t number = number_[i];
        if (static_cast<std::int32_t>(number) != ignored && crosses(panes_[i], x, y)) out |= mask_of(number);
        return 1.0;
    });
    return out;
}

PaneGroups::Mask PaneGroups::crossed_outwards(const Point& x, const Vec3& direction, std::int32_t ignored) const {
    return crossed(x, x + (reach_ / norm(direction)) * direction, ignored);
}

}  // namespace exitance
