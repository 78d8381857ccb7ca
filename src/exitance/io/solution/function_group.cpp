#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/io/solution/vertex_table.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t none = ElementId::none_value;

/// Value in `root_corner` of a root that has corners which are not on its region's border.
constexpr std::uint8_t not_on_border = 255;

/// Returns the corners of the border loops of a region, one loop after the other. A root of a triangulated surface has
/// its corners among them, and the file refers to them by their numbers in this list. The list of a region with more
/// corners than numbers is empty.
std::vector<Point> border_corners(const Region& region) {
    std::vector<Point> out;
    for (const std::vector<Point>& loop : region.loops) out.insert(out.end(), loop.begin(), loop.end());
    if (out.size() >= not_on_border) out.clear();
    return out;
}

/// Numbers of the corners at u = v = 0, at u = 1 and at v = 1 of a patch.
using RootCorners = std::array<std::uint8_t, 3>;

/// Returns the corners of the border from which the patch follows bit for bit; `not_on_border` if there are none.
RootCorners find_corners(const Patch& patch, const std::vector<Point>& border) {
    const auto first_where = [&](const auto& is_it) {
        const auto found = std::find_if(border.begin(), border.end(), is_it);
        return found == border.end() ? not_on_border : static_cast<std::uint8_t>(found - border.begin());
    };
    const RootCorners out = {
        first_where([&](const Point& p) { return are_same_bits(p, patch.origin); }),
        first_where([&](const Point& p) { return are_same_bits(p - patch.origin, patch.a); }),
        first_where([&](const Point& p) { return are_same_bits(p - patch.origin, patch.b); }),
    };
    if (std::find(out.begin(), out.end(), not_on_border) == out.end()) return out;
    return {not_on_border, not_on_border, not_on_border};
}

/// Rebuilds a tree by repeating its splits in the order of the element ids. Reports an error if the data are
/// inconsistent.
class Replay {
  public:
    Replay(Hdf5Reader& file, const std::string& group, const Field<RegionId, Region>& regions)
        : parent_(file.read<std::uint32_t>(group + "/parent")),
          cut_(file.read<std::uint8_t>(group + "/cut", 1, parent_.size())),
          ratio_(file.read<double>(group + "/ratio", 1, parent_.size())),
          line_element_(file.read<std::uint32_t>(group + "/line_element")),
          line_(file.read<double>(group + "/line", 3, line_element_.size())),
          fan_element_(file.read<std::uint32_t>(group + "/fan_element")),
          fan_places_(file.read<std::uint32_t>(group + "/fan_places", 1, fan_element_.size())),
          fan_(file.read<double>(group + "/fan", 2)),
          region_(file.read<std::uint32_t>(group + "/root_region")),
          shape_(file.read<std::uint8_t>(group + "/root_shape", 1, region_.size())),
          corner_(file.has(group + "/root_corner") ? file.read<std::uint8_t>(group + "/root_corner", 3, region_.size())
                                                   : std::vector<std::uint8_t>(3 * region_.size(), not_on_border)),
          patch_(file.read<double>(group + "/root_patch", 9)),
          regions_(regions) {}

    std::optional<std::string> run(ElementTree& tree) {
        std::size_t root = 0;
        const auto in_fan = [&](std::uint32_t p) { return p < cut_.size() && cut_[p] == 5; };
        const auto triangles = static_cast<std::size_t>(std::count_if(parent_.begin(), parent_.end(), in_fan));
        tree.reserve(parent_.size() - triangles), tree.reserve_fans(fan_element_.size(), triangles);
        while (tree.size() < parent_.size()) {
            const std::size_t at = tree.size();
            const bool good = parent_[at] == none ? add_root(tree, root++) : split(tree);
            if (!good) return "makes no tree at element " + std::to_string(at);
        }
        for (ElementId e : tree.ids())
            if (tree.is_leaf(e) && cut_[e.value] != 0)
                return "lacks the children of element " + std::to_string(e.value);
        if (root != region_.size() || patches_read_ != patch_.size() / 9) return "has fewer roots than patches";
        std::vector<bool> has_root(regions_.size());
        for (const std::uint32_t region : region_) has_root[region] = true;
        const auto bare = std::find(has_root.begin(), has_root.end(), false);
        if (bare != has_root.end()) return "has no element on region " + std::to_string(bare - has_root.begin());
        return {};
    }

