#include "exitance/mesh/contact_lines.hpp"

#include <algorithm>
#include <memory>
#include <tuple>

#include "exitance/base/shared_results.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {
namespace {

/// Splits a leaf along a line: into parallelograms if the line is parallel to one of a parallelogram's directions,
/// otherwise into cells. Returns false, and does nothing, if almost nothing would be on one side, as for a line along
/// the border.
bool cut_along(ElementTree& tree, ElementId e, const CutLine& line) {
    // Share of the element's area that each part must have. Chosen: half of it and twice it give the same light,
    // measured by `exitance solve furniture.obj --error 0.02`.
    constexpr double min_share = 1e-5;
    constexpr double parallel = 1e-6;  // deviation, as a share of the element; derived from the rounding of files
    if (!tree.is_cell(e) && !tree.patch(e).is_triangle())
        for (const auto& [kind, along, across] :
             {std::tuple{Cut::u, line.normal.x, line.normal.y}, {Cut::v, line.normal.y, line.normal.x}}) {
            if (std::abs(across) > parallel * std::abs(along)) continue;
            const double ratio = line.offset / along;
            if (ratio < min_share || ratio > 1 - min_share) return false;
            tree.split(e, kind, ratio);
            return true;
        }
    return !tree.split_by_line(e, line, min_share).is_none();
}

/// Splits one element along the contact lines inside it.
///
/// With many lines, splitting along each would make every part search all others. The element is therefore bisected
/// first, and each half has fewer lines. Near a point where many lines meet this never ends: an element that was
/// bisected several times without effect stays as it is.
class ContactCutter {
  public:
    using Lines = std::vector<ContactLines::Line>;

    ContactCutter(ElementTree& tree, const ContactLines& contacts, const StopRequest* stop)
        : tree_(tree), contacts_(contacts), stop_(stop) {}

    /// Splits an element and its parts. `around`: the lines that cross the element.
    void run(ElementId e, Lines around) {
        open_.push_back(
            {.element = e, .area = tree_.area(e), .around = std::make_shared<const Lines>(std::move(around))});
        while (!open_.empty() && !(stop_ && stop_->requested())) {
            Open now = std::move(open_.back());
            open_.pop_back();
            cut(std::move(now));
        }
    }

  private:
    struct Open {
        ElementId element;
        double area;                               ///< Area of the element before it was split along contacts, m^2.
        std::size_t lines = ~std::size_t(0);       ///< Number of lines when it last decreased by a quarter or more.
        int in_vain = 0;                           ///< Number of bisections since that decrease.
        std::size_t of_parent = ~std::size_t(0);   ///< Number of lines of the parent, which was split by a line.
        int unchanged = 0;                         ///< Number of ancestors that had no fewer lines than their parent.
        std::shared_ptr<const Lines> around = {};  ///< Lines that may cross the element; null: unknown.
    };

    void cut(Open now) {
        constexpr std::size_t max_lines = 24;
        constexpr int max_in_vain = 6;
        const ElementId e = now.element;
        Lines around = now.around ? *now.around : contacts_.around(tree_, e, now.area);
        const std::vector<std::pair<Vec2, Vec2>> lines = contacts_.inside(tree_, e, around);
        // A line that has split an element is inside neither part, unless rounding leaves it there, as with nearly
        // parallel lines that are closer than the accuracy of the split.
        if (lines.size() >= now.of_parent && ++now.unchanged > max_in_vain) return;
        if (lines.size() > max_lines) {
            if (lines.size() < now.lines - now.lines / 4)
                now = {e, now.area, lines.size()};
            else if (++now.in_vain > max_in_vain)
                return;
            // The halves are smaller elements with smaller limits for gaps, so their lines are searched again.
            for (ElementId child : refine_element(tree_, e))
                open_.push_back({child, now.area * tree_.area(child) / tree_.area(e), now.lines, now.in_vain});
            if (!tree_.is_leaf(e)) return;
        }
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const auto& [a, b] = lines[i];
            const Vec2 d = b - a;
            const double length = std::hypot(d.x, d.y);
            const Vec2 normal = {-d.y / length, d.x / length};
            if (!cut_along(tree_, e, {normal, dot(normal, a)})) continue;
            const auto beside = std::make_shared<Lines>(lines_of_strip(around, around[i]));
            const auto of_parts = std::make_shared<Lines>(std::move(around));
            const ContactLines::Line& line = (*of_parts)[i];
            for (ElementId child : tree_.children(e)) {
                const bool is_strip = line.is_strip() && dot(line.inwards, centroid(tree_.outline(child)) - line.a) < 0;
                open_.push_back({child, now.area, now.lines, now.in_vain, lines.size(), now.unchanged,
                                 is_strip ? beside : of_parts});
            }
            return;  // the children process the remaining lines
        }
    }

