#include "exitance/mesh/element_tree_archive.hpp"

namespace exitance {
namespace {

struct Root {
    ElementId element;
    RegionId region;
    Patch patch;
};

/// In the order of the first children, which is that of the cuts.
struct CutMade {
    ElementId element;
    Cut way = Cut::none;
    double ratio = 0.5;
    CutLine line;
};

}  // namespace

void archive(ArchiveWriter& a, const ElementTree& tree) {
    std::vector<Root> roots;
    std::vector<CutMade> cuts;
    for (ElementId e : tree.ids()) {
        const ElementId parent = tree.parent(e);
        if (parent.is_none()) {
            roots.push_back({e, tree.region(e), tree.patch(e)});
        } else if (tree.children(parent).front() == e) {
            const Cut way = tree.way(parent);
            cuts.push_back({parent, way, tree.ratio(parent), way == Cut::line ? tree.line(parent) : CutLine{}});
        }
    }
    a(roots, cuts);
}

void archive(ArchiveReader& a, ElementTree& tree) {
    std::vector<Root> roots;
    std::vector<CutMade> cuts;
    a(roots, cuts);
    tree = {};
    std::size_t next = 0;
    const auto cut_until = [&](std::size_t size) {
        for (; tree.size() < size && next < cuts.size(); ++next) {
            const CutMade& cut = cuts[next];
            if (cut.way == Cut::line)
                tree.split_by_line(cut.element, cut.line, 0);
            else
                tree.split(cut.element, cut.way, cut.ratio);
        }
    };
    for (const Root& root : roots) {
        cut_until(root.element.value);
        tree.add_root(root.region, root.patch);
    }
    cut_until(~std::size_t(0));
}

}  // namespace exitance