  private:
    bool add_root(ElementTree& tree, std::size_t i) {
        if (i >= region_.size() || region_[i] >= regions_.size() || shape_[i] > 1) return false;
        std::optional<Patch> patch = corner_[3 * i] == not_on_border ? next_patch() : patch_between_corners(i);
        if (!patch) return false;
        patch->shape = shape_[i] == 1 ? Patch::Shape::triangle : Patch::Shape::parallelogram;
        const double squared_area = squared_norm(cross(patch->a, patch->b));
        if (!(squared_area > 0 && std::isfinite(1 / squared_area)))
            return false;  // points of a patch without area have no coordinates
        tree.add_root(RegionId(region_[i]), *patch);
        return true;
    }
    /// Returns the next patch of those that are stored by their vectors; none if there is no other, or it is not
    /// finite.
    std::optional<Patch> next_patch() {
        if (patches_read_ == patch_.size() / 9) return {};
        const double* p = &patch_[9 * patches_read_++];
        for (int k = 0; k < 9; ++k)
            if (!std::isfinite(p[k])) return {};
        return Patch{{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}};
    }
    std::optional<Patch> patch_between_corners(std::size_t i) const {
        const std::vector<Point> border = border_corners(regions_[RegionId(region_[i])]);
        const std::uint8_t* at = &corner_[3 * i];
        if (std::max({at[0], at[1], at[2]}) >= border.size()) return {};
        const Point& origin = border[at[0]];
        return Patch{origin, border[at[1]] - origin, border[at[2]] - origin};
    }
    bool split(ElementTree& tree) {
        const std::size_t first = tree.size();
        const std::uint32_t p = parent_[first];
        if (p >= first || !tree.is_leaf(ElementId(p)) || cut_[p] == 0 || cut_[p] > 5) return false;
        const Cut way = static_cast<Cut>(cut_[p]);
        if (way == Cut::line) return split_by_line(tree, ElementId(p));
        if (way == Cut::fan) return split_fan(tree, ElementId(p));
        if (!(ratio_[p] > 0 && ratio_[p] < 1) || tree.is_cell(ElementId(p))) return false;
        const std::size_t pieces = way == Cut::both || tree.patch(ElementId(p)).is_triangle() ? 4 : 2;
        if (pieces > parent_.size() - first) return false;
        for (std::size_t k = 0; k < pieces; ++k)
            if (parent_[first + k] != p) return false;
        tree.split(ElementId(p), way, ratio_[p]);
        return true;
    }

    bool split_by_line(ElementTree& tree, ElementId e) {
        const std::size_t first = tree.size();
        const auto found = std::lower_bound(line_element_.begin(), line_element_.end(), e.value);
        if (found == line_element_.end() || *found != e.value || parent_.size() - first < 2) return false;
        if (parent_[first] != e.value || parent_[first + 1] != e.value) return false;
        const double* line = &line_[3 * static_cast<std::size_t>(found - line_element_.begin())];
        if (tree.split_by_line(e, {{line[0], line[1]}, line[2]}).is_none()) return false;
        // Repeatedly split slivers have inaccurate areas, but the same splits reproduce the same values.
        const double a = tree.area(ElementId(first)), b = tree.area(ElementId(first + 1));
        return a > 0 && b > 0 && a + b <= 1.5 * tree.area(e);
    }