    /// Returns the lines that may split the part between a line of a strip and its mouth: all but the strips of mouths
    /// across to it. With three mouths of three strips each, a face would have 28 parts instead of 10.
    static Lines lines_of_strip(const Lines& around, const ContactLines::Line& strip) {
        Lines out;
        for (const ContactLines::Line& line : around)
            if (!line.is_strip() || std::abs(dot(line.inwards, strip.inwards)) > 0.5) out.push_back(line);
        return out;
    }

    ElementTree& tree_;
    const ContactLines& contacts_;
    const StopRequest* stop_;
    std::vector<Open> open_;
};

/// Copies a leaf to another tree: as a root, or for a cell, by repeating the splits of its root.
ElementId copy_leaf(const ElementTree& tree, ElementId e, ElementTree& out) {
    if (!tree.is_cell(e)) return out.add_root(tree.region(e), tree.patch(e));
    const ElementId parent = tree.parent(e);
    const ElementId first = out.split_by_line(copy_leaf(tree, parent, out), tree.line(parent));
    return ElementId(first.value + e.value - tree.children(parent).front().value);
}

/// A recording of how elements are split, for repetition in another tree.
class FoundCuts {
  public:
    /// Records the splits of `element`, whose descendants are in the tree from index `first` on.
    void add(const ElementTree& tree, ElementId element, std::size_t first) {
        const std::size_t before = cuts_.size();
        for (std::size_t i = first; i < tree.size(); ++i) {
            const ElementId e(i), parent = tree.parent(e);
            if (tree.children(parent).front() != e) continue;
            const auto number = static_cast<std::uint32_t>(parent == element ? 0 : parent.value - first + 1);
            const Cut kind = tree.cut_of(parent);
            cuts_.push_back({number, kind, kind == Cut::line ? tree.line(parent) : CutLine{{}, tree.ratio(parent)}});
        }
        count_.push_back(static_cast<std::uint32_t>(cuts_.size() - before));
    }
    void add_none() { count_.push_back(0); }

    /// Repeats the splits, last element first.
    void cut(ElementTree& tree, std::span<const ElementId> elements) const {
        auto end = cuts_.end();
        for (std::size_t i = count_.size(); i-- > 0;) {
            const auto begin = end - count_[i];
            const std::size_t first = tree.size();
            for (auto made = begin; made != end; ++made) {
                const ElementId e = made->element == 0 ? elements[i] : ElementId(first + made->element - 1);
                if (made->kind == Cut::line)
                    tree.split_by_line(e, made->line);
                else
                    tree.split(e, made->kind, made->line.offset);
            }
            end = begin;
        }
    }

    template <class Archive>
    friend void archive(Archive& a, FoundCuts& found) {
        a(found.count_, found.cuts_);
    }

  private:
    struct MadeCut {
        std::uint32_t element;  ///< 0: the element itself; k > 0: the k-th of its descendants.
        Cut kind;
        CutLine line;  ///< For splits across one direction, the ratio replaces the offset.
    };
    std::vector<std::uint32_t> count_;  ///< Number of splits per element.
    std::vector<MadeCut> cuts_;
};

/// Finds the splits in a separate tree, so that elements can be processed in parallel.
FoundCuts find_cuts(const ElementTree& tree, std::span<const ElementId> elements, const ContactLines& contacts,
                    const StopRequest* stop) {
    FoundCuts out;
    ElementTree room;
    for (ElementId e : elements) {
        std::vector<ContactLines::Line> lines;
        if (!stop || !stop->requested()) {
            lines = contacts.around(tree, e, tree.area(e));
            contacts.inside(tree, e, lines);
        }
        if (lines.empty()) {
            out.add_none();
            continue;
        }
        const ElementId own = copy_leaf(tree, e, room);
        const std::size_t first = room.size();
        ContactCutter(room, contacts, stop).run(own, std::move(lines));
        out.add(room, own, first);
    }
    return out;
}

}  // namespace

void cut_along_contacts(ElementTree& tree, const std::vector<ElementId>& from, const ContactLines& contacts,
                        const StopRequest* stop) {
    constexpr std::size_t block_size = 8;  // small, because many neighbouring elements may need many splits
    const auto block = [&](std::size_t b) {
        const std::size_t first = b * block_size;
        return std::span(from).subspan(first, std::min(block_size, from.size() - first));
    };
    std::vector<FoundCuts> found((from.size() + block_size - 1) / block_size);
    find_together(
        found, 1, [&](std::size_t b) { return find_cuts(tree, block(b), contacts, stop); },
        [](auto& a, FoundCuts& cuts) { a(cuts); }, "contacts");
    for (std::size_t b = found.size(); b-- > 0;) {
        found[b].cut(tree, block(b));
        found[b] = {};
    }
}

}  // namespace exitance
