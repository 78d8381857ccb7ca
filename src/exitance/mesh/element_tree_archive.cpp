#include "exitance/mesh/element_tree_archive.hpp"

namespace exitance {
namespace {

struct Root {
    ElementId element;
    RegionId region;
    Patch patch;
};

/// A split, stored in the order of the first children, which is the order of the splits.
struct CutMade {
    ElementId element;
    Cut kind = Cut::none;
    double ratio = 0.5;
    CutLine line;
    std::uint32_t fan_size = 0;  ///< Number of points of the border, if the element is split into a fan.
};

}  // namespace

void archive(ArchiveWriter& a, const ElementTree& tree) {
    std::vector<Root> roots;
    std::vector<CutMade> cuts;
    std::vector<Vec2> fans;  // points of each fan: its apex, then its border
    for (ElementId e : tree.ids()) {
        const ElementId parent = tree.parent(e);
        if (parent.is_none()) {
            roots.push_back({e, tree.region(e), tree.patch(e)});
        } else if (tree.children(parent).front() == e) {
            const Cut kind = tree.cut_of(parent);
            cuts.push_back({parent, kind, tree.ratio(parent), kind == Cut::line ? tree.line(parent) : CutLine{}});
            if (kind != Cut::fan) continue;
            const FanView fan = tree.fan(parent);
            cuts.back().fan_size = static_cast<std::uint32_t>(fan.border.size());
            fans.push_back(fan.apex);
            fans.insert(fans.end(), fan.border.begin(), fan.border.end());
        }
    }
    a(roots, cuts, fans);
}

void archive(ArchiveReader& a, ElementTree& tree) {
    std::vector<Root> roots;
    std::vector<CutMade> cuts;
    std::vector<Vec2> fans;
    a(roots, cuts, fans);
    tree = {};
    std::size_t next = 0;
    auto fan = fans.begin();
    const auto cut_until = [&](std::size_t size) {
        for (; tree.size() < size && next < cuts.size(); ++next) {
            const CutMade& cut = cuts[next];
            if (cut.kind == Cut::line) {
                tree.split_by_line(cut.element, cut.line);
            } else if (cut.kind == Cut::fan) {
                const auto border = fan + 1;
                fan = border + cut.fan_size;
                tree.split_fan(cut.element, {*(border - 1), {border, fan}});
            } else {
                tree.split(cut.element, cut.kind, cut.ratio);
            }
        }
    };
    for (const Root& root : roots) {
        cut_until(root.element.value);
        tree.add_root(root.region, root.patch);
    }
    cut_until(~std::size_t(0));
}

}  // namespace exitance