    /// Fans are stored in the order in which they were split.
    bool split_fan(ElementTree& tree, ElementId e) {
        if (fans_read_ == fan_element_.size() || fan_element_[fans_read_] != e.value) return false;
        const std::size_t places = fan_places_[fans_read_++], first = tree.size();
        if (places < 3 || places > fan_.size() / 2 - fan_places_read_ || places - 2 > parent_.size() - first)
            return false;
        Fan fan;
        for (std::size_t i = 0; i < places; ++i) {
            const double* at = &fan_[2 * (fan_places_read_ + i)];
            // tolerance: rounding may place points of an element slightly outside its frame
            constexpr double around = 1e-6;
            for (int k = 0; k < 2; ++k)
                if (!(at[k] >= -around && at[k] <= 1 + around)) return false;
            (i == 0 ? fan.apex : fan.border.emplace_back()) = {at[0], at[1]};
        }
        fan_places_read_ += places;
        for (std::size_t i = 0; i + 2 < places; ++i)
            if (parent_[first + i] != e.value) return false;
        return !tree.split_fan(e, fan).is_none();
    }

    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> cut_;
    std::vector<double> ratio_;
    std::vector<std::uint32_t> line_element_;  ///< Ascending.
    std::vector<double> line_;
    std::vector<std::uint32_t> fan_element_, fan_places_;
    std::vector<double> fan_;
    std::size_t fans_read_ = 0, fan_places_read_ = 0;
    std::vector<std::uint32_t> region_;
    std::vector<std::uint8_t> shape_;
    std::vector<std::uint8_t> corner_;
    std::vector<double> patch_;  ///< Patches of the roots that are not stored by corners.
    std::size_t patches_read_ = 0;
    const Field<RegionId, Region>& regions_;
};

/// Writes the values of a function, leaf by leaf in the order of their ids.
void write_values(Hdf5Writer& file, const std::string& name, const ElementFunction& function) {
    const ElementTree& tree = function.tree;
    const auto corners_of = [&](ElementId e) {
        return e < tree.first_of_fans() ? static_cast<std::size_t>(tree.patch(e).corner_count()) : 3;
    };
    std::size_t rows = 0, leaf = 0, corner = 0;
    for (ElementId e : tree.ids())
        if (tree.is_leaf(e)) {
            EXI_CHECK(function.first_value[e] + corners_of(e) <= function.values.size());
            rows += corners_of(e);
        }
    file.write_rows<float>(name, rows, bands,
                           {"W/m^2", "irradiance at the corners of the leaves' patches, leaf after leaf"},
                           [&](std::size_t, std::span<float> row) {
                               while (!tree.is_leaf(ElementId(leaf))) ++leaf;
                               const auto& value = function.values[function.first_value[ElementId(leaf)] + corner];
                               std::copy(value.begin(), value.end(), row.begin());
                               if (++corner == corners_of(ElementId(leaf))) ++leaf, corner = 0;
                           });
}

/// Writes how each element was created, one row per element.
void write_elements(Hdf5Writer& file, const std::string& group, const ElementTree& tree) {
    file.write_rows<std::uint32_t>(
        group + "/parent", tree.size(), 1, {"1", "parent of an element; 4294967295 for a root"},
        [&](std::size_t i, std::span<std::uint32_t> row) { row[0] = tree.parent(ElementId(i)).value; });
    file.write_rows<std::uint8_t>(
        group + "/cut", tree.size(), 1,
        {"1",
         "how an element is cut: 0 not at all, 1 across u, 2 across v, 3 across both, 4 along a line, "
         "5 into triangles around a place"},
        [&](std::size_t i, std::span<std::uint8_t> row) {
            row[0] = static_cast<std::uint8_t>(tree.cut_of(ElementId(i)));
        });
    file.write_rows<double>(group + "/ratio", tree.size(), 1,
                            {"1", "where a cut across one direction stands, in (0, 1)"},
                            [&](std::size_t i, std::span<double> row) { row[0] = tree.ratio(ElementId(i)); });
}

bool have_same_roots(const ElementTree& a, const ElementTree& b) {
    const auto is_same = [&](ElementId i, ElementId j) {
        const Patch p = a.patch(i), q = b.patch(j);
        return a.region(i) == b.region(j) && p.shape == q.shape && are_same_bits(p.origin, q.origin) &&
               are_same_bits(p.a, q.a) && are_same_bits(p.b, q.b);
    };
    const auto &roots = a.roots(), &others = b.roots();
    return std::equal(roots.begin(), roots.end(), others.begin(), others.end(), is_same);
}

