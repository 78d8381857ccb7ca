#include <cmath>

#include "exitance/io/solution_groups.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t none = ElementId::none_value;

/// Cuts a tree anew in the order in which its elements came to be; why not, when the file makes no sense.
class Replay {
  public:
    Replay(Hdf5Reader& file, const std::string& group, std::size_t region_count)
        : parent_(file.read<std::uint32_t>(group + "/parent")),
          cut_(file.read<std::uint8_t>(group + "/cut", 1, parent_.size())),
          ratio_(file.read<double>(group + "/ratio", 1, parent_.size())),
          region_(file.read<std::uint32_t>(group + "/root_region")),
          shape_(file.read<std::uint8_t>(group + "/root_shape", 1, region_.size())),
          patch_(file.read<double>(group + "/root_patch", 9, region_.size())),
          region_count_(region_count) {}

    std::optional<std::string> run(ElementTree& tree) {
        std::size_t root = 0;
        while (tree.size() < parent_.size()) {
            const bool good = parent_[tree.size()] == none ? add_root(tree, root++) : split(tree);
            if (!good) return "makes no tree at element " + std::to_string(tree.size());
        }
        for (ElementId e : tree.ids())
            if (tree.is_leaf(e) && cut_[e.value] != 0) return "lacks the children of element " + std::to_string(e.value);
        if (root != region_.size()) return "has fewer roots than patches";
        return {};
    }

  private:
    bool add_root(ElementTree& tree, std::size_t i) {
        if (i >= region_.size() || region_[i] >= region_count_ || shape_[i] > 1) return false;
        const double* p = &patch_[9 * i];
        for (int k = 0; k < 9; ++k)
            if (!std::isfinite(p[k])) return false;
        tree.add_root(RegionId(region_[i]), {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]},
                                             shape_[i] == 1 ? Patch::Shape::triangle : Patch::Shape::parallelogram});
        return true;
    }
    bool split(ElementTree& tree) {
        const std::size_t first = tree.size();
        const std::uint32_t p = parent_[first];
        if (p >= first || !tree.is_leaf(ElementId(p)) || cut_[p] == 0 || cut_[p] > 3) return false;
        if (!(ratio_[p] > 0 && ratio_[p] < 1)) return false;
        const Cut way = static_cast<Cut>(cut_[p]);
        const std::size_t pieces = way == Cut::both || tree.patch(ElementId(p)).is_triangle() ? 4 : 2;
        if (pieces > parent_.size() - first) return false;
        for (std::size_t k = 0; k < pieces; ++k)
            if (parent_[first + k] != p) return false;
        tree.split(ElementId(p), way, ratio_[p]);
        return true;
    }

    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> cut_;
    std::vector<double> ratio_;
    std::vector<std::uint32_t> region_;
    std::vector<std::uint8_t> shape_;
    std::vector<double> patch_;
    std::size_t region_count_;
};

}  // namespace

std::vector<float> leaf_values(const ElementFunction& function) {
    const ElementTree& tree = function.tree;
    std::vector<float> out;
    out.reserve(bands * function.values.size());
    for (ElementId e : tree.ids()) {
        if (!tree.is_leaf(e)) continue;
        const std::size_t first = function.first_value[e], count = static_cast<std::size_t>(tree.patch(e).corner_count());
        EXI_CHECK(first + count <= function.values.size());
        for (std::size_t i = first; i < first + count; ++i)
            out.insert(out.end(), function.values[i].begin(), function.values[i].end());
    }
    return out;
}

void write_function(Hdf5Writer& file, const std::string& group, const ElementFunction& function,
                    const std::string& values_in) {
    const ElementTree& tree = function.tree;
    std::vector<std::uint32_t> parent, region;
    std::vector<std::uint8_t> way, shape;
    std::vector<double> ratio, patches;
    for (ElementId e : tree.ids()) {
        parent.push_back(tree.parent(e).value);
        way.push_back(static_cast<std::uint8_t>(tree.way(e)));
        ratio.push_back(tree.ratio(e));
    }
    for (ElementId e : tree.roots()) {
        const Patch& p = tree.patch(e);
        region.push_back(tree.region(e).value);
        shape.push_back(p.is_triangle() ? 1 : 0);
        for (const Vec3& v : {p.origin, p.a, p.b}) patches.insert(patches.end(), {v.x, v.y, v.z});
    }
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    file.write(in("parent"), parent, 1, {"1", "parent of an element; 4294967295 for a root"});
    file.write(in("cut"), way, 1, {"1", "how an element is cut: 0 not at all, 1 across u, 2 across v, 3 across both"});
    file.write(in("ratio"), ratio, 1, {"1", "where a cut across one direction stands, in (0, 1)"});
    file.write(in("root_region"), region, 1, {"1", "region of a root"});
    file.write(in("root_shape"), shape, 1, {"1", "shape of a root: 0 parallelogram, 1 triangle"});
    file.write(in("root_patch"), patches, 9, {"m", "origin, a and b of a root: its points are origin + u a + v b"});
    if (values_in.empty())
        file.write(in("values"), leaf_values(function), bands, {"W/m^2", "irradiance at the corners of the leaves"});
    else
        file.link(values_in, in("values"));
}

ElementFunction read_function(Hdf5Reader& file, const std::string& group, std::size_t region_count) {
    Replay replay(file, group, region_count);
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
        return file.fail(group + "/values", "has " + std::to_string(values.size() / bands) + " rows in place of " +
                                                std::to_string(count)),
               ElementFunction();
    function.values.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < bands; ++b) function.values[i][b] = values[i * bands + b];
    return function;
}

}  // namespace exitance