/// Writes the root elements, or refers to those of `other` if they are the same.
void write_roots(Hdf5Writer& file, const std::string& group, const ElementTree& tree,
                 const Field<RegionId, Region>& regions, const std::optional<WrittenTree>& other) {
    if (other && have_same_roots(tree, other->tree)) {
        for (const char* name : {"/root_region", "/root_shape", "/root_corner", "/root_patch"})
            file.link(group + name, other->group + name);
        return;
    }
    std::vector<std::uint32_t> region;
    std::vector<std::uint8_t> shape, corners;
    std::vector<double> patches;
    std::vector<Point> border;
    for (ElementId e : tree.roots()) {
        const Patch p = tree.patch(e);
        if (region.empty() || region.back() != tree.region(e).value) border = border_corners(regions[tree.region(e)]);
        region.push_back(tree.region(e).value);
        shape.push_back(p.is_triangle() ? 1 : 0);
        const RootCorners found = find_corners(p, border);
        corners.insert(corners.end(), found.begin(), found.end());
        if (found[0] != not_on_border) continue;
        for (const Vec3& v : {p.origin, p.a, p.b}) patches.insert(patches.end(), {v.x, v.y, v.z});
    }
    file.write(group + "/root_region", region, 1, {"1", "region of a root"});
    file.write(group + "/root_shape", shape, 1, {"1", "shape of a root: 0 parallelogram, 1 triangle"});
    file.write(group + "/root_corner", corners, 3,
               {"1", "corners of the region's loops at (u, v) = (0,0), (1,0), (0,1); 255: the next row of root_patch"});
    file.write(group + "/root_patch", patches, 9,
               {"m", "origin, a and b of a root: its points are origin + u a + v b"});
}

}  // namespace

void write_function(Hdf5Writer& file, const std::string& group, const ElementFunction& function,
                    const Field<RegionId, Region>& regions, const std::optional<WrittenTree>& other) {
    const ElementTree& tree = function.tree;
    std::vector<std::uint32_t> line_element, fan_element, fan_places;
    std::vector<double> line, fans;
    for (ElementId e : tree.ids()) {
        if (!tree.parent(e).is_none() && tree.cut_of(tree.parent(e)) == Cut::fan &&
            tree.children(tree.parent(e)).front() == e) {
            const FanView fan = tree.fan(tree.parent(e));
            fan_element.push_back(tree.parent(e).value);
            fan_places.push_back(static_cast<std::uint32_t>(1 + fan.border.size()));
            fans.insert(fans.end(), {fan.apex.x, fan.apex.y});
            for (const Vec2& place : fan.border) fans.insert(fans.end(), {place.x, place.y});
        }
        if (tree.cut_of(e) != Cut::line) continue;
        line_element.push_back(e.value);
        line.insert(line.end(), {tree.line(e).normal.x, tree.line(e).normal.y, tree.line(e).offset});
    }
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    write_elements(file, group, tree);
    file.write(in("line_element"), line_element, 1, {"1", "elements that are cut along a line, ascending"});
    file.write(in("line"), line, 3, {"1", "n and d of a cut n . (u, v) = d in the element's coordinates"});
    file.write(in("fan_element"), fan_element, 1, {"1", "elements that are cut into triangles, in the order of these"});
    file.write(in("fan_places"), fan_places, 1, {"1", "how many places of `fan` are such an element's"});
    file.write(in("fan"), fans, 2,
               {"1", "places in the element's coordinates: apex p, then q_1 ... q_n of triangles (p, q_i, q_i+1)"});
    write_roots(file, group, tree, regions, other);
    write_values(file, in("values"), function);
}

ElementFunction read_function(Hdf5Reader& file, const std::string& group, const Field<RegionId, Region>& regions) {
    Replay replay(file, group, regions);
    const std::vector<float> values = file.read<float>(group + "/values", bands);
    if (file.failed()) return {};
    ElementFunction function;
    if (const auto wrong = replay.run(function.tree)) return file.fail(group + "/parent", *wrong), ElementFunction();

    function.first_value.resize(function.tree.size(), 0);
    std::size_t count = 0;
    for (ElementId e : function.tree.ids()) {
        if (!function.tree.is_leaf(e)) continue;
        function.first_value[e] = static_cast<std::uint32_t>(count);
        count += static_cast<std::size_t>(function.tree.patch(e).corner_count());
    }
    if (count * bands != values.size() || count >= none)
        return file.fail(group + "/values",
                         "has " + std::to_string(values.size() / bands) + " rows instead of " + std::to_string(count)),
               ElementFunction();
    function.values.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < bands; ++b) function.values[i][b] = values[i * bands + b];
    return function;
}

}  // namespace exitance
